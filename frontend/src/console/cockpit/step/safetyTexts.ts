/** Texts of practice, stop rules, and heights that differ. */
export const safetyEn = {
  "practice.until_one": "Ends after {{count}} completed task",
  "practice.until_other": "Ends after {{count}} completed tasks",
  "held.title": "Stop: check on the participant",
  "held.score": "{{score}} is at or above the limit of {{limit}} in “{{instrument}}”.",
  "held.rise": "{{score}} has risen by {{limit}} or more in “{{instrument}}”.",
  "held.body":
    "The session is held, and the tablet asks the participant to wait for you. Offer a seat and water; take the headset off.",
  "held.end": "End the session",
  "held.withdraw": "The participant wants to stop",
  "do.override_stop": "Continue with a reason",
  "command.override_stop": "continue despite the stop rule",
  "ask.override_stop": "Continue although the stop rule was met?",
  "ask.override_stop.body":
    "Continue only after you have spoken to the participant and if they want to go on. The reason becomes part of the record.",
  "reason.recovered": "Recovered after a break, wants to continue",
  "reason.mistyped": "The answer was a mistake",
  "reason.stopRule": "Stop rule: sickness",
  "height.differs": "Is that right?",
  "height.differs.body":
    "Stated and matched height differ by {{difference}} cm. Check both; press again to save them as they are.",
  "height.differs.save": "Both are right: save",
};

export const safetyDe: Readonly<Record<keyof typeof safetyEn, string>> = {
  "practice.until_one": "Endet nach {{count}} erledigter Aufgabe",
  "practice.until_other": "Endet nach {{count}} erledigten Aufgaben",
  "held.title": "Halt: Sehen Sie nach der Person",
  "held.score": "{{score}} liegt in „{{instrument}}“ bei oder über der Grenze von {{limit}}.",
  "held.rise": "{{score}} ist in „{{instrument}}“ um {{limit}} oder mehr gestiegen.",
  "held.body":
    "Die Sitzung ist angehalten, und das Tablet bittet die Person, auf Sie zu warten. Bieten Sie einen Stuhl und Wasser an; nehmen Sie das Headset ab.",
  "held.end": "Sitzung beenden",
  "held.withdraw": "Die Person möchte aufhören",
  "do.override_stop": "Mit Begründung fortfahren",
  "command.override_stop": "trotz Stoppregel fortfahren",
  "ask.override_stop": "Trotz Stoppregel fortfahren?",
  "ask.override_stop.body":
    "Fahren Sie nur fort, wenn Sie mit der Person gesprochen haben und sie weitermachen möchte. Die Begründung wird Teil des Protokolls.",
  "reason.recovered": "Nach einer Pause erholt, möchte weitermachen",
  "reason.mistyped": "Die Antwort war ein Versehen",
  "reason.stopRule": "Stoppregel: Übelkeit",
  "height.differs": "Stimmt das?",
  "height.differs.body":
    "Angegebene und angeglichene Größe unterscheiden sich um {{difference}} cm. Prüfen Sie beide; drücken Sie noch einmal, um sie so zu speichern.",
  "height.differs.save": "Beide stimmen: speichern",
};
