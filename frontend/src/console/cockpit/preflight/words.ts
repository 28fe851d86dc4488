/** What a check has found, in the words of the page. */
import type { Check } from "@shared/api/types";
import { number } from "@shared/format";
import type { Key } from "../../i18n";
import { CHECKS_MENDED_IN_SECONDS } from "../../i18n/registries.generated";

/** Of a count the word says what is counted. */
const SYMBOLS: Readonly<Partial<Record<NonNullable<Check["unit"]>, string>>> = {
  s: "s",
  ms: "ms",
  Hz: "Hz",
  GB: "GB",
};
const DIGITS: Readonly<Partial<Record<NonNullable<Check["unit"]>, number>>> = { ms: 1, GB: 1 };

export function amountOf(value: number, unit: Check["unit"], language: string): string {
  if (unit == null) return number(value, language, 1);
  const symbol = SYMBOLS[unit];
  const told = number(value, language, DIGITS[unit] ?? 0);
  return symbol === undefined ? told : `${told} ${symbol}`;
}

/** The values that the words of a finding are filled with. */
export function valuesOf(check: Check, language: string): Record<string, string> {
  const of = (value: number | null | undefined) =>
    value == null ? "–" : amountOf(value, check.unit, language);
  return { value: of(check.value), limit: of(check.limit) };
}

/** What it must keep to, where that is a quantity and not a count. */
export function expectationOf(check: Check): Key | null {
  if (check.unit == null || SYMBOLS[check.unit] === undefined) return null;
  return check.expected == null ? null : `preflight.expected.${check.expected}`;
}

type Todo = Extract<Key, `preflight.todo.${string}`>;

/** What to do about it; nothing where it is in order or comes by itself. */
export function todoOf(check: Check): Todo | null {
  return check.status === "fail" ? (`preflight.todo.${check.code}` as Todo) : null;
}

export const failing = (checks: readonly Check[]): readonly Check[] =>
  checks.filter(({ status }) => status === "fail");

const SOON_MS = 3000;
const LATER_MS = 20_000;

/** When to look again by itself, ms; never where nothing can change for the better. */
export function againAfter(checks: readonly Check[]): number | false {
  const open = checks.filter(({ status }) => status === "wait" || status === "fail");
  if (open.length === 0) return false;
  return open.some(isMendedInSeconds) ? SOON_MS : LATER_MS;
}

const isMendedInSeconds = ({ key }: Check): boolean =>
  CHECKS_MENDED_IN_SECONDS.some((one) => one === key);
