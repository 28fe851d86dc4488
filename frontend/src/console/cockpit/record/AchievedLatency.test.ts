import type { PhaseSummary } from "@shared/api/types";
import { describe, expect, it } from "vitest";
import { verdictOn } from "./AchievedLatency";

const phase = (more: Partial<PhaseSummary>): PhaseSummary => ({
  phase_id: 1,
  step_index: 2,
  attempt: 1,
  kind: "task",
  limb: "hand",
  latency_ms: 125,
  body: null,
  status: "done",
  active_s: 60,
  completions: 3,
  side_contacts: 0,
  side_contact_s: 0,
  achieved_latency_ms: null,
  achieved_low_ms: null,
  achieved_high_ms: null,
  latency_off: null,
  latency_reason: null,
  movement_s: null,
  started_at: null,
  ended_at: null,
  ...more,
});

describe("the verdict on a phase's latency", () => {
  it("waits for the end of the phase, then for the server", () => {
    expect(verdictOn(phase({ status: "running" })).kind).toBe("none");
    expect(verdictOn(phase({ status: "voided" })).kind).toBe("none");
    expect(verdictOn(phase({})).kind).toBe("measuring");
  });

  it("reports how little was moved, or another reason why there is none", () => {
    expect(verdictOn(phase({ movement_s: 3.2 }))).toEqual({ kind: "still", movement: 3.2 });
    const reason = "The bodies do not turn alike at any one lag (correlation 0.20).";
    expect(verdictOn(phase({ movement_s: 58, latency_reason: reason }))).toEqual({
      kind: "unknown",
      reason,
    });
  });

  it("gives the value, half the interval and the difference from the set latency", () => {
    const measured = {
      movement_s: 58,
      achieved_latency_ms: 145,
      achieved_low_ms: 144.5,
      achieved_high_ms: 145.5,
      latency_off: true,
    };
    expect(verdictOn(phase(measured))).toEqual({
      kind: "measured",
      value: 145,
      halfWidth: 0.5,
      off: true,
      by: 20,
      reason: null,
    });
  });

  it("tells a blinded operator only whether it is out of tolerance", () => {
    const blinded = { movement_s: 58, latency_ms: null };
    expect(verdictOn(phase({ ...blinded, latency_off: true }))).toEqual({
      kind: "hidden",
      off: true,
    });
    expect(verdictOn(phase({ ...blinded, latency_off: false }))).toEqual({
      kind: "hidden",
      off: false,
    });
  });
});
