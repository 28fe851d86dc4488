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

/** Numbers to try next if the largest one does not suffice: half as many more, and twice as many. */
export const largerThan = (largest: number): readonly number[] =>
  [Math.ceil(1.5 * largest), 2 * largest].filter((one) => one <= MOST);

/** How many of those who start are not in the test, in whole per cent. */
export function lostIn(points: readonly { readonly n: number; readonly mean_in_test: number }[]) {
  const started = points.reduce((sum, { n }) => sum + n, 0);
  const left = points.reduce((sum, { mean_in_test }) => sum + mean_in_test, 0);
  return started === 0 ? 0 : Math.round(100 * (1 - left / started));
}
