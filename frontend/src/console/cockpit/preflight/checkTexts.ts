/** The texts for the result of a check. */
import type { Check } from "@shared/api/types";
import { number } from "@shared/format";
import { CHECKS_MENDED_IN_SECONDS } from "@shared/session/registries.generated";
import type { Key } from "../../i18n";

/** Units without a symbol are counts, whose text says what is counted. */
const SYMBOLS: Readonly<Partial<Record<NonNullable<Check["unit"]>, string>>> = {
  s: "s",
  ms: "ms",
  Hz: "Hz",
  GB: "GB",
};
const DIGITS: Readonly<Partial<Record<NonNullable<Check["unit"]>, number>>> = { ms: 1, GB: 1 };
const MS_PER_S = 1000;
/** From here on a tenth of a millisecond decides nothing. */
const COARSE_MS = 100;

export function amountOf(value: number, unit: Check["unit"], language: string): string {
  if (unit == null) return number(value, language, 1);
  if (unit === "ms" && value >= MS_PER_S) return `${number(value / MS_PER_S, language, 1)} s`;
  if (unit === "ms" && value >= COARSE_MS) return `${number(value, language, 0)} ms`;
  const symbol = SYMBOLS[unit];
  const formatted = number(value, language, DIGITS[unit] ?? 0);
  return symbol === undefined ? formatted : `${formatted} ${symbol}`;
}

/** The values to fill into the text of a result. */
export function valuesOf(check: Check, language: string): Record<string, string> {
  const of = (value: number | null | undefined) =>
    value == null ? "–" : amountOf(value, check.unit, language);
  return { value: of(check.value), limit: of(check.limit) };
}

/** The text for the limit of a check, if that is a quantity and not a count. */
export function expectationOf(check: Check): Key | null {
  if (check.unit == null || SYMBOLS[check.unit] === undefined) return null;
  return check.expected == null ? null : `preflight.expected.${check.expected}`;
}

type Todo = Extract<Key, `preflight.todo.${string}`>;

/** The remedy; null if the check has passed or will pass without action. */
export function todoOf(check: Check): Todo | null {
  return check.status === "fail" ? (`preflight.todo.${check.code}` as Todo) : null;
}

/**
 * Checks with two lines from the start: nothing is paired at first, so each has a remedy on its
 * second line within seconds, which would push what is below it down.
 */
const IN_TWO_LINES: readonly Check["key"][] = ["tablet", "headset"];

export const hasTwoLines = (key: Check["key"]): boolean => IN_TWO_LINES.includes(key);

export const failing = (checks: readonly Check[]): readonly Check[] =>
  checks.filter(({ status }) => status === "fail");

const SOON_MS = 3000;
const LATER_MS = 20_000;

/** When to refresh the list automatically, ms; false if no check can improve without action. */
export function refetchIntervalFor(checks: readonly Check[]): number | false {
  const open = checks.filter(({ status }) => status === "wait" || status === "fail");
  if (open.length === 0) return false;
  return open.some(isMendedInSeconds) ? SOON_MS : LATER_MS;
}

const isMendedInSeconds = ({ key }: Check): boolean =>
  CHECKS_MENDED_IN_SECONDS.some((one) => one === key);
