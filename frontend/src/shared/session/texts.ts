/** Texts of what an operator presses next. */
export const actionsEn = {
  "do.start": "Start session",
  "do.resume": "Resume",
  "do.materialise": "Show the body",
};

export const actionsDe: Readonly<Record<keyof typeof actionsEn, string>> = {
  "do.start": "Sitzung starten",
  "do.resume": "Fortsetzen",
  "do.materialise": "Körper erscheinen lassen",
};
