import { GOAL_PARTS } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import { describe, expect, it } from "vitest";
import type { GoalPart, GoalState, TrackedFrame } from "../../tracking/tracked";
import { PhysicsRecord } from "./physics";
import { FrameTimes } from "./rendering";
import { Samples } from "./samples";
import { StorageRecord } from "./storage";
import { TrackingRecord } from "./tracking";

const HZ = 90;

describe("percentiles", () => {
  it("lie between samples as NumPy's default does", () => {
    const samples = new Samples();
    for (const value of [4, 1, 3, 2]) samples.add(value);
    // numpy.percentile([1, 2, 3, 4], [0, 50, 95, 100])
    const [least, middle, p95, most] = samples.percentiles(0, 0.5, 0.95, 1);
    expect([least, middle, most]).toEqual([1, 2.5, 4]);
    expect(p95).toBeCloseTo(3.85, 12);
  });

  it("never descend, and are 0 without samples", () => {
    const samples = new Samples();
    expect(samples.percentiles(0.5, 1)).toEqual([0, 0]);
    for (let i = 0; i < 40_000; i++) samples.add(0.1 + 1e-16 * (i % 7) + 0.3 * Math.sin(i));
    const found = samples.percentiles(0.5, 0.95, 0.99, 0.9999, 1);
    expect([...found].sort((a, b) => a - b)).toEqual(found);
    expect(samples.count).toBe(40_000);
  });
});

describe("the frames", () => {
  const times = (intervalsS: readonly number[]): FrameTimes => {
    const frames = new FrameTimes();
    let timeS = 17;
    frames.note(timeS);
    for (const intervalS of intervalsS) {
      timeS += intervalS;
      frames.note(timeS);
    }
    return frames;
  };

  it("are late beyond one and a half nominal intervals, and at that not yet", () => {
    const figures = times([1 / HZ, 1.5 / HZ, 1.6 / HZ, 1 / HZ, 0.4]).figures("immersive", HZ);
    expect(figures.late_frames).toBe(2);
    expect(figures.frames).toBe(6);
    expect(figures.interval_longest_s).toBeCloseTo(0.4, 9);
    expect(figures.mean_rate_hz).toBeCloseTo(5 / (5.1 / HZ + 0.4), 6);
  });

  it("are not called late where the device does not tell its rate", () => {
    expect(times([1 / HZ, 3]).figures("screen", null).late_frames).toBeNull();
  });
});

describe("tracking", () => {
  const at = (x: number): Place => ({ positionM: [x, 1, 0], rotation: [1, 0, 0, 0] });
  const frame = (
    timeS: number,
    head: GoalState,
    x: number,
  ): Pick<TrackedFrame, "timeS" | "parts"> => {
    const lost = { place: null, state: "lost", device: null } as const;
    const parts = Object.fromEntries(GOAL_PARTS.map((part) => [part, lost]));
    const place = head === "lost" ? null : at(x);
    parts.Head = { place, state: head, device: place && "headset" } as never;
    return { timeS, parts: parts as unknown as Record<GoalPart, TrackedFrame["parts"][GoalPart]> };
  };

  it("counts time by the state that it ends in, and the longest loss without a break", () => {
    const record = new TrackingRecord();
    const states = ["tracked", "lost", "lost", "tracked", "lost", "inferred"] as const;
    for (const [second, state] of states.entries()) record.note(frame(second, state, second));
    const { Head, LeftHand } = record.figures();
    expect(Head).toEqual({
      tracked: 0.2,
      inferred: 0.2,
      lost: 0.6,
      longest_loss_s: 2,
      pose_rate_hz: 0.4,
    });
    expect(LeftHand).toMatchObject({ lost: 1, longest_loss_s: 5, pose_rate_hz: 0 });
  });

  it("gives shares of at most 1 however many frames are added up", () => {
    const record = new TrackingRecord();
    for (let i = 0; i < 10_000; i++) record.note(frame(3 + i / HZ, "tracked", 0));
    const { Head, Hips } = record.figures();
    expect([Head.tracked, Hips.lost]).toEqual([1, 1]);
    // The same pose to the last bit is none that was measured.
    expect(Head.pose_rate_hz).toBe(0);
  });
});

describe("the physics", () => {
  const MODEL = { model_hash: "0".repeat(64), stature_m: 1.75, where: "worker" } as const;
  const noted = (
    results: readonly (readonly [timeS: number, tookMs: number, resets: number])[],
  ) => {
    const record = new PhysicsRecord();
    for (const [timeS, tookMs, resets] of results)
      record.note({ timeS, tookMs, health: { resets } });
    return record.figures(MODEL);
  };

  it("is compared with the time that was simulated, without the gaps that were left out", () => {
    const figures = noted([
      [10, 50, 3],
      [10.01, 2, 3],
      [10.02, 2, 4],
      [10.02, 99, 4],
      [13.02, 60, 4],
    ]);
    expect(figures?.simulated_s).toBeCloseTo(0.02, 9);
    expect(figures?.real_time_factor).toBeCloseTo(5, 9);
    expect(figures?.frame_p50_s).toBeCloseTo(0.002, 12);
    expect(figures?.resets).toBe(1);
  });

  it("has no figures where nothing was simulated", () => {
    expect(noted([])).toBeNull();
    expect(
      noted([
        [1, 3, 0],
        [2, 3, 0],
      ]),
    ).toBeNull();
  });
});

describe("storage", () => {
  it("takes each batch's time to its own stream's acknowledgement, and counts the others", () => {
    const record = new StorageRecord();
    expect(record.figures()).toBeNull();
    record.sent("target", 6, 2304, 1);
    record.sent("actual", 6, 2304, 1);
    record.sent("target", 12, 2304, 2);
    record.acknowledged("target", 6, 1.1);
    record.acknowledged("target", 6, 1.9);
    record.acknowledged("actual", 6, 1.3);
    expect(record.waiting).toBe(1);
    const figures = record.figures();
    expect(figures).toMatchObject({ batches: 3, bytes: 6912, acknowledged: 2, bytes_per_s: 6912 });
    expect(figures?.round_trip_p50_s).toBeCloseTo(0.2, 9);
    expect(figures?.round_trip_longest_s).toBeCloseTo(0.3, 9);
    expect(figures).toMatchObject({ journal_writes: 0, journal_write_p95_s: null });
  });

  it("takes the time of the journal's writes from every transaction", () => {
    const record = new StorageRecord();
    record.sent("target", 6, 2304, 1);
    for (const tookS of [0.004, 0.001, 0.003, 0.002]) record.written(tookS);
    const figures = record.figures();
    expect(figures?.journal_writes).toBe(4);
    expect(figures?.journal_write_p95_s).toBeCloseTo(0.00385, 12);
  });

  it("has no round trips where nothing was acknowledged", () => {
    const record = new StorageRecord();
    record.sent("target", 6, 2304, 1);
    expect(record.figures()).toMatchObject({ acknowledged: 0, round_trip_p50_s: null });
  });
});
