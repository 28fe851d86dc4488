import { describe, expect, it } from "vitest";
import { seconds } from "../units";
import { floorPlan, stepFor } from "./floor";
import {
  boxOf,
  decodeMotion,
  drawnEvery,
  durationOf,
  frameAt,
  MotionError,
  type PointMotion,
  recordedFrame,
  timeOf,
} from "./motion";
import { gapStretches, hasGaps, placing, seenFrames, unseenNames } from "./placing";
import { advance } from "./usePlayback";

const HEADER = {
  kind: "skeleton",
  names: ["Hips", "Knie-Ä"],
  parents: [-1, 0],
  frames: 2,
  rate_hz: 60,
  recorded_rate_hz: 120,
};

/** Encode a preview like app/features/movement/captures/preview.py, with or without its padding. */
function encoded(values: readonly number[], padded = true): ArrayBuffer {
  const text = new TextEncoder().encode(JSON.stringify(HEADER));
  const length = padded ? text.length + ((4 - (text.length % 4)) % 4) : text.length;
  const bytes = new Uint8Array(4 + length + 4 * values.length).fill(32);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, length, true);
  bytes.set(text, 4);
  values.forEach((value, index) => {
    view.setFloat32(4 + length + 4 * index, value, true);
  });
  return bytes.buffer;
}

const VALUES = [0, 1, 2, 0.5, 0.25, -1, 3, 1, 2, Number.NaN, Number.NaN, Number.NaN];

const movement = (positions: readonly number[], points = 1, rateHz = 60): PointMotion => ({
  kind: "markers",
  names: Array.from({ length: points }, (_, index) => `m${index}`),
  parents: Array.from({ length: points }, () => -1),
  frames: positions.length / 3 / points,
  rateHz,
  recordedRateHz: 2 * rateHz,
  positions: new Float32Array(positions),
});

const seenAt = (...heights: (number | null)[]) =>
  movement(heights.flatMap((y) => (y === null ? [Number.NaN, Number.NaN, Number.NaN] : [0, y, 0])));

describe("the bytes of a preview", () => {
  it("have names, parents and rates in the header, followed by positions", () => {
    const motion = decodeMotion(encoded(VALUES));
    expect(motion).toMatchObject({ names: ["Hips", "Knie-Ä"], parents: [-1, 0], frames: 2 });
    expect([motion.rateHz, motion.recordedRateHz]).toEqual([60, 120]);
    expect([...motion.positions]).toEqual(VALUES);
  });

  it("are decoded at any offset of the numbers", () => {
    expect([...decodeMotion(encoded(VALUES, false)).positions]).toEqual(VALUES);
  });

  it("are rejected if they are truncated or not a movement", () => {
    const whole = encoded(VALUES);
    for (const length of [0, 3, 20, whole.byteLength - 4]) {
      expect(() => decodeMotion(whole.slice(0, length))).toThrow(MotionError);
    }
    expect(() => decodeMotion(new Uint8Array([1, 0, 0, 0, 123]).buffer)).toThrow(MotionError);
  });
});

describe("time and frame", () => {
  const motion = movement(Array.from({ length: 3 * 344 }, () => 0));

  it("convert to each other for every frame", () => {
    for (let frame = 0; frame < motion.frames; frame++) {
      expect(frameAt(motion, timeOf(motion, frame))).toBe(frame);
    }
  });

  it("stay within the movement, which lasts from the first to the last frame", () => {
    expect(durationOf(motion)).toBeCloseTo(343 / 60, 12);
    expect([frameAt(motion, seconds(-1)), frameAt(motion, seconds(99))]).toEqual([0, 343]);
    expect(durationOf(movement([0, 0, 0]))).toBe(0);
  });

  it("give the frame number of the recording if frames were left out", () => {
    expect(recordedFrame(motion, 10)).toBe(20);
    // One press goes on by one drawn frame, which is said to be two of the recording.
    expect(drawnEvery(motion)).toBe(2);
    expect(recordedFrame(motion, 11) - recordedFrame(motion, 10)).toBe(drawnEvery(motion));
    expect(drawnEvery({ ...motion, recordedRateHz: motion.rateHz })).toBe(1);
  });

  it("advance during playback, to the end or in a loop", () => {
    expect(advance(seconds(1), 0.5, seconds(2), false)).toEqual({ time: 1.5, ended: false });
    expect(advance(seconds(1.5), 1, seconds(2), false)).toEqual({ time: 2, ended: true });
    expect(advance(seconds(1.5), 1, seconds(2), true)).toEqual({ time: 0.5, ended: false });
    expect(advance(seconds(0), 1, seconds(0), true)).toEqual({ time: 0, ended: true });
  });
});

describe("an unseen point", () => {
  const motion = seenAt(null, 1, null, null, 2);

  it("is shown where it was last seen, or before that where it will appear", () => {
    expect([...seenFrames(motion)]).toEqual([1, 1, 1, 1, 4]);
    expect([...seenFrames(seenAt(null, null))]).toEqual([-1, -1]);
  });

  it("is placed there and marked", () => {
    const body = placing({ key: "a", motion, tone: "solid", offset: [5, -5] });
    body.place(timeOf(motion, 3));
    expect([...body.placed]).toEqual([5, 1, -5]);
    expect([...body.seen]).toEqual([0]);
    body.place(timeOf(motion, 4));
    expect([[...body.placed], [...body.seen]]).toEqual([[5, 2, -5], [1]]);
  });

  it("is reported in intervals, however long the movement is", () => {
    expect(hasGaps(motion)).toBe(true);
    expect(gapStretches(motion)).toEqual([
      { from: 0, to: 1, share: 1 },
      { from: 2, to: 4, share: 1 },
    ]);
    expect(gapStretches(motion, 1)).toEqual([{ from: 0, to: 5, share: 1 }]);
    expect(gapStretches(seenAt(1, 2))).toEqual([]);
    expect(unseenNames(motion, 2)).toEqual(["m0"]);
  });
});

describe("the floor", () => {
  it("lies under everything that moves, in whole steps, wherever it was moved to", () => {
    const motion = movement([0, 0, 0, 2.5, 1.8, -1.2]);
    expect(boxOf(motion)?.max).toEqual([2.5, Math.fround(1.8), 0]);
    const plan = floorPlan([{ key: "a", motion, tone: "solid", offset: [0, 10] }]);
    expect(plan).toMatchObject({ min: [-1, 8], max: [3, 11], step: 1 });
  });

  it("is at least a metre wide under a single tracker at rest", () => {
    const motion = movement([5, 0.1, 5, 5, 0.1, 5]);
    const plan = floorPlan([{ key: "a", motion, tone: "solid" }]);
    expect(plan).toMatchObject({ min: [4, 4], max: [6, 6], step: 1 });
  });

  it("is divided into metres for a room, and into multiples of ten for a wrong unit", () => {
    expect([1.7, 8, 39].map(stepFor)).toEqual([1, 1, 1]);
    expect([170, 1700].map(stepFor)).toEqual([10, 100]);
    expect([0.17, 0.0017].map(stepFor)).toEqual([0.1, 0.001]);
    expect(stepFor(0)).toBe(1);
  });

  it("exists even if nothing was ever seen", () => {
    expect(floorPlan([{ key: "a", motion: seenAt(null), tone: "solid" }]).step).toBe(1);
  });
});
