/** Sizes for people: decimal units, as disks and browsers count. */
import { number } from "@shared/format";

const UNITS = ["B", "kB", "MB", "GB", "TB"] as const;

/** `532 B`, `4.2 kB`, `82 MB`, `1.25 GB`: three digits that count, never more. */
export function bytes(size: number, language: string): string {
  let at = 0;
  let rest = Math.max(0, size);
  while (rest >= 999.5 && at < UNITS.length - 1) {
    rest /= 1000;
    at += 1;
  }
  const digits = at === 0 || rest >= 99.95 ? 0 : rest >= 9.995 ? 1 : 2;
  return `${number(rest, language, digits)} ${UNITS[at]}`;
}
