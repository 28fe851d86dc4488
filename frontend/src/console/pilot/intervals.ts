/** Intervals as each language writes them: where commas are decimal, a semicolon is between ends. */

/** What stands between two numbers. */
export const between = (language: string): string => (language === "de" ? "; " : ", ");

/** `[0.225, 0.280]`, in German `[0,225; 0,280]`. */
export const interval = (low: string, high: string, language: string): string =>
  `[${low}${between(language)}${high}]`;

/** Numbers in a row, as in `6, 9, 12`. */
export const listed = (
  values: readonly number[],
  language: string,
  shown: (value: number) => string,
): string => values.map(shown).join(between(language));
