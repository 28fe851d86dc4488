import { describe, expect, it } from "vitest";
import type { Command } from "./physics/commands";
import type { Progress } from "./physics/tryout";
import { TryoutRun } from "./run";
import type { FromWorker, ToWorker, TryoutPort } from "./worker/messages";

const RADIANS = Math.PI / 180;

/** A worker whose answers the test gives: the angle is always at its target. */
class Worker implements TryoutPort {
  onmessage: TryoutPort["onmessage"] = null;
  sent: ToWorker[] = [];
  private timeS = 0;

  postMessage(message: ToWorker): void {
    this.sent.push(message);
  }

  terminate(): void {}

  say(message: FromWorker): void {
    this.onmessage?.({ data: message } as MessageEvent<FromWorker>);
  }

  open(bodies = 1): void {
    this.say({ kind: "opened", shapes: Array(bodies).fill([]), longestLatencyS: 1 });
  }

  /** Answer the request under way; returns its ticks, 0 for none. */
  answer(targetDeg = 0, bodies = 1): number {
    const asked = this.sent.findLast((one) => one.kind === "advance");
    if (asked === undefined) return 0;
    this.sent = [];
    const { ticks, axis } = asked;
    const target = targetDeg * RADIANS;
    const readings = Float64Array.from({ length: 3 * ticks }, (_, at) => (at % 3 < 2 ? target : 1));
    const one = { places: new Float32Array(7), readings, limitNm: 10 } as unknown as Progress;
    this.timeS += 0.01 * ticks;
    const advance = { ticks, axis, timeS: this.timeS, tookMs: 1, bodies: Array(bodies).fill(one) };
    this.say({ kind: "advanced", advance });
    return ticks;
  }
}

const started = () => {
  const worker = new Worker();
  const run = new TryoutRun(worker, "LeftUpperArmZ");
  const bodies = [{ mjcf: "", configuration: {} }] as never;
  run.open(new ArrayBuffer(0), bodies);
  worker.open();
  let nowMs = 0;
  /** Let pictures of 20 ms pass; the worker answers each. */
  const pass = (pictures: number, targetDeg = 0, count = 1) => {
    for (let picture = 0; picture < pictures; picture++) {
      nowMs += 20;
      run.frame(nowMs);
      worker.answer(targetDeg, count);
    }
  };
  const skip = (ms: number) => {
    nowMs += ms;
  };
  return { worker, run, bodies, pass, skip, now: () => nowMs };
};
const LATENCY: Command = { kind: "latency", latencyS: 0.125 };
const PUSH: Command = {
  kind: "push",
  push: { part: "Head", pointM: null, forceN: [0, 0, -100], forS: 0.2 },
};
const pull = (x: number): Command => ({
  kind: "push",
  push: { part: "Head", pointM: [0, 0, 0], forceN: [x, 0, 0], forS: null },
});

describe("the curves of a run", () => {
  it("go on when a body is put beside, when the body changes, and when the pose is reset", () => {
    const { worker, run, bodies, pass } = started();
    pass(50);
    const length = run.traces[0]?.length ?? 0;
    expect(length).toBeGreaterThan(90);
    run.change([...(bodies as never[]), { mjcf: "other", configuration: {} }] as never);
    worker.open(2);
    expect(run.traces.map((one) => one.length)).toEqual([length, 0]);
    pass(5, 0, 2);
    const [own = 0, other = 0] = run.traces.map((one) => one.length);
    expect(own - other).toBe(length);
    expect(run.marks.since(0)).toEqual([]);
    run.send({ kind: "reset" });
    pass(5, 0, 2);
    expect(run.traces[0]?.length).toBeGreaterThan(own);
    run.change([{ mjcf: "edited", configuration: {} }] as never);
    worker.open(1);
    expect(run.traces[0]?.length).toBeGreaterThan(own);
    expect(run.marks.since(0).map(({ kind }) => kind)).toEqual(["reset", "change"]);
  });

  it("begin anew with another axis, once its first reading is there", () => {
    const { worker, run, pass, now } = started();
    pass(20);
    run.frame(now() + 20);
    run.watch("RightUpperArmZ");
    // This answer was asked for before: it is of the axis before.
    worker.answer();
    expect(run.traces[0]?.length).toBeGreaterThan(30);
    pass(2);
    expect(run.traces[0]?.length).toBeLessThan(8);
  });

  it("are marked where a command took effect, once for what is one deed", () => {
    const { worker, run, pass, now } = started();
    run.send({ kind: "latency", latencyS: 0 });
    run.send({ kind: "gravity", isOn: true });
    pass(10);
    run.frame(now() + 20);
    // Two ticks are under way; the worker obeys after them.
    run.send(PUSH);
    const before = run.ticks;
    const underWay = worker.answer();
    expect(underWay).toBeGreaterThan(0);
    for (const latencyS of [0.001, 0.012, 0.125]) run.send({ kind: "latency", latencyS });
    run.send(LATENCY);
    for (const x of [0, 20, 40]) run.send(pull(x));
    run.send({ kind: "push", push: null });
    run.send(pull(10));
    expect(run.marks.since(0).map(({ kind, value }) => [kind, value])).toEqual([
      ["push", 100],
      ["latency", 125],
      ["pull", null],
      ["pull", null],
    ]);
    expect(run.marks.since(0)[0]?.tick).toBe(before + underWay);
    pass(300);
    expect(run.marks.since(0)).toEqual([]);
  });

  it("have the figures of a step, which end where somebody pushes", () => {
    const { run, pass } = started();
    pass(20);
    pass(40, 30);
    run.send(PUSH);
    pass(60, 30);
    expect(run.traces[0]?.step?.stepDeg).toBeCloseTo(30, 9);
    expect(run.traces[0]?.step?.watchedS).toBeCloseTo(0.8, 1);
    run.send(LATENCY);
    pass(1, 30);
    expect(run.traces[0]?.step).toBeNull();
  });
});

describe("the time of a run", () => {
  it("stands still while the page is hidden, and goes on without a jump", () => {
    const { run, pass, skip } = started();
    pass(50);
    const before = run.timeS;
    run.rest();
    skip(60_000);
    pass(2);
    expect(run.timeS - before).toBeLessThanOrEqual(0.04 + 1e-9);
    pass(100);
    expect(run.pace).toBeCloseTo(1, 1);
  });

  it("says how slow it is when the worker cannot keep up", () => {
    const { worker, run, pass, skip, now } = started();
    pass(120);
    expect(run.pace).toBeGreaterThan(0.95);
    // Every answer takes 250 ms, and has at most 100 ms in it.
    for (let answer = 0; answer < 40; answer++) {
      skip(250);
      run.frame(now());
      worker.answer();
    }
    expect(run.pace).toBeCloseTo(0.4, 2);
    run.play(false);
    expect(run.pace).toBeNull();
  });
});
