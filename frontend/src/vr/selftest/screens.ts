/** What the wearer reads in the headset during a self-test, and its verdicts as text. */
import { clockFace, duration, number } from "@shared/format";
import { concerns, inputsText, limitText, todoText, valueText } from "@shared/selfTest/verdict";
import type { Paragraph } from "@shared/text";
import type { Seconds } from "@shared/units";
import type { PanelScreen } from "../panels";
import type { PlanPlace } from "./plan";
import { PLAN, planDurationS } from "./plan";
import { type Awaited, PREPARED_WITHIN_S } from "./preparation";
import { LEAST_DURATION_S, type SelfTestView } from "./report";
import type { SelfTestWords } from "./texts";

/**
 * How far a test is. `kept`: it could not be sent yet. `short`: nothing was worth a report. `unseen`:
 * the device drew no pictures in all the time.
 */
export type Progress =
  | { readonly kind: "preparing"; readonly awaited: Awaited; readonly waitedS: number }
  | { readonly kind: "measuring"; readonly place: PlanPlace; readonly isScripted: boolean }
  | { readonly kind: "sending" | "kept" | "short" | "unseen" }
  | { readonly kind: "stored"; readonly view: SelfTestView };

/** The most verdicts that a panel explains: the page has all of them. */
const MOST_POINTS = 3;
/** The panel is drawn anew this seldom, so that drawing it is no load of its own, s. */
const REDRAW_EVERY_S = 10;

const prose = (...texts: readonly string[]): readonly Paragraph[] =>
  texts.map((text) => ({ kind: "prose", text }));

/** What moved the body, the device and the length, in one line. */
export function summaryText(
  words: SelfTestWords,
  { report }: Pick<SelfTestView, "report">,
  language: string,
): string {
  return words("selftest.summary", {
    device: report.device.name ?? words("selftest.unknownDevice"),
    frames: number(report.rendering.frames, language, 0),
    duration: duration(report.duration_s as Seconds),
    inputs: inputsText(words, report),
  });
}

/**
 * The panel of a test. Its targets: `stop` ends the measurement, `leave` ends VR, `again` measures
 * once more.
 */
export function selfTestScreen(
  words: SelfTestWords,
  progress: Progress,
  language: string,
): PanelScreen {
  const leave = { target: "leave", text: words("selftest.leave"), side: "right" } as const;
  const again = { target: "again", text: words("selftest.again"), side: "left" } as const;
  switch (progress.kind) {
    case "preparing":
      return {
        key: "selftest preparing",
        isLow: true,
        title: words("selftest.preparing.title"),
        body: prose(
          words("selftest.preparing.body"),
          words(`selftest.awaited.${progress.awaited}`, {
            waited: progress.waitedS,
            most: PREPARED_WITHIN_S,
          }),
        ),
      };
    case "measuring":
      return measuringScreen(words, progress.place, progress.isScripted);
    case "sending":
      return {
        key: "selftest sending",
        title: words("selftest.sending.title"),
        body: prose(words("selftest.sending.body")),
      };
    case "kept":
      return {
        key: "selftest kept",
        title: words("selftest.kept.title"),
        body: prose(words("selftest.kept.body")),
        buttons: [{ ...leave, isPrimary: true }],
      };
    case "short":
      return {
        key: "selftest short",
        title: words("selftest.short.title"),
        body: prose(words("selftest.short.body", { seconds: LEAST_DURATION_S })),
        buttons: [again, { ...leave, isPrimary: true }],
      };
    case "unseen":
      return {
        key: "selftest unseen",
        title: words("selftest.unseen.title"),
        body: prose(words("selftest.unseen.body")),
        buttons: [again, { ...leave, isPrimary: true }],
      };
    case "stored":
      return {
        ...verdictsScreen(words, progress.view, language),
        buttons: [again, { ...leave, isPrimary: true }],
      };
  }
}

function measuringScreen(
  words: SelfTestWords,
  { movement, number: at, total, leftS }: PlanPlace,
  isScripted: boolean,
): PanelScreen {
  const wholeS = planDurationS(PLAN);
  const shownS = REDRAW_EVERY_S * Math.ceil(leftS / REDRAW_EVERY_S);
  return {
    key: `selftest ${movement}`,
    // Who looks straight ahead sees the mirror, and the time above it.
    isLow: true,
    // Legs are seen in the whole mirror only.
    isBeside: movement === "step" || movement === "free",
    lead: words("selftest.step", { number: at, total }),
    title: words(`selftest.${movement}.title`),
    body: prose(words(`selftest.${movement}.body`)),
    problem: isScripted ? words("selftest.scripted") : null,
    progress: {
      done: Math.max(0, wholeS - shownS),
      of: wholeS,
      text: words("selftest.left", { time: clockFace(shownS as Seconds) }),
    },
    buttons: [{ target: "stop", text: words("selftest.stop"), side: "left" }],
  };
}

function verdictsScreen(words: SelfTestWords, view: SelfTestView, language: string): PanelScreen {
  const { verdicts, status, worn } = view;
  const listed = concerns(verdicts);
  const points = listed.slice(0, MOST_POINTS).map((verdict) => {
    const value = valueText(words, verdict, language);
    const limit = limitText(words, verdict, language);
    const figure = `${words(`verdict.${verdict.code}`)}: ${value}${limit === null ? "" : ` (${limit})`}.`;
    return `${figure} ${todoText(words, verdict, view.report.rendering)}`;
  });
  const more = listed.length - points.length;
  if (more > 0) points.push(words("selftest.more", { count: more }));
  const ok = verdicts.length - listed.length;
  return {
    key: "selftest result",
    title: words(`selftest.${status}.title`),
    body: [
      ...prose(
        `${words("selftest.count", { ok, total: verdicts.length })} ${words("selftest.stored")}`,
      ),
      ...(points.length > 0 ? [{ kind: "points", points } as const] : []),
      ...prose(words("selftest.where")),
    ],
    problem: worn ? null : words("selftest.notWorn"),
  };
}
