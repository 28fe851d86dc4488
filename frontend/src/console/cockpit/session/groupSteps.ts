/** The steps of a session, gathered into what comes before, the blocks, and what comes after. */
import type { Step } from "@shared/api/types";

export interface StepGroup {
  readonly block: number | null;
  /** The place of the block in this visit, counted from 1; 0 outside blocks. */
  readonly number: number;
  /** The block's condition; null where it is hidden or there is none. */
  readonly latency: number | null;
  readonly steps: readonly Step[];
}

export function groupSteps(steps: readonly Step[]): readonly StepGroup[] {
  const groups: { block: number | null; number: number; latency: number | null; steps: Step[] }[] =
    [];
  let blocks = 0;
  for (const step of steps) {
    const last = groups.at(-1);
    if (last !== undefined && last.block === step.block) {
      last.steps.push(step);
      continue;
    }
    if (step.block !== null) blocks += 1;
    const number = step.block === null ? 0 : blocks;
    const latency = step.block === null ? null : step.latency_ms;
    groups.push({ block: step.block, number, latency, steps: [step] });
  }
  return groups;
}
