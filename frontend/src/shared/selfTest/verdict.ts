/** The verdicts of a self-test as text: values and limits with their units, short times in ms. */
import type { components } from "../api/schema";
import { decimals, measuredTime, number } from "../format";
import { seconds } from "../units";
import type { verdictsEn } from "./texts";

type Schemas = components["schemas"];
export type SelfTestView = Schemas["SelfTestView"];
export type SelfTestReport = Schemas["SelfTestReport"];
export type Verdict = Schemas["Verdict"];
/** Looks up the texts that the headset and the console share. */
export type VerdictWords = (
  key: keyof typeof verdictsEn,
  values?: Readonly<Record<string, string | number>>,
) => string;

/** A verdict's value with its unit. */
export const valueText = (words: VerdictWords, verdict: Verdict, language: string): string =>
  verdict.value === null ? words("selftest.none") : quantity(verdict.value, verdict, language);

/** The limit, with the side of it on which a value has to be; null without one. */
export function limitText(words: VerdictWords, verdict: Verdict, language: string): string | null {
  if (verdict.limit === null) return null;
  const limit = quantity(verdict.limit, verdict, language, number);
  return words(verdict.at_least ? "selftest.atLeast" : "selftest.atMost", { limit });
}

const TRACKING: ReadonlySet<Verdict["code"]> = new Set([
  "head_loss",
  "hands_loss",
  "hands_tracked",
  "feet_tracked",
  "pose_rate",
]);

/** What helps on a screen, where nothing can be worn, charged or cooled down. */
const ON_SCREEN = {
  rendering_rate: "selftest.screen.slow",
  late_frames: "selftest.screen.slow",
  longest_frame: "selftest.screen.slow",
  physics_speed: "selftest.screen.slow",
  physics_frame: "selftest.screen.slow",
  unacknowledged: "selftest.screen.storing",
  round_trip: "selftest.screen.storing",
} as const;

/** What to do about a verdict that is not ok, on the device that was tested. */
export function todoText(
  words: VerdictWords,
  { code, value }: Verdict,
  { mode }: Pick<SelfTestReport["rendering"], "mode">,
): string {
  if (value === null) {
    return words(TRACKING.has(code) ? "selftest.none.unworn" : "selftest.none.do");
  }
  const onScreen = mode === "screen" ? ON_SCREEN[code as keyof typeof ON_SCREEN] : undefined;
  return words(onScreen ?? `verdict.${code}.do`);
}

/** The errors that the page caught, each once. */
export const errorsOf = ({ page }: SelfTestReport): readonly string[] => [
  ...new Set(page?.errors ?? []),
];

/** Verdicts to be explained, the worst first, otherwise in their order. */
export const concerns = (verdicts: readonly Verdict[]): readonly Verdict[] =>
  (["fail", "warn"] as const).flatMap((status) =>
    verdicts.filter((verdict) => verdict.status === status),
  );

/** What moved the body during a test. */
export const inputsText = (words: VerdictWords, { device }: SelfTestReport): string =>
  (device.inputs ?? []).map((input) => words(`selftest.input.${input}`)).join(", ") ||
  words("selftest.nothing");

/** A value or its limit. Against a limit of a second or more, short times are read in seconds, too. */
function quantity(
  value: number,
  { unit, limit, code }: Verdict,
  language: string,
  digits: typeof decimals = decimals,
): string {
  if (code === "physics_speed") return `${digits(value, language, 1)} ×`;
  if (unit === "s" && limit !== null && limit < 1) {
    return measuredTime(seconds(value), language, digits);
  }
  if (unit === "") return number(value, language, 0);
  return `${digits(value, language, 1)} ${unit}`;
}
