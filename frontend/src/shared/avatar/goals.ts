/** What inverse kinematics has to reach: the tracked parts of a body at one moment. */
import type { Place } from "./hips";

/** The parts that can be tracked, in the order of a goal's rows; the waist tracker is the hips'. */
export const GOAL_PARTS = [
  "Hips",
  "Head",
  "LeftHand",
  "RightHand",
  "LeftLowerLeg",
  "RightLowerLeg",
] as const;

/**
 * Where the joints of the tracked parts are in the world; null for what is not tracked just now.
 *
 * What lies between a tracker and the joint of the part that wears it is calibrated before.
 */
export type Goals = Readonly<Record<(typeof GOAL_PARTS)[number], Place | null>>;

const UNIT_WITHIN = 1e-3;

/** Goals, or a model, that inverse kinematics cannot work with. */
export class IkError extends Error {
  override name = "IkError";
}

/** The goals by row. */
export function rowsOf(goals: Goals): readonly (Place | null)[] {
  for (const part of GOAL_PARTS) check(part, goals[part]);
  return GOAL_PARTS.map((part) => goals[part]);
}

function check(part: string, goal: Place | null): void {
  if (goal === null) return;
  if (!goal.positionM.every(Number.isFinite)) {
    throw new IkError(
      `The goal of ${part} lies at ${goal.positionM.join(", ")}: give null for a part whose` +
        " position is not known.",
    );
  }
  const norm = Math.hypot(...goal.rotation);
  if (!(Math.abs(norm - 1) <= UNIT_WITHIN)) {
    throw new IkError(
      `The rotation of ${part} is no unit quaternion (w, x, y, z): its length is ${norm}, not 1.`,
    );
  }
}
