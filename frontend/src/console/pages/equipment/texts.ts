/** Texts of the equipment's own delay from movement to picture. */
export const equipmentEn = {
  "equipment.title": "Equipment",
  "equipment.lead":
    "How long the equipment itself takes to show a movement. The latency that a study sets is added to this. Measurements are included in every export.",
  "equipment.add": "Add a measurement",
  "equipment.empty": "No delay has been measured yet",
  "equipment.empty.body":
    "Measure the delay of each combination of headset, tracking and computer once, and again after any change to it.",
  "equipment.current": "Newest",
  "equipment.older": "Older",
  "equipment.retired": "Retired",
  "equipment.retire": "Retire",
  "equipment.retire.title": "Retire this measurement?",
  "equipment.retire.body":
    "It stays in the history with your reason, and an earlier one becomes the newest.",
  "equipment.retire.reason": "What was wrong with it?",
  "equipment.equipment": "Equipment",
  "equipment.equipmentHint": "Headset, tracking and computer, for example Vive Pro 2, desk 3",
  "equipment.delay": "Motion-to-photon latency",
  "equipment.sd": "SD",
  "equipment.samples": "Measurements",
  "equipment.n": "n",
  "equipment.method": "Method",
  "equipment.methodHint": "For example a high-speed camera at 240 Hz and a rotating arm",
  "equipment.date": "Date",
  "equipment.note": "Note",
  "equipment.by": "By",
  "equipment.state": "State",
  "equipment.save": "Save measurement",
  "equipment.history": "Measurements of {{equipment}}",
};

export const equipmentDe: Readonly<Record<keyof typeof equipmentEn, string>> = {
  "equipment.title": "Geräte",
  "equipment.lead":
    "Wie lange die Geräte selbst brauchen, um eine Bewegung zu zeigen. Die Latenz, die eine Studie vorgibt, kommt hinzu. Die Messungen sind in jedem Export enthalten.",
  "equipment.add": "Messung eintragen",
  "equipment.empty": "Es wurde noch keine Verzögerung gemessen",
  "equipment.empty.body":
    "Messen Sie die Verzögerung jeder Kombination aus Headset, Tracking und Rechner einmal und nach jeder Änderung daran erneut.",
  "equipment.current": "Neueste",
  "equipment.older": "Ältere",
  "equipment.retired": "Verworfen",
  "equipment.retire": "Verwerfen",
  "equipment.retire.title": "Diese Messung verwerfen?",
  "equipment.retire.body":
    "Sie bleibt mit Ihrer Begründung in der Liste, und eine frühere wird zur neuesten.",
  "equipment.retire.reason": "Was war falsch daran?",
  "equipment.equipment": "Geräte",
  "equipment.equipmentHint": "Headset, Tracking und Rechner, etwa Vive Pro 2, Platz 3",
  "equipment.delay": "Motion-to-Photon-Latenz",
  "equipment.sd": "SD",
  "equipment.samples": "Messungen",
  "equipment.n": "n",
  "equipment.method": "Methode",
  "equipment.methodHint": "Etwa Hochgeschwindigkeitskamera mit 240 Hz und Dreharm",
  "equipment.date": "Datum",
  "equipment.note": "Bemerkung",
  "equipment.by": "Von",
  "equipment.state": "Stand",
  "equipment.save": "Messung speichern",
  "equipment.history": "Messungen von {{equipment}}",
};
