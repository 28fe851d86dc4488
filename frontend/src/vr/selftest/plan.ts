/** What the wearer does during a self-test, and when: a value, and its place at a time. */

export type Movement = "look" | "hands" | "step" | "free";

export interface PlannedStep {
  readonly movement: Movement;
  readonly durationS: number;
}

/**
 * Two minutes. Looking around shows lost tracking of the head, hands in front that of controllers,
 * steps that of the shins; in free movement the body moves as in a visit.
 */
export const PLAN: readonly PlannedStep[] = [
  { movement: "look", durationS: 25 },
  { movement: "hands", durationS: 35 },
  { movement: "step", durationS: 35 },
  { movement: "free", durationS: 25 },
];

export const planDurationS = (plan: readonly PlannedStep[]): number =>
  plan.reduce((total, { durationS }) => total + durationS, 0);

export interface PlanPlace {
  readonly movement: Movement;
  readonly number: number;
  readonly total: number;
  /** Until the next step, and until the end; s. */
  readonly stepLeftS: number;
  readonly leftS: number;
}

/** Where in the plan a time is, counted from its start; null before and after. */
export function placeIn(plan: readonly PlannedStep[], elapsedS: number): PlanPlace | null {
  if (elapsedS < 0) return null;
  let endS = 0;
  for (const [index, { movement, durationS }] of plan.entries()) {
    endS += durationS;
    if (elapsedS >= endS) continue;
    return {
      movement,
      number: index + 1,
      total: plan.length,
      stepLeftS: endS - elapsedS,
      leftS: planDurationS(plan) - elapsedS,
    };
  }
  return null;
}
