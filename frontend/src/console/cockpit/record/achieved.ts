/** What can be said of the latency that a phase really had, beside the one that was ordered. */
import type { PhaseSummary } from "@shared/api/types";
import { type Milliseconds, milliseconds, type Seconds, seconds } from "@shared/units";

/** Below this much movement the server claims nothing (`LEAST_MOVEMENT_S` in its science). */
export const LEAST_MOVEMENT: Seconds = seconds(5);

export type Verdict =
  /** The phase is not over, or was voided before it was measured. */
  | { readonly kind: "none" }
  /** The server is still at it. */
  | { readonly kind: "measuring" }
  /** The participant hardly moved. */
  | { readonly kind: "still"; readonly movement: Seconds }
  /** It could not be measured; why, in the server's words. */
  | { readonly kind: "unknown"; readonly reason: string | null }
  /** The operator is blinded: in or out of tolerance is all they are told. */
  | { readonly kind: "hidden"; readonly off: boolean }
  | {
      readonly kind: "measured";
      readonly value: Milliseconds;
      /** Half of the 95 % interval. */
      readonly halfWidth: Milliseconds;
      readonly off: boolean;
      /** Achieved minus ordered. */
      readonly by: Milliseconds;
      /** What to keep in mind, in the server's words. */
      readonly reason: string | null;
    };

export function verdictOn(phase: PhaseSummary): Verdict {
  if (phase.movement_s === null) return { kind: phase.status === "done" ? "measuring" : "none" };
  if (phase.latency_off === null)
    return phase.movement_s < LEAST_MOVEMENT
      ? { kind: "still", movement: seconds(phase.movement_s) }
      : { kind: "unknown", reason: phase.latency_reason };
  const { achieved_latency_ms: value, achieved_low_ms: low, achieved_high_ms: high } = phase;
  if (value === null || low === null || high === null || phase.latency_ms === null)
    return { kind: "hidden", off: phase.latency_off };
  return {
    kind: "measured",
    value: milliseconds(value),
    halfWidth: milliseconds((high - low) / 2),
    off: phase.latency_off,
    by: milliseconds(value - phase.latency_ms),
    reason: phase.latency_reason,
  };
}
