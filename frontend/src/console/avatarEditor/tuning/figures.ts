/** How figures and their differences are written. */
import { decimals } from "@shared/format";

/** The decimals of every figure, so that they stand under each other. */
export const DIGITS = 2;

/** A difference that would round to zero, and is not, says how small it is. */
export function differenceInWords(value: number | undefined, language: string): string {
  if (value === undefined) return "–";
  const least = 0.5 / 10 ** DIGITS;
  if (value === 0 || Math.abs(value) >= least) return decimals(value, language, DIGITS);
  const bound = decimals(least, language, DIGITS + 1);
  return value > 0 ? `< ${bound}` : `> −${bound}`;
}
