/** The steps of a calibration, and what keeps one from being done: the panels have the words. */
import type { GoalPart } from "../tracking/tracked";

export const CALIBRATION_STEPS = [
  "square",
  "n_pose",
  "t_pose",
  "squat",
  "reach",
  "mirror",
] as const;
export type CalibrationStep = (typeof CALIBRATION_STEPS)[number];

/** What keeps a step from being done, or had it repeated; lengths in metres. */
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
        | "palms_not_down"
        | "feet_apart"
        | "swapped_hands"
        | "moving"
        | "not_bent"
        | "not_upright"
        | "not_reached";
    }
  | { readonly kind: "lost"; readonly part: GoalPart }
  /** The height that the eyes tell is nobody's: the headset's floor is wrong. */
  | { readonly kind: "implausible"; readonly valueM: number }
  | { readonly kind: "goal_error"; readonly part: GoalPart; readonly errorM: number };

/** A calibration that is under way, as participant and operator see it. */
export interface CalibrationPrompt {
  readonly step: CalibrationStep;
  /** The step's number among those of this calibration, from 1. */
  readonly number: number;
  readonly total: number;
  readonly problem: CalibrationProblem | null;
  /** How much of the time to hold still has passed, from 0 to 1. */
  readonly held: number;
  /** Whole seconds that are still to be held; at the mirror, until it goes on by itself. */
  readonly secondsLeft: number;
  /** Why the poses are made once more; null in the first attempt. */
  readonly again: CalibrationProblem | null;
  /** Whether the step takes so long that it may be left out. */
  readonly canSkip: boolean;
}
