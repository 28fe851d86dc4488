import type { StudyProtocol } from "@shared/api/types";
import { type Seconds, seconds } from "@shared/units";

/** The time of one visit that the protocol fixes: free roam and phases, not forms or breaks. */
export function ownTime({ procedure, conditions }: StudyProtocol): Seconds {
  const around = [...procedure.before, ...procedure.after].map((step) => step.duration_s ?? 0);
  const phases = procedure.block.phases.map(
    (phase) => phase.preparation_s + phase.duration_s + phase.freeze_s,
  );
  const sum = (times: readonly number[]): number => times.reduce((total, time) => total + time, 0);
  return seconds(sum(around) + conditions.length * sum(phases));
}
