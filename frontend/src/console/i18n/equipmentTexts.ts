/** Texts of the equipment's own delay from movement to picture. */
export const equipmentEn = {
  "equipment.title": "Equipment",
  "equipment.lead":
    "How slow the equipment itself is, from a movement to its picture. The latency that a study adds comes on top of it. Measurements travel with every export.",
  "equipment.add": "Add a measurement",
  "equipment.empty": "Nothing has been measured yet",
  "equipment.empty.body":
    "Measure the delay of each headset with its tracking and computer once, and again after every change of them.",
  "equipment.current": "Newest",
  "equipment.older": "Older",
  "equipment.retired": "Retired",
  "equipment.retire": "Retire",
  "equipment.retire.title": "Retire this measurement?",
  "equipment.retire.body":
    "It stays in the history with your reason, and an earlier one becomes the newest.",
  "equipment.retire.reason": "What was wrong with it?",
  "equipment.equipment": "Equipment",
  "equipment.equipmentHint": "Headset, tracking and computer, such as Vive Pro 2, desk 3",
  "equipment.delay": "Motion to photon",
  "equipment.sd": "SD",
  "equipment.samples": "Measurements",
  "equipment.n": "n",
  "equipment.method": "Method",
  "equipment.methodHint": "Such as high-speed camera at 240 Hz against a turning arm",
  "equipment.date": "Date",
  "equipment.note": "Note",
  "equipment.by": "By",
  "equipment.state": "State",
  "equipment.save": "Record the measurement",
  "equipment.history": "Measurements of {{equipment}}",
};

export const equipmentDe: Readonly<Record<keyof typeof equipmentEn, string>> = {
  "equipment.title": "Geräte",
  "equipment.lead":
    "Wie langsam die Geräte selbst sind, von einer Bewegung bis zu ihrem Bild. Die Verzögerung einer Studie kommt hinzu. Die Messungen stehen in jedem Export.",
  "equipment.add": "Messung eintragen",
  "equipment.empty": "Noch nichts gemessen",
  "equipment.empty.body":
    "Messen Sie die Verzögerung jedes Headsets mit Tracking und Rechner einmal, und erneut nach jeder Änderung daran.",
  "equipment.current": "Neueste",
  "equipment.older": "Älter",
  "equipment.retired": "Zurückgezogen",
  "equipment.retire": "Zurückziehen",
  "equipment.retire.title": "Diese Messung zurückziehen?",
  "equipment.retire.body":
    "Sie bleibt mit Ihrer Begründung in der Liste, und eine frühere wird die neueste.",
  "equipment.retire.reason": "Was war falsch daran?",
  "equipment.equipment": "Geräte",
  "equipment.equipmentHint": "Headset, Tracking und Rechner, etwa Vive Pro 2, Platz 3",
  "equipment.delay": "Motion-to-Photon",
  "equipment.sd": "SD",
  "equipment.samples": "Messungen",
  "equipment.n": "n",
  "equipment.method": "Methode",
  "equipment.methodHint": "Etwa Hochgeschwindigkeitskamera mit 240 Hz gegen einen Dreharm",
  "equipment.date": "Datum",
  "equipment.note": "Bemerkung",
  "equipment.by": "Von",
  "equipment.state": "Stand",
  "equipment.save": "Messung speichern",
  "equipment.history": "Messungen von {{equipment}}",
};
