/** Numbers of participants as people type them: "6, 9, 12". */

const FEWEST = 2;
const MOST = 1000;

/** The numbers in a text, each once and ascending; null if one is not from 2 to 1000. */
export function numbersIn(text: string): readonly number[] | null {
  const words = text.split(/[\s,;]+/).filter((word) => word !== "");
  if (words.length === 0 || words.some((word) => !/^\d{1,4}$/.test(word))) return null;
  const numbers = [...new Set(words.map(Number))].sort((one, other) => one - other);
  return numbers.every((one) => one >= FEWEST && one <= MOST) ? numbers : null;
}
