import { describe, expect, it } from "vitest";
import type { HeadsetState, PhaseOrder, ReportBody } from "../../telemetry";
import type { Touches } from "../contacts";
import type { Limb, TaskLayout } from "../layout";
import { readLayouts } from "../testing/layouts";
import { ORDER } from "../testing/orders";
import type { BoxRun } from "./boxRun";
import { type PhaseSurroundings, Phases } from "./phases";
import { FreeRun } from "./timedRun";

const FRAME_S = 1 / 64;
const HAND: PhaseOrder = { ...ORDER, kind: "task", limb: "hand", duration_s: 10 };
const PARTS = ["RightHand", "LeftHand"];

const stateWith = (phase: PhaseOrder | null, handedness = "right"): HeadsetState => ({
  type: "state",
  version: 1,
  status: "active",
  step_index: 0,
  step_kind: "task",
  materialised: true,
  recording: true,
  phase,
  participant: { handedness, footedness: "right", stature_m: 1.7 },
});

/** A headset around the phases that notes what they ask of it. */
class Noted implements PhaseSurroundings {
  readonly lines: string[] = [];
  readonly reports: ReportBody[] = [];
  readonly phases: Phases;
  timeS = 0;

  constructor() {
    const layout = readLayouts().get("hand") as TaskLayout;
    this.phases = new Phases(new Map<Limb, TaskLayout>([["hand", layout]]), this);
  }

  report(reports: readonly ReportBody[]): void {
    this.reports.push(...reports);
    for (const one of reports) this.lines.push(one.kind === "phase" ? one.what : one.kind);
  }

  enter({ phase_id }: PhaseOrder, layout: TaskLayout | null): void {
    this.lines.push(`enter ${phase_id} ${layout?.limb ?? "free"}`);
  }

  leave({ phase_id }: PhaseOrder): void {
    this.lines.push(`leave ${phase_id}`);
  }

  touchingParts(): readonly string[] {
    return PARTS;
  }

  follow(phase: PhaseOrder | null, isSettled = true): void {
    this.phases.follow(stateWith(phase), isSettled, this.timeS);
  }

  draw(seconds: number, touches: Touches | null = null, isConnected = true): void {
    for (const endS = this.timeS + seconds; this.timeS < endS; ) {
      this.timeS += FRAME_S;
      this.phases.frame(this.timeS, touches, isConnected);
    }
  }
}

/** Touches in which these pairs of surface and part touch. */
function touchesOf(...pairs: readonly (readonly [string, string])[]): Touches {
  const surfaces = readLayouts().get("hand")?.surfaces ?? [];
  const touched = Uint8Array.from(
    surfaces.flatMap(({ key }) =>
      PARTS.map((part) => Number(pairs.some((one) => one[0] === key && one[1] === part))),
    ),
  );
  return { touched, near: touched };
}

describe("the phases of a session", () => {
  it("are entered, reported and left in the order of the states", () => {
    const headset = new Noted();
    headset.follow(ORDER);
    headset.draw(2);
    headset.follow({ ...ORDER, phase_id: 2 });
    expect(headset.lines).toEqual([
      "enter 1 free",
      "started",
      "time_up",
      "ended",
      "leave 1",
      "enter 2 free",
    ]);
  });

  it("are not entered again by a state that is older than the report of their end", () => {
    const headset = new Noted();
    headset.follow(ORDER);
    headset.draw(2);
    headset.follow({ ...ORDER, status: "freezing" });
    expect(headset.phases.run).toBeNull();
    expect(headset.phases.phaseId).toBe(0);
  });

  it("are dropped without a report if they are gone from the state, or replaced in it", () => {
    const headset = new Noted();
    headset.follow(ORDER);
    headset.draw(1);
    headset.follow(null);
    headset.follow({ ...ORDER, phase_id: 2 });
    headset.follow({ ...ORDER, phase_id: 3 });
    const lines = ["enter 1 free", "started", "leave 1", "enter 2 free", "leave 2", "enter 3 free"];
    expect(headset.lines).toEqual(lines);
  });

  it("do not act on a state that may lack their own reports", () => {
    const headset = new Noted();
    headset.follow(ORDER);
    headset.draw(1);
    headset.follow({ ...ORDER, status: "running", pausing: true }, false);
    expect(headset.phases.run?.clockRuns).toBe(true);
    headset.follow({ ...ORDER, status: "running", pausing: true });
    expect(headset.phases.run?.isPaused).toBe(true);
  });

  it("say which limb a study has no boxes for", () => {
    const foot = { ...HAND, limb: "foot" };
    expect(() => new Noted().follow(foot)).toThrow(
      "task for the foot, and the study's tasks have hand",
    );
  });
});

describe("a device that was asleep", () => {
  it("stops its clock at the last frame it drew, and resumes with the operator", () => {
    const headset = new Noted();
    headset.follow(ORDER);
    headset.draw(1);
    const lastFrameS = headset.timeS;
    const activeS = headset.phases.run?.activeS(lastFrameS) ?? 0;
    headset.timeS += 3;
    headset.phases.wake(lastFrameS, headset.timeS);
    headset.draw(0.5);
    const paused = { kind: "phase", phase_id: 1, what: "paused", t_s: lastFrameS };
    expect(headset.reports.at(-1)).toEqual({ ...paused, active_s: activeS, cause: "asleep" });
    headset.follow({ ...ORDER, status: "paused", active_s: activeS, resuming: true });
    const resumedS = headset.timeS;
    headset.draw(2);
    const timeUp = headset.reports.find((one) => one.kind === "phase" && one.what === "time_up");
    expect(timeUp).toMatchObject({ active_s: 1, t_s: resumedS + (1 - activeS) });
  });

  it("has not prepared the participant meanwhile", () => {
    const headset = new Noted();
    headset.follow(ORDER);
    headset.draw(0.25);
    headset.phases.wake(headset.timeS, headset.timeS + 5);
    headset.timeS += 5;
    expect(headset.phases.run?.preparationLeftS(headset.timeS)).toBeCloseTo(0.25, 9);
    headset.draw(0.2);
    expect(headset.lines).toEqual(["enter 1 free"]);
  });

  it("does not stop a clock that a walk back or a pause has stopped already", () => {
    const headset = new Noted();
    headset.follow(ORDER);
    headset.draw(1);
    headset.phases.stop(headset.timeS, "recentred");
    headset.phases.wake(headset.timeS, headset.timeS + 2);
    expect(headset.reports.map((one) => one.kind === "phase" && one.cause)).toEqual([
      "headset",
      "recentred",
    ]);
  });
});

describe("a phase at the boxes", () => {
  it("counts the hand that the participant writes with", () => {
    const headset = new Noted();
    headset.phases.follow(stateWith(HAND, "left"), true, 0);
    headset.draw(1, touchesOf());
    headset.draw(0.1, touchesOf(["hand/1/panel", "LeftHand"]));
    headset.draw(0.1, touchesOf());
    expect(headset.reports.at(-1)).toMatchObject({ surface: "hand/1/panel", effect: "green" });
  });

  it("makes nothing new in a frame in which nothing happens", () => {
    const headset = new Noted();
    headset.follow(HAND);
    headset.draw(1, touchesOf(["hand/2/left", "RightHand"]));
    const run = headset.phases.run as BoxRun;
    const { state } = run;
    const none = run.frame(headset.timeS, touchesOf(["hand/2/left", "RightHand"]), true);
    expect(run.state).toBe(state);
    expect(run.frame(headset.timeS, touchesOf(["hand/2/left", "RightHand"]), true)).toBe(none);
  });

  it("keeps running without touches, as before the avatar's first frame", () => {
    const run = new FreeRun(ORDER, 0);
    expect(run.frame(0.5, null, true)).toHaveLength(1);
    expect(run.activeS(0.75)).toBe(0.25);
  });
});
