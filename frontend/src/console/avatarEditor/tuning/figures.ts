/** How figures and their differences are written. */
import { decimals } from "@shared/format";

/** The decimals of every figure, so that they stand under each other. */
export const DIGITS = 2;

/** A difference that rounds to zero and is none says how small it is; zero is said as zero. */
export function differenceInWords(value: number | undefined, language: string): string {
  if (value === undefined) return "–";
  if (value === 0) return "0";
  const least = 0.5 / 10 ** DIGITS;
  if (Math.abs(value) >= least) return decimals(value, language, DIGITS);
  const bound = decimals(least, language, DIGITS + 1);
  return value > 0 ? `< ${bound}` : `> −${bound}`;
}
