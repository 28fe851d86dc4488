/**
 * What runs in a page: asks the worker for as much time as has passed, and keeps what came back.
 *
 * One request is under way at a time. A page that was hidden, or a machine that is too slow, goes on
 * from where it was instead of catching up; how slow it is, is told (`pace`).
 */
import { Marks } from "./marks";
import { Pace } from "./pace";
import type { Command } from "./physics/commands";
import type { Shape } from "./physics/shapes";
import { type BodyToTry, TICK_S } from "./physics/triedBody";
import { type Progress, READING } from "./physics/tryout";
import { Trace, WINDOW_TICKS } from "./traces";
import type { Advance, FromWorker, TryoutPort } from "./worker/messages";

/** At most this much is simulated for one picture. */
const LONGEST_S = 0.1;

export type Phase = "opening" | "ready" | "failed";

/** What changes seldom enough to be state of the page. */
export interface RunState {
  readonly phase: Phase;
  readonly isPlaying: boolean;
  readonly shapes: readonly (readonly Shape[])[];
  readonly longestLatencyS: number;
  /** What went wrong; of `failed` why, else a command that could not be obeyed. */
  readonly problem: string | null;
}

const OPENING: RunState = {
  phase: "opening",
  isPlaying: true,
  shapes: [],
  longestLatencyS: 0,
  problem: null,
};

export class TryoutRun {
  state: RunState = OPENING;
  /** One for each body. */
  traces: readonly Trace[] = [];
  /** The newest of each body. */
  progress: readonly Progress[] = [];
  timeS = 0;
  /** Simulated time and what computing it took, since it was opened. */
  simulatedS = 0;
  computedS = 0;
  /** What was done, at which tick of the curves. */
  readonly marks = new Marks();
  /** Ticks that the curves have been given since the axis is watched. */
  ticks = 0;
  /** Called after every answer with new places. */
  onAdvance: () => void = () => {};
  private readonly listeners = new Set<() => void>();
  private readonly pacing = new Pace();
  /** Ticks that were asked for and have not come yet. */
  private underWay = 0;
  private bodies: readonly BodyToTry[] = [];
  /** Rows of bodies that were sent and have not begun yet. */
  private readonly joining = new Set<number>();
  /** The axis whose curves are kept. */
  private drawn: string | null = null;
  /** The part that is chosen for a push. */
  private part: string | null = null;
  private isWaiting = false;
  private due = 0;
  private lastMs: number | null = null;

  constructor(
    private readonly port: TryoutPort,
    private axis: string,
  ) {
    port.onmessage = ({ data }) => this.receive(data);
  }

  open(wasm: ArrayBuffer, bodies: readonly BodyToTry[]): void {
    this.bodies = bodies;
    this.port.postMessage({ kind: "open", wasm, bodies }, [wasm]);
  }

  /** Try other bodies; those that were there go on, and what was chosen holds for all. */
  change(bodies: readonly BodyToTry[]): void {
    this.set({ phase: "opening", problem: null });
    this.rest();
    bodies.forEach((body, row) => {
      if (body !== this.bodies[row]) this.joining.add(row);
    });
    this.bodies = bodies;
    this.port.postMessage({ kind: "change", bodies });
  }

  send(command: Command): void {
    if (this.state.problem !== null && this.state.phase !== "failed") this.set({ problem: null });
    this.port.postMessage({ kind: "command", command });
    this.marks.note(command, this.nextTick);
    // Even while it stands still, the new pose is shown.
    if (command.kind === "reset") this.due = Math.max(this.due, TICK_S);
  }

  /** Watch another axis from now on. */
  watch(axis: string): void {
    this.axis = axis;
  }

  /** Ask from now on what a push at a part would meet. */
  aim(part: string): void {
    this.part = part;
  }

  play(isPlaying: boolean): void {
    this.rest();
    this.set({ isPlaying });
  }

  /** Stand still and simulate one tick of 10 ms. */
  step(): void {
    this.rest();
    this.set({ isPlaying: false });
    this.due = TICK_S;
  }

  /** Time that passes until the next picture does not count: the page was hidden, or stood still. */
  rest(): void {
    this.lastMs = null;
    this.pacing.begin();
  }

  /** Called for every picture with the page's time. */
  frame(nowMs: number): void {
    const passedS = this.lastMs === null ? 0 : (nowMs - this.lastMs) / 1000;
    this.lastMs = nowMs;
    if (this.state.isPlaying) {
      this.due = Math.min(this.due + passedS, LONGEST_S);
      this.pacing.passed(passedS);
    }
    const ticks = Math.floor(this.due / TICK_S + 1e-6);
    if (this.isWaiting || ticks < 1 || this.state.phase !== "ready") return;
    this.due = Math.max(this.due - ticks * TICK_S, 0);
    this.isWaiting = true;
    this.underWay = ticks;
    this.port.postMessage({
      kind: "advance",
      ticks,
      axis: this.axis,
      ...(this.part === null ? {} : { part: this.part }),
    });
  }

  subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  /** How many times faster than the simulated time it is computed; null before it began. */
  get realTimeFactor(): number | null {
    return this.computedS > 0 ? this.simulatedS / this.computedS : null;
  }

  /** Simulated time by the time that passed: 1 on a machine that keeps up; null before it is known. */
  get pace(): number | null {
    return this.pacing.value;
  }

  dispose(): void {
    this.port.terminate();
    this.onAdvance = () => {};
    this.listeners.clear();
  }

  private receive(message: FromWorker): void {
    if (message.kind === "opened") {
      const { shapes, longestLatencyS } = message;
      const { joining } = this;
      if (joining.has(0)) this.marks.add({ kind: "change", tick: this.nextTick, value: null });
      // The curves go on, but not as those of another avatar.
      this.traces = shapes.map((_, row) => {
        const before = row > 0 && joining.has(row) ? undefined : this.traces[row];
        return before ?? new Trace();
      });
      joining.clear();
      this.progress = [];
      this.isWaiting = false;
      this.underWay = 0;
      this.due = TICK_S;
      this.simulatedS = 0;
      this.computedS = 0;
      this.set({ phase: "ready", shapes, longestLatencyS });
    } else if (message.kind === "advanced") this.take(message.advance);
    else if (message.kind === "refused") this.set({ problem: message.problem });
    else {
      this.isWaiting = false;
      this.set({ phase: "failed", problem: message.problem });
    }
  }

  /** The tick before which a command that is given now takes effect. */
  private get nextTick(): number {
    return this.ticks + this.underWay;
  }

  private take({ ticks, timeS, tookMs, axis, bodies }: Advance): void {
    this.isWaiting = false;
    this.underWay = 0;
    // An answer about the bodies before a change is late.
    if (bodies.length !== this.traces.length) return;
    this.timeS = timeS;
    this.simulatedS += ticks * TICK_S;
    this.computedS += tookMs / 1000;
    this.pacing.simulated(ticks * TICK_S);
    this.progress = bodies;
    if (axis !== this.drawn) this.clear(axis);
    const marks = this.marks.since(this.ticks).filter(({ tick }) => tick < this.ticks + ticks);
    bodies.forEach(({ readings, limitNm }, row) => {
      const trace = this.traces[row];
      let from = 0;
      for (const { kind, tick } of marks) {
        const to = READING * (tick - this.ticks);
        trace?.add(readings.subarray(from, to), limitNm);
        // Only the body that is edited changes while its curves go on.
        if (kind !== "change" || row === 0) trace?.disturb(kind);
        from = to;
      }
      trace?.add(readings.subarray(from), limitNm);
    });
    this.ticks += ticks;
    this.marks.forgetBefore(this.ticks - WINDOW_TICKS);
    this.onAdvance();
  }

  /** Begin the curves of another axis. */
  private clear(axis: string): void {
    this.drawn = axis;
    this.ticks = 0;
    this.marks.forget();
    for (const trace of this.traces) trace.clear();
  }

  private set(change: Partial<RunState>): void {
    this.state = { ...this.state, ...change };
    for (const listener of this.listeners) listener();
  }
}
