/** A phase as the server orders it, for tests that change what matters to them. */
import type { PhaseOrder } from "../../telemetry";

export const ORDER: PhaseOrder = {
  phase_id: 1,
  kind: "free_roam",
  limb: null,
  status: "preparing",
  latency_ms: 0,
  preparation_s: 0.5,
  duration_s: 1,
  freeze_s: 0.25,
  active_s: 0,
  completions: 0,
  pausing: false,
  resuming: false,
  until_completions: null,
};
