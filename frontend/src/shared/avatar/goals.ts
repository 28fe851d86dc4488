/** The goals of inverse kinematics: the tracked parts of a body at one moment. */
import type { Place } from "./hips";

/**
 * The parts that can be tracked, in the order of a goal's rows; the waist tracker is for the hips.
 */
export const GOAL_PARTS = [
  "Hips",
  "Head",
  "LeftHand",
  "RightHand",
  "LeftLowerLeg",
  "RightLowerLeg",
] as const;

/**
 * Where the joints of the tracked parts are in the world; null for a part that is not tracked now.
 *
 * The offset between a tracker and the joint of the part that wears it is calibrated beforehand.
 */
export type Goals = Readonly<Record<(typeof GOAL_PARTS)[number], Place | null>>;

/** The goals of a moment at which nothing is tracked. */
export const NO_GOALS: Goals = {
  Hips: null,
  Head: null,
  LeftHand: null,
  RightHand: null,
  LeftLowerLeg: null,
  RightLowerLeg: null,
};

const UNIT_WITHIN = 1e-3;

/** Thrown for goals, or a model, that inverse kinematics cannot use. */
export class IkError extends Error {
  override name = "IkError";
}

/** Throws IkError for goals that cannot be used. */
export function checkGoals(goals: Goals): void {
  for (const part of GOAL_PARTS) check(part, goals[part]);
}

function check(part: string, goal: Place | null): void {
  if (goal === null) return;
  if (!goal.positionM.every(Number.isFinite)) {
    throw new IkError(
      `The goal of ${part} lies at ${goal.positionM.join(", ")}: give null for a part whose` +
        " position is unknown.",
    );
  }
  const [w, x, y, z] = goal.rotation;
  const norm = Math.sqrt(w * w + x * x + y * y + z * z);
  if (!(Math.abs(norm - 1) <= UNIT_WITHIN)) {
    throw new IkError(
      `The rotation of ${part} is not a unit quaternion (w, x, y, z): its length is ${norm}, not 1.`,
    );
  }
}
