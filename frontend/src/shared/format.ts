/** How quantities are displayed: always with their unit, in the language of the page. */
import type { Milliseconds, Seconds } from "./units";

/** English dates and times have the day first and 24 hours, as is usual in laboratory logs. */
const locale = (language: string): string => (language === "en" ? "en-GB" : language);

/**
 * `0:07`, `1:00`, `12:30`: minutes and whole seconds, truncated rather than rounded, as clocks do.
 */
export function clockFace(time: Seconds): string {
  const whole = Math.max(0, Math.floor(time + 1e-6));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

/** `45 s`, `2 min`, `1 h 5 min`: a duration in words short enough for a table. */
export function duration(time: Seconds): string {
  const whole = Math.round(time);
  if (whole < 60) return `${whole} s`;
  const minutes = Math.floor(whole / 60);
  if (minutes < 60) return whole % 60 === 0 ? `${minutes} min` : `${minutes} min ${whole % 60} s`;
  return minutes % 60 === 0
    ? `${Math.floor(minutes / 60)} h`
    : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

/**
 * `12.5 ms`, `1.25 s`, `2 min 5 s`: a measured time in the unit that suits it. `digits` writes the
 * number, such as `number` for limits, which have no more decimals than they need.
 */
export function measuredTime(
  time: Seconds,
  language: string,
  digits: typeof decimals = decimals,
): string {
  // What would be rounded up to a second is one.
  if (Math.abs(time) < 0.99995) return `${digits(time * 1000, language, 1)} ms`;
  return Math.abs(time) < 59.995 ? `${digits(time, language, 2)} s` : duration(time);
}

/** `125 ms`. */
export const latency = (value: Milliseconds): string => `${value} ms`;

/** `125.0 ms`: a measured latency, as opposed to the set one. */
export const latencyMeasured = (value: Milliseconds, language: string): string =>
  `${tenths(value, language)} ms`;

/**
 * `125.0 ± 0.1 ms`: a measured value and half the width of its interval, which is never rounded
 * down.
 */
export function latencyWithin(
  value: Milliseconds,
  halfWidth: Milliseconds,
  language: string,
): string {
  const about = Math.ceil(halfWidth * 10) / 10;
  return `${tenths(value, language)} ± ${tenths(about, language)} ms`;
}

/** `+20.0 ms`, `−20.0 ms`: a signed difference of two latencies. */
export function latencyDifference(value: Milliseconds, language: string): string {
  return `${tenths(value, language, "exceptZero")} ms`;
}

function tenths(
  value: number,
  language: string,
  signDisplay: "negative" | "exceptZero" = "negative",
): string {
  const digits = { minimumFractionDigits: 1, maximumFractionDigits: 1 };
  return new Intl.NumberFormat(locale(language), { ...digits, signDisplay })
    .format(value)
    .replace("-", "−");
}

/** A number with at most `digits` decimals in the language's own notation. */
export function number(value: number, language: string, digits = 2): string {
  return new Intl.NumberFormat(locale(language), { maximumFractionDigits: digits })
    .format(value)
    .replace("-", "−");
}

/** What stands before the decimals in this language: `.` or `,`. */
export const decimalMark = (language: string): string => decimals(0.5, language, 1).charAt(1);

/** `8.00`, `−0.25`: the same number of decimals for every value, so that they can be compared. */
export function decimals(value: number, language: string, count: number): string {
  const digits = { minimumFractionDigits: count, maximumFractionDigits: count };
  // What rounds to zero has no sign: "−0.000" would look like a finding.
  const format = new Intl.NumberFormat(locale(language), { ...digits, signDisplay: "negative" });
  return format.format(value).replace("-", "−");
}

/** Date and time of day in the reader's own time zone, from UTC ISO 8601. */
export function dateTime(iso: string, language: string): string {
  return new Intl.DateTimeFormat(locale(language), {
    dateStyle: "medium",
    timeStyle: "short",
  }).format(new Date(iso));
}

/** The date without the time of day. */
export function day(iso: string, language: string): string {
  return new Intl.DateTimeFormat(locale(language), { dateStyle: "medium" }).format(new Date(iso));
}

/** Time of day with seconds, for logs. */
export function timeOfDay(iso: string, language: string): string {
  return new Intl.DateTimeFormat(locale(language), { timeStyle: "medium" }).format(new Date(iso));
}

/** `10 s ago`: a relative time; `now` is a parameter so that the text can be tested. */
export function ago(iso: string, now: Date, language: string): string {
  const passed = Math.round((now.getTime() - new Date(iso).getTime()) / 1000);
  const relative = new Intl.RelativeTimeFormat(locale(language), {
    numeric: "auto",
    style: "short",
  });
  if (Math.abs(passed) < 60) return relative.format(-passed, "second");
  if (Math.abs(passed) < 3600) return relative.format(-Math.round(passed / 60), "minute");
  if (Math.abs(passed) < 86_400) return relative.format(-Math.round(passed / 3600), "hour");
  return relative.format(-Math.round(passed / 86_400), "day");
}

/** Decimal units of file sizes, as disks and browsers use them. */
const UNITS = ["B", "kB", "MB", "GB", "TB"] as const;

/** `532 B`, `4.2 kB`, `82 MB`, `1.25 GB`: at most three significant digits. */
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
