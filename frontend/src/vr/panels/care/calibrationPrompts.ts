/**
 * What the participant is told while the body is measured: one step at a time, and in words what is
 * still wrong. The steps themselves, and when one is good, are decided by the calibration.
 */
import type { GoalPart } from "../../tracking/tracked";
import type { PanelScreen } from "../surface/screen";
import type { PanelWords } from "../texts";

export type CalibrationStep =
  | "fit"
  | "square"
  | "n_pose"
  | "t_pose"
  | "look_around"
  | "squat_reach";

/** What keeps a step from being done, most important first; lengths in metres. */
export type CalibrationProblem =
  | {
      readonly kind: "off_square";
      readonly towards: "forward" | "back" | "left" | "right";
      readonly distanceM: number;
    }
  | { readonly kind: "turned"; readonly towards: "left" | "right" }
  | {
      readonly kind:
        | "looking"
        | "bent_knees"
        | "bent_elbows"
        | "arms_not_down"
        | "arms_not_level"
        | "arm_too_high"
        | "feet_apart"
        | "swapped_hands"
        | "swapped_shins"
        | "moving"
        | "not_bent"
        | "not_reached";
    }
  | { readonly kind: "lost"; readonly part: GoalPart }
  | { readonly kind: "implausible"; readonly valueM: number };

const centimetres = (metres: number): number => Math.round(metres * 100);

/** A problem as a sentence that says what to do. */
export function problemText(words: PanelWords, problem: CalibrationProblem): string {
  switch (problem.kind) {
    case "off_square": {
      const distanceCm = Math.max(1, centimetres(problem.distanceM));
      return words(`problem.off_square.${problem.towards}`, { distanceCm });
    }
    case "turned":
      return words(`problem.turned.${problem.towards}`);
    case "lost":
      return words("problem.lost", { part: words(`part.${problem.part}`) });
    case "implausible":
      return words("problem.implausible", { valueCm: centimetres(problem.valueM) });
    default:
      return words(`problem.${problem.kind}`);
  }
}

export interface CalibrationPrompt {
  readonly step: CalibrationStep;
  /** The step's number among those of this calibration, from 1. */
  readonly number: number;
  readonly total: number;
  readonly problem: CalibrationProblem | null;
  /** How much of the time to hold still has passed, from 0 to 1. */
  readonly held: number;
}

/** The screen of a step; `sharp` is the target with which the wearer ends the step `fit`. */
export function calibrationScreen(words: PanelWords, prompt: CalibrationPrompt): PanelScreen {
  const { step, number, total, problem, held } = prompt;
  const isHeld = problem === null && held > 0;
  const text = words("calibration.step", { number, total });
  return {
    key: `calibration ${step}`,
    isLow: step !== "fit",
    lead: text,
    title: words(`calibration.${step}.title`),
    body: [{ kind: "prose", text: words(`calibration.${step}.body`) }],
    problem: problem === null ? null : problemText(words, problem),
    ...(isHeld
      ? { progress: { done: Math.ceil(held * 10), of: 10, text: words("calibration.measuring") } }
      : {}),
    ...(step === "fit"
      ? {
          buttons: [
            {
              target: "sharp",
              text: words("calibration.fit.sharp"),
              side: "right",
              isPrimary: true,
            } as const,
          ],
        }
      : {}),
  };
}

/** A step is repeated because a goal was too far off in the test of the calibration. */
export function repeatScreen(words: PanelWords, part: GoalPart, errorM: number): PanelScreen {
  const values = { part: words(`part.${part}`), errorCm: (errorM * 100).toFixed(1) };
  return {
    key: `calibration again ${part}`,
    title: words("calibration.again.title"),
    body: [{ kind: "prose", text: words("calibration.again.body", values) }],
  };
}

export const calibratedScreen = (words: PanelWords): PanelScreen => ({
  key: "calibration done",
  title: words("calibration.done.title"),
  body: [{ kind: "prose", text: words("calibration.done.body") }],
});
