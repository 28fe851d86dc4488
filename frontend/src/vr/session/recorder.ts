/**
 * Frames and reports on their way to the server: what was recorded in a frame, in the order in
 * which it happened.
 *
 * A frame's row holds two poses. `actual` is what the participant saw in that frame; `target` is
 * what the tracking asked for in the same frame. Where the bodies are computed in a worker, the
 * target of a frame is known only when the worker has answered, a frame later: so the row waits for
 * it, and so do the reports made after it, because the server wants the frames that led to a report
 * before the report. A frame that the worker left out (it takes the newest only) gets a target
 * between those of its neighbours.
 */
import type { BodiesFrame, PoseValues } from "../bodies/bodies";
import {
  ACTIVE,
  FINGER_VALUES_PER_FRAME,
  type ReportBody,
  type TelemetryClient,
  VALUES_PER_FRAME,
} from "../telemetry";

/** Frames in a batch: 15 batches of each stream a second at 90 Hz. */
const FRAMES_PER_BATCH = 6;
/** Rows that may wait for their targets; 1.4 s at 90 Hz. Beyond that the last target is kept. */
const ROWS = 128;

/** What is drawn of the remote body. */
export type Seen = Pick<BodiesFrame, "remote" | "remoteFingers">;

/** A report that waits for the rows before it. */
interface WaitingReport {
  readonly body: ReportBody;
  /** The number of rows, counted from the first of this run, that go before it. */
  readonly afterRow: number;
}

export type Sink = Pick<TelemetryClient, "sendFrames" | "report">;

export class Recorder {
  readonly #sink: Sink;
  readonly #withFingers: boolean;
  readonly #onFailure: (error: unknown) => void;
  readonly #timesS = new Float64Array(ROWS);
  readonly #activeS = new Float64Array(ROWS);
  readonly #flags = new Uint8Array(ROWS);
  readonly #phaseIds = new Int32Array(ROWS);
  readonly #targets: Rows;
  readonly #actuals: Rows;
  readonly #targetFingers: Rows;
  readonly #actualFingers: Rows;
  readonly #reports: WaitingReport[] = [];
  /** The local pose that was computed last, and the time of its input. */
  readonly #lastLocal = new Float64Array(VALUES_PER_FRAME);
  readonly #lastFingers = new Float64Array(FINGER_VALUES_PER_FRAME);
  #lastLocalS = Number.NEGATIVE_INFINITY;
  /** Rows recorded, rows whose target is known, and rows sent, since the run began. */
  #made = 0;
  #known = 0;
  #sent = 0;
  /** Rows before this one are sent as soon as they are known, however few they are. */
  #due = 0;

  constructor(
    sink: Sink,
    { withFingers, onFailure }: { withFingers: boolean; onFailure: (error: unknown) => void },
  ) {
    this.#sink = sink;
    this.#withFingers = withFingers;
    this.#onFailure = onFailure;
    const fingers = withFingers ? FINGER_VALUES_PER_FRAME : 0;
    this.#targets = new Rows(VALUES_PER_FRAME);
    this.#actuals = new Rows(VALUES_PER_FRAME);
    this.#targetFingers = new Rows(fingers);
    this.#actualFingers = new Rows(fingers);
  }

  /** The seq of the next frame, in every stream of this run. */
  get nextSeq(): number {
    return this.#made;
  }

  /**
   * Note the newest computed frame: its local pose is the target of the row of the same time, and
   * of rows between it and the one before.
   */
  computed(frame: BodiesFrame): void {
    if (frame.timeS <= this.#lastLocalS) return;
    while (this.#known < this.#made) {
      const timeS = this.#timesS[this.#known % ROWS] as number;
      if (timeS > frame.timeS) break;
      this.#setTarget(this.#known, timeS, frame);
      this.#known++;
    }
    this.#lastLocal.set(frame.local);
    if (frame.localFingers !== null) this.#lastFingers.set(frame.localFingers);
    this.#lastLocalS = frame.timeS;
  }

  /**
   * Record the frame at `timeS`, in which `seen` is what the participant sees. Its target is already
   * known if the bodies were computed for this very frame; else it waits for `computed`.
   */
  frame(timeS: number, seen: Seen, phaseId: number, clockRuns: boolean): void {
    if (this.#made - this.#sent === ROWS) this.#makeRoom();
    const row = this.#made % ROWS;
    this.#timesS[row] = timeS;
    this.#flags[row] = clockRuns ? ACTIVE : 0;
    this.#phaseIds[row] = phaseId;
    this.#activeS[row] = 0;
    this.#actuals.set(row, seen.remote);
    if (this.#withFingers) this.#actualFingers.set(row, seen.remoteFingers);
    this.#made++;
    if (this.#lastLocalS === timeS) this.#settleTargets();
  }

  /** Set the phase's active time at the frame recorded last. */
  setActive(activeS: number): void {
    if (this.#made > this.#sent) this.#activeS[(this.#made - 1) % ROWS] = activeS;
  }

  /** Send a report after all frames recorded so far. */
  report(body: ReportBody): void {
    this.#reports.push({ body, afterRow: this.#made });
  }

  /** Send what is ready: whole batches, and smaller ones before a report or another phase. */
  send(closedAtS: number): void {
    for (;;) {
      const report = this.#reports[0];
      if (report !== undefined && report.afterRow <= this.#sent) {
        this.#reports.shift();
        this.#settle(this.#sink.report(report.body));
        continue;
      }
      const boundary = Math.min(report?.afterRow ?? this.#made + 1, this.#endOfPhase());
      const whole = this.#sent + FRAMES_PER_BATCH;
      const end = Math.min(whole, boundary, this.#made);
      const isDue = end === whole || end === boundary || end <= this.#due;
      if (end === this.#sent || !isDue || end > this.#known) return;
      this.#sendRows(this.#sent, end, closedAtS);
    }
  }

  /** Send everything recorded so far as soon as its targets are known, in smaller batches. */
  flush(closedAtS: number): void {
    this.#due = this.#made;
    this.send(closedAtS);
  }

  /** Send everything now: no more will be computed. */
  end(closedAtS: number): void {
    this.#settleTargets();
    this.flush(closedAtS);
  }

  /** Give all rows that still wait the newest target. */
  #settleTargets(): void {
    while (this.#known < this.#made) {
      const row = this.#known % ROWS;
      this.#targets.set(row, this.#lastLocal);
      if (this.#withFingers) this.#targetFingers.set(row, this.#lastFingers);
      this.#known++;
    }
  }

  /** The first unsent row of another phase: a batch never spans two. Infinity without one. */
  #endOfPhase(): number {
    const last = Math.min(this.#made, this.#sent + FRAMES_PER_BATCH + 1);
    for (let row = this.#sent + 1; row < last; row++) {
      if (this.#phaseIds[row % ROWS] !== this.#phaseIds[(row - 1) % ROWS]) return row;
    }
    return Number.POSITIVE_INFINITY;
  }

  #makeRoom(): void {
    this.#settleTargets();
    this.flush(this.#timesS[(this.#made - 1) % ROWS] as number);
  }

  #setTarget(at: number, timeS: number, frame: BodiesFrame): void {
    const row = at % ROWS;
    const spanS = frame.timeS - this.#lastLocalS;
    const share = Number.isFinite(spanS) ? (timeS - this.#lastLocalS) / spanS : 1;
    if (share >= 1) this.#targets.set(row, frame.local);
    else this.#targets.between(row, this.#lastLocal, frame.local, Math.max(share, 0));
    if (this.#withFingers) this.#targetFingers.set(row, frame.localFingers);
  }

  #sendRows(begin: number, end: number, closedAtS: number): void {
    const count = end - begin;
    const timesS = new Float64Array(count);
    const flags = new Uint8Array(count);
    for (let index = 0; index < count; index++) {
      const row = (begin + index) % ROWS;
      timesS[index] = this.#timesS[row] as number;
      flags[index] = this.#flags[row] as number;
    }
    const last = (end - 1) % ROWS;
    const shared = {
      phaseId: this.#phaseIds[last] as number,
      timesS,
      flags,
      activeS: this.#activeS[last] as number,
      closedAtS,
    };
    const sendFrames = (...call: Parameters<Sink["sendFrames"]>): void =>
      this.#settle(this.#sink.sendFrames(...call));
    sendFrames("target", { ...shared, values: this.#targets.taken(begin, count) });
    sendFrames("actual", { ...shared, values: this.#actuals.taken(begin, count) });
    if (this.#withFingers) {
      sendFrames("target_fingers", { ...shared, values: this.#targetFingers.taken(begin, count) });
      sendFrames("actual_fingers", { ...shared, values: this.#actualFingers.taken(begin, count) });
    }
    this.#sent = end;
  }

  #settle(call: Promise<void>): void {
    call.catch(this.#onFailure);
  }
}

/** A ring of rows of one stream. */
class Rows {
  readonly #width: number;
  readonly #values: Float32Array;

  constructor(width: number) {
    this.#width = width;
    this.#values = new Float32Array(width * ROWS);
  }

  /** Set a row; null: nothing is known, which is NaN. */
  set(row: number, values: PoseValues | null): void {
    const at = row * this.#width;
    if (values === null) this.#values.fill(Number.NaN, at, at + this.#width);
    else this.#values.set(values, at);
  }

  /** Set a row to a pose between two: position and rotations each on the straight line, to unit. */
  between(row: number, from: PoseValues, to: PoseValues, share: number): void {
    const at = row * this.#width;
    for (let i = 0; i < 3; i++) {
      this.#values[at + i] = mixed(from[i] as number, to[i] as number, share);
    }
    for (let i = 3; i < this.#width; i += 4) {
      let dot = 0;
      for (let c = i; c < i + 4; c++) dot += (from[c] as number) * (to[c] as number);
      const sign = dot < 0 ? -1 : 1;
      let squared = 0;
      for (let c = i; c < i + 4; c++) {
        const value = mixed(from[c] as number, sign * (to[c] as number), share);
        squared += value * value;
        this.#values[at + c] = value;
      }
      const length = Math.sqrt(squared);
      for (let c = at + i; c < at + i + 4; c++) {
        this.#values[c] = (this.#values[c] as number) / length;
      }
    }
  }

  /** A copy of `count` rows from the one with this number on. */
  taken(first: number, count: number): Float32Array {
    const values = new Float32Array(count * this.#width);
    for (let index = 0; index < count; index++) {
      const at = ((first + index) % ROWS) * this.#width;
      values.set(this.#values.subarray(at, at + this.#width), index * this.#width);
    }
    return values;
  }
}

const mixed = (from: number, to: number, share: number): number => from + (to - from) * share;
