import { decodeMovement, type Replay } from "@shared/api/replays";
import { describe, expect, it } from "vitest";
import { addressOf, paramsFrom } from "./address";
import { errorsAt, largest, overall } from "./ErrorMap";
import {
  activeAt,
  clockAt,
  endOf,
  eventsOf,
  isActive,
  isEverPaused,
  jumpFrom,
  latestEventAt,
  tonesAt,
  touches,
  wallAt,
} from "./events";

const contact = (surface: string, begin_s: number, end_s: number, more: object = {}) => ({
  surface,
  surface_kind: surface.split("/")[2] === "panel" ? "panel" : "side",
  box: 2,
  body_part: "RightHand",
  effect: "side",
  begin_s,
  end_s,
  begin_active_s: begin_s,
  end_active_s: end_s,
  ...more,
});
const completion = (number: number, t_s: number) => ({
  number,
  t_s,
  active_s: t_s,
  duration_s: t_s,
  out_of_order_touches: 0,
});
/** Active for 10 s, paused for 5 s, active again; a second of the headset is half a real one. */
const paused = {
  active: [
    { begin_s: 0, end_s: 10, begin_active_s: 0, end_active_s: 10 },
    { begin_s: 15, end_s: 65, begin_active_s: 10, end_active_s: 60 },
  ],
  runs: [{ epoch: 1, begin_s: 0, end_s: 65, begin_utc: "2026-03-02T12:00:00Z", uncertainty_ms: 1 }],
  time_scale: 2,
};

describe("the address of a moment", () => {
  it("leads back to the same phase, time and comparison", () => {
    const params = { phase: 2, time: 12.5, comparedWith: { session: "own", phase: 5 } };
    const address = addressOf("own", params);
    expect(address).toBe("#/sessions/own/replay?phase=2&t=12.5&with=5");
    expect(paramsFrom(address, "own")).toEqual(params);
    const other = { ...params, comparedWith: { session: "other", phase: 3 } };
    expect(paramsFrom(addressOf("own", other), "own")).toEqual(other);
  });

  it("is ignored if it is invalid", () => {
    const nothing = { phase: null, time: 0, comparedWith: null };
    expect(paramsFrom("#/sessions/own/replay", "own")).toEqual(nothing);
    expect(paramsFrom("#/sessions/own/replay?phase=x&t=-3&with=a:", "own")).toEqual(nothing);
  });
});

describe("the times of a moment", () => {
  it("keep the active time constant during a pause", () => {
    expect([9, 12, 17, 99].map((time) => activeAt(paused, time))).toEqual([9, 10, 12, 60]);
    expect([9, 12, 17, 65].map((time) => isActive(paused, time))).toEqual([
      true,
      false,
      true,
      false,
    ]);
  });

  it("stop for good at the end: what is recorded after it is not a pause", () => {
    const moments = [
      { what: "time_up", t_s: 65.02, active_s: 60, cause: null },
      { what: "ended", t_s: 67, active_s: 60, cause: null },
    ] as const;
    const replay = { ...paused, moments, duration_s: 68 };
    expect(endOf(replay)).toBe(65.02);
    expect([9, 12, 64, 66, 68].map((time) => clockAt(replay, time))).toEqual([
      "active",
      "standing",
      "active",
      "over",
      "over",
    ]);
    expect(isEverPaused(replay)).toBe(true);
    // A phase that ended in a pause was paused until then.
    const inPause = { ...replay, moments: moments.slice(1) };
    expect([66, 67].map((time) => clockAt(inPause, time))).toEqual(["standing", "over"]);
    // The headset was lost, and never reported the end: while the clock ran, or in a pause.
    const lost = (what: "resumed" | "paused") => [{ what, t_s: 15, active_s: 10, cause: null }];
    expect(endOf({ ...replay, moments: lost("resumed") })).toBe(65);
    expect(endOf({ ...replay, moments: lost("paused") })).toBe(68);
    const whole = { active: paused.active.slice(0, 1), moments, duration_s: 10 };
    expect(isEverPaused(whole)).toBe(false);
  });

  it("give the time of day by the server's seconds", () => {
    expect(wallAt(paused, 10)?.toISOString()).toBe("2026-03-02T12:00:05.000Z");
    expect(wallAt({ runs: [], time_scale: 1 }, 10)).toBeNull();
  });
});

describe("the events of a phase", () => {
  it("contain one touch if several parts touch the same surface simultaneously", () => {
    const found = touches([
      contact("hand/2/left", 1, 3),
      contact("hand/2/left", 2, 4, { body_part: "RightLowerArm" }),
      contact("hand/2/left", 6, 7),
    ]);
    expect(found.map(({ time, end, parts }) => [time, end, parts])).toEqual([
      [1, 4, ["RightHand", "RightLowerArm"]],
      [6, 7, ["RightHand"]],
    ]);
  });

  it("keep the judgement of parts that touch together", () => {
    const [one] = touches([
      contact("hand/2/panel", 1, 3, { effect: "none" }),
      contact("hand/2/panel", 2, 3, { effect: "green" }),
    ]);
    expect(one?.effect).toBe("green");
  });

  it("are in order of time, and lead from one to the next", () => {
    const all = eventsOf({
      moments: [{ what: "started", t_s: 0, active_s: 0, cause: null }],
      contacts: [contact("hand/2/left", 1, 3)],
      completions: [completion(1, 2)],
      notes: [{ id: "n", text: "Asked for water", by: "account:a", at: "", t_s: 1.5 }],
    } as unknown as Replay);
    expect(all.map(({ kind }) => kind)).toEqual(["clock", "touch", "note", "done"]);
    expect(latestEventAt(all, 1.6)).toBe(2);
    expect([jumpFrom(all, 1, 1), jumpFrom(all, 1, -1), jumpFrom(all, 2, 1)]).toEqual([
      1.5,
      0,
      null,
    ]);
  });
});

describe("the boxes", () => {
  const phase = {
    contacts: [
      contact("hand/2/panel", 1, 1.5, { effect: "green" }),
      contact("hand/2/left", 2, 3),
      contact("hand/3/panel", 2, 3, { effect: "out_of_order" }),
    ],
    completions: [completion(1, 8)],
  };

  it("keep a panel good until the task is completed, and glow while they are touched", () => {
    expect([...tonesAt(phase, 0.5)]).toEqual([]);
    expect([...tonesAt(phase, 2.5)]).toEqual([
      ["hand/2/panel", "good"],
      ["hand/2/left", "bad"],
      ["hand/3/panel", "odd"],
    ]);
    expect([...tonesAt(phase, 5)]).toEqual([["hand/2/panel", "good"]]);
    expect([...tonesAt(phase, 8)]).toEqual([]);
  });
});

describe("joint errors", () => {
  const errors = {
    joints: ["Head", "LeftHand", "RightHand"],
    frames: 2,
    rateHz: 10,
    values: Float32Array.from([0, 0, 0, Math.PI / 2, Number.NaN, Math.PI / 6]),
  };

  it("are those of the nearest moment, the largest first, without unknown ones", () => {
    const now = errorsAt(errors, 0.12);
    expect(now[1]).toEqual({ joint: "LeftHand", degrees: null });
    expect(largest(now, 5).map(({ joint }) => joint)).toEqual(["Head", "RightHand"]);
    expect(overall(now)).toBeCloseTo(Math.sqrt((90 ** 2 + 30 ** 2) / 2), 3);
    expect(overall(errorsAt({ ...errors, frames: 0, values: new Float32Array() }, 0))).toBeNull();
  });
});

describe("the bytes of a movement", () => {
  const bytesOf = (
    bodies: readonly string[],
    numbers: readonly number[],
    more: object = {},
    integers: readonly number[] = [],
  ): ArrayBuffer => {
    const header = {
      ...{ names: ["Hips"], parents: [-1], bodies, frames: 1, rate_hz: 30, gaps: [[1, 2]] },
      ...{ error_joints: ["Head"], error_frames: bodies.length - 1, error_rate_hz: 10 },
      ...more,
    };
    const text = JSON.stringify(header);
    const padded = text + " ".repeat((4 - (text.length % 4)) % 4);
    const integersAt = 4 + padded.length + 4 * numbers.length;
    const bytes = new Uint8Array(integersAt + 2 * integers.length);
    new DataView(bytes.buffer).setUint32(0, padded.length, true);
    bytes.set(new TextEncoder().encode(padded), 4);
    bytes.set(new Uint8Array(Float32Array.from(numbers).buffer), 4 + padded.length);
    bytes.set(new Uint8Array(Int16Array.from(integers).buffer), integersAt);
    return bytes.buffer;
  };

  it("contain both bodies and the errors, or the participant alone", () => {
    const both = decodeMovement(bytesOf(["target", "actual"], [1, 2, 3, 4, 5, 6, 7]));
    expect([...both.participant.positions]).toEqual([1, 2, 3]);
    expect([...(both.avatar?.positions ?? [])]).toEqual([4, 5, 6]);
    expect([...both.errors.values]).toEqual([7]);
    expect(both.gaps).toEqual([[1, 2]]);
    expect(decodeMovement(bytesOf(["target"], [1, 2, 3])).avatar).toBeNull();
  });

  it("contain the rotations of joints and fingers where they were asked for", () => {
    const asked = { rotations: true, finger_parts: ["LeftThumbProximal"] };
    const integers = [1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0];
    const { participant, avatar, errors } = decodeMovement(
      bytesOf(["target", "actual"], [1, 2, 3, 4, 5, 6, 7], asked, integers),
    );
    expect([...errors.values]).toEqual([7]);
    expect([participant.rotations?.[0], avatar?.rotations?.[0]]).toEqual([1, 2]);
    expect([...(participant.fingers ?? [])]).toEqual([3, 0, 0, 0]);
    expect([...(avatar?.fingers ?? [])]).toEqual([4, 0, 0, 0]);
    expect(decodeMovement(bytesOf(["target"], [1, 2, 3])).participant.fingers).toBeUndefined();
  });

  it("are rejected if they are truncated", () => {
    expect(() => decodeMovement(bytesOf(["target"], [1, 2]))).toThrow("Expected 3 numbers");
    expect(() => decodeMovement(new ArrayBuffer(2))).toThrow("are not a movement");
  });
});
