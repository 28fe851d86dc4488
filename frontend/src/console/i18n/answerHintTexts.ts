/** Hints on how a form was filled in; for the operator, never on the tablet. */
export const answerHintsEn = {
  "hint.alike": "All {{items}} ratings are {{value}}",
  "hint.fast": "Half of the {{items}} ratings took less than {{seconds}} s each",
  "hint.left_out_one": "{{count}} question left out",
  "hint.left_out_other": "{{count}} questions left out",
  "hint.about":
    "A hint, not a verdict: perhaps ask whether anything was unclear. The answers are stored and scored as they are.",
};

export const answerHintsDe: Readonly<Record<keyof typeof answerHintsEn, string>> = {
  "hint.alike": "Alle {{items}} Bewertungen sind {{value}}",
  "hint.fast": "Die Hälfte der {{items}} Bewertungen dauerte je unter {{seconds}} s",
  "hint.left_out_one": "{{count}} Frage ausgelassen",
  "hint.left_out_other": "{{count}} Fragen ausgelassen",
  "hint.about":
    "Ein Hinweis, kein Urteil: Fragen Sie vielleicht, ob etwas unklar war. Die Antworten sind so gespeichert und gewertet, wie sie sind.",
};
