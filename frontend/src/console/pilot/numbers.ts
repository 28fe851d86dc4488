/** Numbers of participants as people type them: "6, 9, 12". */

/** The numbers in a text, each once and ascending; null if something else is in it. */
export function numbersIn(text: string): readonly number[] | null {
  const words = text.split(/[\s,;]+/).filter((word) => word !== "");
  if (words.length === 0 || words.some((word) => !/^\d{1,4}$/.test(word))) return null;
  return [...new Set(words.map(Number))].sort((one, other) => one - other);
}
