import type { Goals } from "@shared/avatar/goals";

/** Goals of a person who stands, and moves head and hands a little. */
export function goalsAt(timeS: number): Goals {
  const upright = [1, 0, 0, 0] as const;
  const swing = 0.1 * Math.sin(2 * timeS);
  return {
    Hips: { positionM: [0, 0.95, 0], rotation: upright },
    Head: { positionM: [0, 1.53, 0], rotation: upright },
    LeftHand: { positionM: [-0.55, 1.1 + swing, -0.25], rotation: upright },
    RightHand: { positionM: [0.55, 1.1 - swing, -0.25], rotation: upright },
    LeftLowerLeg: { positionM: [-0.09, 0.5, 0], rotation: upright },
    RightLowerLeg: { positionM: [0.09, 0.5, 0], rotation: upright },
  };
}
