import type { Place } from "@shared/avatar/hips";
import { describe, expect, it, vi } from "vitest";
import type { Measures } from "../calibration";
import type { HeadsetState } from "../telemetry";
import { PromptedPerson } from "../testing/promptedPerson";
import { ScriptedPerson, ScriptSource } from "../tracking/script";
import { Headset } from "./headset";
import { FakeBodies, FakeTelemetry, Kept, ORDER, PANEL, STATE } from "./testing";

const RATE_HZ = 90;
const XR = {} as XRFrame;
const BEFORE: HeadsetState = {
  ...STATE,
  materialised: false,
  recording: false,
  step_kind: "materialise",
};

/** A person who wears devices and does what a calibration asks for. */
async function worn({ state = BEFORE, keep = new Kept() } = {}) {
  const telemetry = new FakeTelemetry();
  telemetry.state = state;
  const person = new ScriptedPerson({ statureM: 1.8, spanM: 1.84, seed: 3 });
  const prompted = new PromptedPerson(person);
  const madeFor: Measures[] = [];
  const bodies = new FakeBodies();
  const squares: number[] = [];
  const headset = new Headset({
    telemetry: telemetry.client,
    source: new ScriptSource(person, { worn: {} }),
    keep,
    onSquare: ({ positionM }) => squares.push(Math.hypot(positionM[0], positionM[2])),
    prepareBodies: async (measures) => {
      madeFor.push(measures);
      return bodies;
    },
    scenery: { show: () => undefined },
    withFingers: false,
    onBodyWorn: () => undefined,
    onFailure: (error) => {
      throw error;
    },
  });
  let frame = 0;
  /** The device sleeps: time passes, and nobody is seen. */
  const sleep = (seconds: number): void => {
    frame += Math.round(seconds * RATE_HZ);
  };
  const draw = async (seconds: number) => {
    const until = frame + Math.round(seconds * RATE_HZ);
    while (frame < until) {
      const timeS = ++frame / RATE_HZ;
      const { prompt } = headset.calibrating;
      if (prompt === null) prompted.rest();
      else prompted.follow(prompt.step, timeS);
      headset.frame(timeS, XR);
      // The bodies are prepared meanwhile.
      if (frame % 10 === 0) await Promise.resolve();
    }
  };
  const calibrations = () =>
    telemetry.reports.flatMap((body) => (body.kind === "calibration" ? [body] : []));
  const isUnderway = () => headset.calibrating.isUnderway;
  return {
    telemetry,
    headset,
    keep,
    person,
    madeFor,
    squares,
    draw,
    sleep,
    calibrations,
    isUnderway,
  };
}

const order = (revision: number, calibrate: boolean, shifts_m = {}) => ({
  calibration: { revision, calibrate, shifts_m },
});

describe("Calibration in the visit", () => {
  it("comes before the body, which is made for what was measured and not before", async () => {
    const { telemetry, headset, person, madeFor, squares, draw, calibrations } = await worn();
    await draw(3);
    expect(headset.place).toBe("calibrating");
    expect(madeFor).toEqual([]);
    person.squeezes.left = true;
    person.squeezes.right = true;
    await draw(2);
    expect(telemetry.reports.some(({ kind }) => kind === "materialised")).toBe(false);
    person.squeezes.left = false;
    person.squeezes.right = false;
    await draw(25);
    expect(headset.place).toBe("stepping_in");
    const [report] = calibrations();
    expect(report).toMatchObject({ cause: "first", revision: null, notices: ["waist_inferred"] });
    expect(Math.abs((report?.stature_m ?? 0) - 1.8)).toBeLessThan(0.005);
    expect(Math.abs((report?.span_m ?? 0) - 1.84)).toBeLessThan(0.01);
    expect(madeFor).toHaveLength(1);
    expect(madeFor[0]?.statureM).toBe(report?.stature_m);
    expect(madeFor[0]?.segmentsM).toEqual(report?.segments_m);
    expect(squares).toHaveLength(1);
    const steps = telemetry.reports.flatMap((one) =>
      one.kind === "calibration_step" && one.problem === null ? [one.step] : [],
    );
    expect(new Set(steps)).toEqual(
      new Set(["square", "n_pose", "t_pose", "squat", "reach", "mirror"]),
    );
  });

  it("leaves somebody alone who has stopped, and begins the step again afterwards", async () => {
    const { telemetry, headset, draw, calibrations } = await worn();
    await draw(4);
    const step = headset.calibrating.prompt?.step;
    const panel = { ...PANEL, called: true };
    telemetry.state = { ...BEFORE, panel };
    await draw(40);
    expect(headset.calibrating.prompt).toMatchObject({ step, held: 0, canSkip: false });
    telemetry.state = { ...BEFORE, panel: { ...panel, called: false } };
    await draw(30);
    expect(calibrations()).toHaveLength(1);
  });

  it("begins a step again after a sleep, in which nobody was seen to hold a pose", async () => {
    const { headset, draw, sleep, calibrations } = await worn();
    await draw(3);
    const { step } = headset.calibrating.prompt ?? {};
    expect(step).toBe("n_pose");
    sleep(60);
    await draw(1 / RATE_HZ);
    expect(headset.calibrating.prompt).toMatchObject({ step, held: 0, canSkip: false });
    await draw(0.5);
    expect(headset.calibrating.prompt?.step).toBe(step);
    await draw(30);
    const [report] = calibrations();
    expect(Math.abs((report?.stature_m ?? 0) - 1.8)).toBeLessThan(0.005);
  });

  it("waits while the scene is hidden, though the device goes on drawing", async () => {
    const { headset, draw, calibrations } = await worn();
    await draw(3);
    headset.leave("asleep");
    await draw(60);
    expect(headset.calibrating.prompt).toMatchObject({ step: "n_pose", held: 0 });
    headset.lookAgain();
    await draw(30);
    expect(calibrations()).toHaveLength(1);
  });

  it("stops the clock when it is ordered in a phase, and the same phase goes on", async () => {
    const kept = await worn();
    await kept.draw(30);
    const { telemetry, headset, draw, calibrations, isUnderway, squares } = await worn({
      state: { ...STATE, phase: { ...ORDER, duration_s: 60 } },
      keep: kept.keep,
    });
    await draw(2);
    const phaseId = headset.run?.order.phase_id;
    telemetry.state = { ...telemetry.state, ...order(7, true) };
    await draw(1);
    const phases = () => telemetry.reports.flatMap((one) => (one.kind === "phase" ? [one] : []));
    expect(phases().at(-1)).toMatchObject({ what: "paused", cause: "calibration" });
    await draw(25);
    expect(isUnderway()).toBe(false);
    expect(calibrations()).toEqual([expect.objectContaining({ cause: "order", revision: 7 })]);
    // The boxes stay where they are.
    expect(squares).toEqual([]);
    const phase = telemetry.state.phase;
    if (phase === null) throw new Error("no phase");
    telemetry.state = { ...telemetry.state, phase: { ...phase, resuming: true } };
    await draw(0.5);
    expect(phases().at(-1)).toMatchObject({ what: "resumed", phase_id: phaseId });
    expect(calibrations()).toHaveLength(1);
  });

  it("applies a shift of the operator in the next frame", async () => {
    const { telemetry, headset, draw, person } = await worn();
    await draw(30);
    const source = new ScriptSource(person, { worn: {} });
    const heightM = () => {
      const { LeftHand } = headset.calibrating.calibrator.goals(source.read(headset.timeS));
      return LeftHand?.positionM[1] ?? Number.NaN;
    };
    person.take("t_pose");
    await draw(2);
    const beforeM = heightM();
    const shifts = { LeftHand: [0, 0.03, 0] };
    telemetry.state = { ...telemetry.state, ...order(9, false, shifts) };
    await draw(1 / RATE_HZ);
    expect(heightM() - beforeM).toBeCloseTo(0.03, 2);
  });

  it("leaves the goals alone when another state repeats the operator's shifts", async () => {
    const { telemetry, headset, draw } = await worn();
    await draw(30);
    const shift = vi.spyOn(headset.calibrating.calibrator, "shift");
    for (const leftM of [0.03, 0.03, 0.03, 0.04]) {
      telemetry.state = { ...telemetry.state, ...order(9, false, { LeftHand: [0, leftM, 0] }) };
      await draw(1 / RATE_HZ);
    }
    expect(shift).toHaveBeenCalledTimes(2);
  });

  it("goes on with what was measured when the page is loaded again", async () => {
    const before = await worn();
    await before.draw(30);
    const after = await worn({ state: STATE, keep: before.keep });
    await after.draw(1);
    expect(after.calibrations()).toEqual([]);
    expect(after.madeFor[0]?.statureM).toBe(before.madeFor[0]?.statureM);
  });

  it("keeps where the square lies for a page that is loaded again, until the session is over", async () => {
    const before = await worn();
    const square: Place = { positionM: [0.7, 0, -0.4], rotation: [0.8, 0, 0.6, 0] };
    expect(before.headset.calibrating.keptSquare).toBeNull();
    before.headset.calibrating.keepSquare(square);
    const after = await worn({ keep: before.keep });
    expect(after.headset.calibrating.keptSquare).toEqual(square);
    after.telemetry.state = { ...BEFORE, status: "completed" };
    await after.draw(0.1);
    expect(after.headset.calibrating.keptSquare).toBeNull();
  });

  it("says that usual offsets are used where nothing was kept", async () => {
    const { calibrations, draw } = await worn({ state: STATE });
    await draw(1);
    expect(calibrations()).toEqual([
      expect.objectContaining({ cause: "first", notices: ["usual_offsets"], stature_m: 1.75 }),
    ]);
  });

  it("only finds the square again after the device has moved its origin", async () => {
    const { headset, draw, calibrations, squares } = await worn();
    await draw(30);
    headset.calibrating.squareLost();
    await draw(2);
    expect(squares).toHaveLength(2);
    const [first, again] = calibrations();
    expect(again).toMatchObject({ cause: "reset", stature_m: first?.stature_m });
  });
});
