/** Texts of the first page: the first steps, the state of the lab, and the demo lab. */
export const homeEn = {
  "home.first": "Look around first",
  "home.first.lead.nobody": "Nobody has taken part yet. Nothing you do here can harm later data.",
  "home.first.lead.others":
    "No participant has taken part yet. Simulated and test sessions never mix with participants' data.",
  "home.demo.title": "A filled lab",
  "home.demo": "Load the demo lab",
  "home.demo.body":
    "Twelve simulated people visit a study in 10-second phases. The page shows how far they are; how long it takes depends on the computer. You remove all of it with one click.",
  "home.watch.title": "The operator's desk",
  "home.watch": "Watch a session live",
  "home.watch.body":
    "A scripted participant goes through a whole session at four times normal speed. You sit at the operator's desk.",
  "home.act.title": "The participant's place",
  "home.act": "Try it as a participant",
  "home.act.body":
    "Take the participant's place with mouse and keyboard. No headset needed; a new tab opens.",
  "home.create.title": "A study of your own",
  "home.create": "Create a study",
  "home.create.body":
    "From a template or a file of your own. Every problem is shown with its line while you write.",
  "home.step.study": "Study: {{title}}",
  "home.today": "Today's sessions",
  "home.today.none": "No session today.",
  "home.at.planned": "created {{time}}",
  "home.at.started": "started {{time}}",
  "home.at.ended": "ended {{time}}",
  "home.attention": "Needs attention",
  "home.attention.none":
    "Nothing. No participant's session was left open, ended early or is invalid.",
  "home.concern.left_open": "still open",
  "home.concern.never_started": "never started",
  "home.concern.not_valid": "completed, but does not count",
  "home.concern.ended_early": "ended early",
  "home.progress": "{{completed}} of {{planned}} participants",
  "home.progress.preregistered": "{{completed}} of {{planned}} preregistered participants",
  "home.progress.running_one": "{{count}} session running",
  "home.progress.running_other": "{{count}} sessions running",
  "home.others": "{{simulated}} simulated, {{test}} tests",
  "demo.label": "Demo lab",
  "demo.finished": "{{completed}} of {{planned}} simulated people have finished",
  "demo.title": "Demo lab",
  "demo.all": "All {{planned}} simulated people have finished.",
  "demo.session":
    "This person is simulated: the answers and movements say nothing about real people.",
  "demo.loaded":
    "These people are simulated: their answers and movements say nothing about real people.",
  "demo.stopped":
    "{{completed}} of {{planned}} simulated people have finished; the others were stopped.",
  "demo.failed": "The simulated people could not continue: {{message}}",
  "demo.results": "See the figures",
  "demo.more": "Load the rest",
  "demo.remove": "Remove the demo lab",
  "demo.remove.title": "Remove the demo lab?",
  "demo.remove.body":
    "Its study is deleted with all of its simulated sessions. Other studies are not touched. You can load it again.",
  "demo.removed": "The demo lab was removed",
} as const;

export const homeDe: Readonly<Record<keyof typeof homeEn, string>> = {
  "home.first": "Erst einmal umsehen",
  "home.first.lead.nobody":
    "Noch hat niemand teilgenommen. Nichts, was Sie hier tun, kann späteren Daten schaden.",
  "home.first.lead.others":
    "Noch hat kein Mensch teilgenommen. Simulierte Sitzungen und Tests bleiben von den Daten der Teilnehmenden getrennt.",
  "home.demo.title": "Ein gefülltes Labor",
  "home.demo": "Demo-Labor laden",
  "home.demo.body":
    "Zwölf simulierte Personen besuchen eine Studie in Phasen von 10 Sekunden. Die Seite zeigt, wie weit sie sind; wie lange es dauert, hängt vom Rechner ab. Ein Klick entfernt alles wieder.",
  "home.watch.title": "Platz der Versuchsleitung",
  "home.watch": "Eine Sitzung live ansehen",
  "home.watch.body":
    "Eine simulierte Person geht in vierfachem Tempo durch eine ganze Sitzung. Sie sitzen am Platz der Versuchsleitung.",
  "home.act.title": "Platz der Teilnehmenden",
  "home.act": "Selbst ausprobieren",
  "home.act.body":
    "Mit Maus und Tastatur an der Stelle der teilnehmenden Person, ohne Headset; ein neuer Tab öffnet sich.",
  "home.create.title": "Eigene Studie",
  "home.create": "Eine Studie anlegen",
  "home.create.body":
    "Aus einer Vorlage oder einer eigenen Datei. Jedes Problem wird beim Schreiben mit seiner Zeile gezeigt.",
  "home.step.study": "Studie: {{title}}",
  "home.today": "Sitzungen von heute",
  "home.today.none": "Heute keine Sitzung.",
  "home.at.planned": "angelegt {{time}}",
  "home.at.started": "begonnen {{time}}",
  "home.at.ended": "beendet {{time}}",
  "home.attention": "Braucht Aufmerksamkeit",
  "home.attention.none":
    "Nichts. Keine Sitzung mit Teilnehmenden blieb offen, endete vorzeitig oder ist ungültig.",
  "home.concern.left_open": "noch offen",
  "home.concern.never_started": "nie begonnen",
  "home.concern.not_valid": "abgeschlossen, zählt aber nicht",
  "home.concern.ended_early": "vorzeitig beendet",
  "home.progress": "{{completed}} von {{planned}} Teilnehmenden",
  "home.progress.preregistered": "{{completed}} von {{planned}} präregistrierten Teilnehmenden",
  "home.progress.running_one": "{{count}} Sitzung läuft",
  "home.progress.running_other": "{{count}} Sitzungen laufen",
  "home.others": "{{simulated}} simuliert, {{test}} Tests",
  "demo.label": "Demo-Labor",
  "demo.finished": "{{completed}} von {{planned}} simulierten Personen sind fertig",
  "demo.title": "Demo-Labor",
  "demo.all": "Alle {{planned}} simulierten Personen sind fertig.",
  "demo.session":
    "Diese Person ist simuliert: Ihre Antworten und Bewegungen sagen nichts über Menschen aus.",
  "demo.loaded":
    "Diese Personen sind simuliert: Ihre Antworten und Bewegungen sagen nichts über Menschen aus.",
  "demo.stopped":
    "{{completed}} von {{planned}} simulierten Personen sind fertig; die übrigen wurden angehalten.",
  "demo.failed": "Die simulierten Personen konnten nicht weitermachen: {{message}}",
  "demo.results": "Zu den Abbildungen",
  "demo.more": "Die übrigen laden",
  "demo.remove": "Demo-Labor entfernen",
  "demo.remove.title": "Demo-Labor entfernen?",
  "demo.remove.body":
    "Seine Studie wird mit allen simulierten Sitzungen gelöscht. Andere Studien bleiben unberührt. Sie können es wieder laden.",
  "demo.removed": "Das Demo-Labor wurde entfernt",
};
