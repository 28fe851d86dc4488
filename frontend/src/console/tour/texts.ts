/** Texts of the scripted participant, and of the tour of a session's page. */
export const tourEn = {
  "help.title": "Help",
  "help.try": "Try it with a scripted participant",
  "help.try.hint": "A whole session in about four minutes, marked as simulated.",
  "help.act": "Act on this screen",
  "help.act.hint": "Take the participant's place with mouse and keyboard, in a test session.",
  "help.tour": "Show the tour of this page",
  "help.noStudy": "There is no study to try yet",
  "try.button": "Try it with a scripted participant",
  "try.explain":
    "No people and no headset needed: a scripted participant goes through a whole session of this study while you watch. It is marked as simulated and never mixed with participants' data.",
  "acting.button": "Act on this screen",
  "acting.explain":
    "Take the participant's place yourself, with mouse and keyboard: a new tab opens, just before the body appears. It is a test session, and never mixed with participants' data.",
  "acting.skipped": "Acted on a screen: what comes before the body was left out.",
  "try.starting": "The scripted participant is getting ready",
  "try.starting.body": "It creates a simulated session and pairs its own tablet and headset.",
  "try.failed": "The scripted participant could not continue",
  "try.failed.start": "The scripted participant could not start",
  "try.again": "Start over",
  "try.label": "Scripted participant",
  "try.speed": "at most {{speed}} times as fast as a person",
  "try.watch": "Watch",
  "try.stop": "Stop",
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
    "Every step from consent to the last question, with its length. The filled ring marks the current step; completed steps show their results.",
  "tour.clock.title": "Active time",
  "tour.clock.body":
    "During a task, a large clock is shown here. It counts active time only: it stops during pauses and walks back, and when the headset disconnects.",
  "tour.next.title": "The next action",
  "tour.next.body":
    "One large button, or Enter. If there is none, the participant is busy: with a form on the tablet or a task in the headset. With a scripted participant, the script presses it for you.",
  "tour.live.title": "What moves",
  "tour.live.body":
    "Once the participant has a body, you see it live among the boxes of the task, in first or third person. Colours show the error of each joint. Keys 1, 2 and 3 change the view.",
  "tour.tablet.title": "Tablet and headset",
  "tour.tablet.body":
    "Whether both are connected. The current step shows how much of a form is filled in; participants can also call you from the tablet. To pair a device, press T or H and show the code.",
  "tour.alarms.title": "What is wrong",
  "tour.alarms.body":
    "This bar is always in the same place. It changes colour as soon as something is wrong, from lost frames to a call for help, and says what to do. The numbers beside it show how good the data are.",
  "tour.replay.title": "Replay",
  "tour.replay.body":
    "After each task, a replay shows the movement together with contacts, answers and notes. During a session, Replay is up here; afterwards it is beside every phase.",
  "tour.csv.title": "The data",
  "tour.csv.body":
    "When the session is over, download its data here as CSV with a codebook, or the data of the whole study on its Export page. Simulated sessions are kept separate. That is all: press Stop below, or keep watching.",
};

export const tourDe: Readonly<Record<keyof typeof tourEn, string>> = {
  "help.title": "Hilfe",
  "help.try": "Mit einer simulierten Person ausprobieren",
  "help.try.hint": "Eine ganze Sitzung in etwa vier Minuten, als simuliert gekennzeichnet.",
  "help.act": "Auf diesem Bildschirm handeln",
  "help.act.hint": "Mit Maus und Tastatur an der Stelle der Person, in einer Testsitzung.",
  "help.tour": "Rundgang durch diese Seite",
  "help.noStudy": "Es gibt noch keine Studie zum Ausprobieren",
  "try.button": "Mit einer simulierten Person ausprobieren",
  "try.explain":
    "Ohne Teilnehmende und ohne Headset: Eine simulierte Person durchläuft eine ganze Sitzung dieser Studie, und Sie sehen zu. Sie ist als simuliert gekennzeichnet und wird nie mit Daten von Teilnehmenden vermischt.",
  "acting.button": "Auf diesem Bildschirm handeln",
  "acting.explain":
    "Nehmen Sie selbst mit Maus und Tastatur teil: Ein neuer Tab öffnet sich, kurz bevor der Körper erscheint. Es ist eine Testsitzung und wird nie mit Daten von Teilnehmenden vermischt.",
  "acting.skipped": "Auf einem Bildschirm gehandelt: Was vor dem Körper kommt, wurde ausgelassen.",
  "try.starting": "Die simulierte Person macht sich bereit",
  "try.starting.body":
    "Sie legt eine simulierte Sitzung an und koppelt ein eigenes Tablet und Headset.",
  "try.failed": "Die simulierte Person konnte nicht weitermachen",
  "try.failed.start": "Die simulierte Person konnte nicht beginnen",
  "try.again": "Noch einmal beginnen",
  "try.label": "Simulierte Person",
  "try.speed": "höchstens {{speed}}-mal so schnell wie ein Mensch",
  "try.watch": "Zusehen",
  "try.stop": "Beenden",
  "try.done": "Die simulierte Person ist fertig",
  "try.stopped": "Die simulierte Person wurde beendet",
  "try.dismiss": "Schließen",
  "try.tour": "Rundgang",
  "tour.label": "Rundgang durch die Seite einer Sitzung",
  "tour.of": "{{number}} von {{total}}",
  "tour.next": "Weiter",
  "tour.back": "Zurück",
  "tour.skip": "Rundgang überspringen",
  "tour.end": "Fertig",
  "tour.keys": "Pfeiltasten blättern, Esc beendet den Rundgang.",
  "tour.timeline.title": "Die ganze Sitzung",
  "tour.timeline.body":
    "Jeder Schritt von der Einwilligung bis zur letzten Frage, mit seiner Dauer. Der gefüllte Ring markiert den aktuellen Schritt; erledigte Schritte zeigen ihre Ergebnisse.",
  "tour.clock.title": "Aktive Zeit",
  "tour.clock.body":
    "Während einer Aufgabe steht hier eine große Uhr. Sie zählt nur aktive Zeit: In Pausen, auf Rückwegen und bei getrenntem Headset hält sie an.",
  "tour.next.title": "Was als Nächstes zu tun ist",
  "tour.next.body":
    "Ein großer Knopf, oder Enter. Gibt es keinen, ist die Person beschäftigt: mit einem Fragebogen auf dem Tablet oder einer Aufgabe im Headset. Bei einer simulierten Person drückt ihn das Skript für Sie.",
  "tour.live.title": "Was sich bewegt",
  "tour.live.body":
    "Sobald die Person einen Körper hat, sehen Sie ihn hier live zwischen den Kästen der Aufgabe, aus eigener Sicht oder von außen. Farben zeigen den Fehler jedes Gelenks. Die Tasten 1, 2 und 3 wechseln die Ansicht.",
  "tour.tablet.title": "Tablet und Headset",
  "tour.tablet.body":
    "Ob beide verbunden sind. Beim aktuellen Schritt steht, wie weit ein Fragebogen ausgefüllt ist; die Person kann Sie auch vom Tablet aus rufen. Zum Koppeln drücken Sie T oder H und zeigen den Code.",
  "tour.alarms.title": "Was nicht stimmt",
  "tour.alarms.body":
    "Diese Leiste ist immer an derselben Stelle. Sie wird farbig, sobald etwas nicht stimmt, von verlorenen Bildern bis zum Hilferuf, und sagt, was zu tun ist. Die Zahlen daneben zeigen, wie gut die Daten sind.",
  "tour.replay.title": "Wiedergabe",
  "tour.replay.body":
    "Nach jeder Aufgabe zeigt die Wiedergabe die Bewegung zusammen mit Kontakten, Antworten und Notizen. Während der Sitzung ist sie hier oben, danach neben jeder Phase.",
  "tour.csv.title": "Die Daten",
  "tour.csv.body":
    "Ist die Sitzung vorbei, laden Sie ihre Daten hier als CSV mit Codebuch herunter, die der ganzen Studie auf deren Seite Export. Simulierte Sitzungen bleiben getrennt. Das war alles: Drücken Sie unten auf Anhalten oder sehen Sie weiter zu.",
};
