/** Texts of the sheet to print before a session, in case the server fails in the middle of it. */
export const outageEn = {
  "outage.open": "Sheet in case the server fails",
  "outage.title": "If the server fails in mid-session",
  "outage.lead":
    "Print this before the participant comes, and keep it where the session is run. It needs no computer.",
  "outage.order": "Conditions",
  "outage.first": "At once",
  "outage.first.participant":
    "Speak to the participant: there is a technical break, they may sit down, and they may stop whenever they wish.",
  "outage.first.devices":
    "Leave headset and tablet switched on, with their pages open: what they could not send yet is kept there and is sent later. Never clear a browser's data.",
  "outage.first.note": "Write down the time and the step below.",
  "outage.restart": "Bring the server back",
  "outage.restart.computer":
    "Is its computer running, and is the network up? Other pages of the console say “The server does not answer” as long as it is not.",
  "outage.restart.start":
    "Start it in the same folder as before, with the same options: ./run, or ./run --lan if devices reach it over the lab's network.",
  "outage.restart.open":
    "Open the console at its address, sign in, and open this session. It is at the same step, paused, and headset and tablet connect by themselves.",
  "outage.restart.resume":
    "Look at the alarms, ask whether the participant is ready, then press Resume. What is missing is marked as a gap; the phase's time goes on where it stopped.",
  "outage.address": "Address of the console",
  "outage.stop": "If it does not come back within 15 minutes",
  "outage.stop.end":
    "End the visit, thank the participant, and say what happens next. Help them out of the headset, but leave it charging with its page open until the server is back.",
  "outage.stop.later":
    "When the server is back: let the devices send the rest, then end the session with the reason “Equipment failure”. Its slot becomes free, and what was recorded is kept.",
  "outage.stop.sick":
    "If the participant feels unwell, stop first and repair afterwards. Nothing is worth more than that.",
  "outage.steps": "The steps of this session",
  "outage.step": "Step",
  "outage.time": "Planned",
  "outage.done": "Done",
  "outage.note": "Time, notes",
  "outage.block": "Block {{number}}",
  "outage.failure": "What happened",
  "outage.failure.at": "Server failed at (date, time)",
  "outage.failure.step": "During step, with how much time left",
  "outage.failure.back": "Server back at",
  "outage.failure.told": "What the participant said",
  "outage.failure.by": "Operator",
  "outage.failure.contact": "Whom to call",
  "outage.made": "{{study}}, version {{version}} · printed {{when}}",
  "outage.back": "Back to the session",
  "outage.print": "Print",
} as const;

export const outageDe: Readonly<Record<keyof typeof outageEn, string>> = {
  "outage.open": "Blatt für den Fall, dass der Server ausfällt",
  "outage.title": "Wenn der Server mitten in der Sitzung ausfällt",
  "outage.lead":
    "Drucken Sie dieses Blatt, bevor die Person kommt, und legen Sie es dorthin, wo die Sitzung stattfindet. Es braucht keinen Rechner.",
  "outage.order": "Bedingungen",
  "outage.first": "Sofort",
  "outage.first.participant":
    "Sprechen Sie mit der Person: Es gibt eine technische Pause, sie darf sich setzen, und sie darf jederzeit aufhören.",
  "outage.first.devices":
    "Lassen Sie Headset und Tablet eingeschaltet und ihre Seiten offen: Was sie noch nicht senden konnten, ist dort aufbewahrt und wird später gesendet. Löschen Sie nie die Daten eines Browsers.",
  "outage.first.note": "Notieren Sie unten die Uhrzeit und den Schritt.",
  "outage.restart": "Den Server zurückholen",
  "outage.restart.computer":
    "Läuft sein Rechner, und steht das Netz? Andere Seiten der Konsole melden „Der Server antwortet nicht“, solange er fehlt.",
  "outage.restart.start":
    "Starten Sie ihn im selben Ordner wie vorher, mit denselben Optionen: ./run, oder ./run --lan, wenn Geräte ihn über das Netz des Labors erreichen.",
  "outage.restart.open":
    "Öffnen Sie die Konsole unter ihrer Adresse, melden Sie sich an und öffnen Sie diese Sitzung. Sie ist beim selben Schritt, angehalten, und Headset und Tablet verbinden sich von selbst.",
  "outage.restart.resume":
    "Sehen Sie die Alarme an, fragen Sie, ob die Person bereit ist, und drücken Sie dann „Fortsetzen“. Was fehlt, ist als Lücke markiert; die Zeit der Phase läuft dort weiter, wo sie stehen blieb.",
  "outage.address": "Adresse der Konsole",
  "outage.stop": "Wenn er nach 15 Minuten nicht zurück ist",
  "outage.stop.end":
    "Beenden Sie den Besuch, danken Sie der Person und sagen Sie, wie es weitergeht. Helfen Sie ihr aus dem Headset, lassen Sie es aber mit offener Seite am Ladekabel, bis der Server zurück ist.",
  "outage.stop.later":
    "Wenn der Server zurück ist: Lassen Sie die Geräte den Rest senden und beenden Sie die Sitzung dann mit der Begründung „Geräteausfall“. Ihr Platz wird frei, und das Aufgezeichnete bleibt erhalten.",
  "outage.stop.sick":
    "Fühlt sich die Person unwohl, hören Sie zuerst auf und reparieren danach. Nichts ist wichtiger.",
  "outage.steps": "Die Schritte dieser Sitzung",
  "outage.step": "Schritt",
  "outage.time": "Geplant",
  "outage.done": "Erledigt",
  "outage.note": "Uhrzeit, Notizen",
  "outage.block": "Block {{number}}",
  "outage.failure": "Was geschehen ist",
  "outage.failure.at": "Ausfall des Servers (Datum, Uhrzeit)",
  "outage.failure.step": "Bei welchem Schritt, mit wie viel Restzeit",
  "outage.failure.back": "Server zurück um",
  "outage.failure.told": "Was die Person sagte",
  "outage.failure.by": "Versuchsleitung",
  "outage.failure.contact": "Wen anrufen",
  "outage.made": "{{study}}, Version {{version}} · gedruckt {{when}}",
  "outage.back": "Zurück zur Sitzung",
  "outage.print": "Drucken",
};
