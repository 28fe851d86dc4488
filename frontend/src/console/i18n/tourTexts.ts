/** Texts of the scripted participant, and of the tour of a session's page. */
export const tourEn = {
  "help.title": "Help",
  "help.try": "Try it with a scripted participant",
  "help.try.hint": "A whole session in about four minutes, marked as simulated.",
  "help.tour": "Show the tour of this page",
  "help.noStudy": "There is no study to try yet",
  "try.button": "Try it with a scripted participant",
  "try.explain":
    "Nobody needed, no headset: a scripted participant goes through a whole session of this study while you watch. It is marked as simulated and never mixes with people's data.",
  "try.starting": "The scripted participant is getting ready",
  "try.starting.body": "It creates a simulated session and pairs its own tablet and headset.",
  "try.failed": "The scripted participant could not continue",
  "try.failed.start": "The scripted participant could not start",
  "try.again": "Start over",
  "try.label": "Scripted participant",
  "try.speed": "{{speed}} times as fast as a person",
  "try.watch": "Watch",
  "try.stop": "Stop",
  "try.stopping": "Stopping",
  "try.done": "The scripted participant has finished",
  "try.stopped": "The scripted participant was stopped",
  "try.dismiss": "Close",
  "try.tour": "Tour",
  "tour.label": "Tour of a session's page",
  "tour.of": "{{number}} of {{total}}",
  "tour.next": "Next",
  "tour.back": "Back",
  "tour.skip": "Skip the tour",
  "tour.end": "Done",
  "tour.keys": "Arrow keys turn the pages, Esc ends the tour.",
  "tour.timeline.title": "The whole session",
  "tour.timeline.body":
    "Every step from consent to the last question, with its length. The filled ring is where the participant is now; what was done shows what came out.",
  "tour.clock.title": "Active time",
  "tour.clock.body":
    "In a task a large clock stands here. It counts only while the participant is at it: a pause, a walk back and a lost headset stop it.",
  "tour.next.title": "The next action",
  "tour.next.body":
    "One large button, or Enter. Where there is none, somebody else is busy: a form on the tablet, a task in the headset. Just now the script presses it for you.",
  "tour.live.title": "What moves",
  "tour.live.body":
    "From the moment the participant has a body you see it live among the boxes of the task, in first or third person. Colours tell each joint's error. Keys 1, 2 and 3 change the view.",
  "tour.tablet.title": "Tablet and headset",
  "tour.tablet.body":
    "Whether both are there. How far a form is stands with the step; a participant can also call you from the tablet. To pair one, press T or H and show the code.",
  "tour.alarms.title": "What is wrong",
  "tour.alarms.body":
    "This bar never moves. It fills with colour as soon as something is wrong, from lost frames to a call, and says what to do. The figures beside it tell how good the data are.",
  "tour.replay.title": "Replay",
  "tour.replay.body":
    "After each task a replay shows it in space, in step with contacts, answers and notes. Replay is up here during a session, and beside every phase once it is over.",
  "tour.csv.title": "The data",
  "tour.csv.body":
    "When the session is over it can be downloaded here as CSV with a codebook, and the whole study on its page Export. Simulated sessions stay apart. That is all: press Stop below, or watch on.",
};

export const tourDe: Readonly<Record<keyof typeof tourEn, string>> = {
  "help.title": "Hilfe",
  "help.try": "Mit einer gespielten Person ausprobieren",
  "help.try.hint": "Eine ganze Sitzung in etwa vier Minuten, als simuliert gekennzeichnet.",
  "help.tour": "Rundgang durch diese Seite",
  "help.noStudy": "Es gibt noch keine Studie zum Ausprobieren",
  "try.button": "Mit einer gespielten Person ausprobieren",
  "try.explain":
    "Ohne Menschen und ohne Headset: Eine gespielte Person geht durch eine ganze Sitzung dieser Studie, und man sieht zu. Sie ist als simuliert gekennzeichnet und mischt sich nie mit Daten von Menschen.",
  "try.starting": "Die gespielte Person macht sich bereit",
  "try.starting.body":
    "Sie legt eine simulierte Sitzung an und koppelt ein eigenes Tablet und Headset.",
  "try.failed": "Die gespielte Person konnte nicht weitermachen",
  "try.failed.start": "Die gespielte Person konnte nicht anfangen",
  "try.again": "Noch einmal anfangen",
  "try.label": "Gespielte Person",
  "try.speed": "{{speed}}-mal so schnell wie ein Mensch",
  "try.watch": "Zusehen",
  "try.stop": "Anhalten",
  "try.stopping": "Hält an",
  "try.done": "Die gespielte Person ist fertig",
  "try.stopped": "Die gespielte Person wurde angehalten",
  "try.dismiss": "Schließen",
  "try.tour": "Rundgang",
  "tour.label": "Rundgang durch die Seite einer Sitzung",
  "tour.of": "{{number}} von {{total}}",
  "tour.next": "Weiter",
  "tour.back": "Zurück",
  "tour.skip": "Rundgang beenden",
  "tour.end": "Fertig",
  "tour.keys": "Pfeiltasten blättern, Esc beendet den Rundgang.",
  "tour.timeline.title": "Die ganze Sitzung",
  "tour.timeline.body":
    "Jeder Schritt von der Einwilligung bis zur letzten Frage, mit seiner Dauer. Der gefüllte Ring zeigt, wo die Person gerade ist; bei Erledigtem steht, was herauskam.",
  "tour.clock.title": "Aktive Zeit",
  "tour.clock.body":
    "In einer Aufgabe steht hier eine große Uhr. Sie zählt nur, solange die Person dabei ist: Pause, Rückweg und verlorenes Headset halten sie an.",
  "tour.next.title": "Was als Nächstes zu tun ist",
  "tour.next.body":
    "Ein großer Knopf, oder Enter. Wo keiner ist, ist jemand anderes dran: ein Fragebogen auf dem Tablet, eine Aufgabe im Headset. Jetzt gerade drückt das Skript ihn.",
  "tour.live.title": "Was sich bewegt",
  "tour.live.body":
    "Sobald die Person einen Körper hat, sieht man ihn hier live zwischen den Kästen der Aufgabe, aus eigener oder fremder Sicht. Farben zeigen den Fehler jedes Gelenks. Die Tasten 1, 2 und 3 wechseln die Ansicht.",
  "tour.tablet.title": "Tablet und Headset",
  "tour.tablet.body":
    "Ob beide da sind. Wie weit ein Fragebogen ist, steht beim Schritt; die Person kann vom Tablet aus auch rufen. Zum Koppeln T oder H drücken und den Code zeigen.",
  "tour.alarms.title": "Was nicht stimmt",
  "tour.alarms.body":
    "Diese Leiste bewegt sich nie. Sie füllt sich mit Farbe, sobald etwas nicht stimmt, vom verlorenen Bild bis zum Ruf, und sagt, was zu tun ist. Die Zahlen daneben sagen, wie gut die Daten sind.",
  "tour.replay.title": "Noch einmal ansehen",
  "tour.replay.body":
    "Nach jeder Aufgabe zeigt eine Wiedergabe sie im Raum, im Takt mit Kontakten, Antworten und Notizen. Während der Sitzung steht sie hier oben, danach neben jeder Phase.",
  "tour.csv.title": "Die Daten",
  "tour.csv.body":
    "Ist die Sitzung vorbei, lässt sie sich hier als CSV mit Codebuch herunterladen, und die ganze Studie auf ihrer Seite Export. Simulierte Sitzungen bleiben für sich. Das war alles: unten anhalten oder weiter zusehen.",
};
