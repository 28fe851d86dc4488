/**
 * A timed phase on the headset's clock: preparation, active time, freeze, and its reports. The
 * server's `app/rehearsal/timed_run.py`; vectors in `tests/vectors/phases` hold both to the same
 * reports.
 *
 * The headset runs the phase by itself and reports each change with its own monotonic time and the
 * active time so far. The clock is stopped during pauses, during walks back, while the connection is
 * lost and while the device sleeps, so both sides agree on what counts.
 */
import type { PhaseOrder, ReportBody } from "../../telemetry";
import { ActiveClock } from "../clock";
import type { Touches } from "../contacts";
import type { CommandKind } from "../state";

export type Reports = readonly ReportBody[];
type What = Extract<ReportBody, { kind: "phase" }>["what"];

export const NOTHING: Reports = [];

/** What the clock waits for: that the participant stands at the start, or that cars drive. */
export type Awaited = "start" | "traffic";

/**
 * One phase from its preparation to the end of its freeze.
 *
 * A client that takes over in mid-phase continues with the active time in the order: it waits for the
 * operator to resume, since it cannot know where the participant stands.
 */
export abstract class TimedRun {
  #hasEnded = false;
  #beginsS: number;
  #frozenUntilS: number | null = null;
  #isPaused = false;
  #takesOver: boolean;
  /** Active time that earlier runs of the client have used. */
  protected spentS: number;

  /** @param timeS the time at which this phase was first heard of */
  constructor(
    public order: PhaseOrder,
    timeS: number,
  ) {
    this.spentS = order.active_s;
    this.#beginsS = timeS + order.preparation_s;
    this.#takesOver = order.status !== "preparing";
  }

  /** The active clock of this run, which starts at zero. */
  abstract get clock(): ActiveClock;
  /** Start, pause, resume or freeze the clock. */
  protected abstract command(kind: CommandKind, timeS: number): void;
  /** Process what the avatar touches in one frame. */
  protected abstract touch(timeS: number, touches: Touches): void;
  /** Reports of what has happened since the last call. */
  protected abstract news(): Reports;

  /** What the clock waits for before it starts or goes on; null: nothing. */
  get awaits(): Awaited | null {
    return null;
  }

  /** Whether the phase ends before its time is up: a practice with its tasks completed. */
  get endsEarly(): boolean {
    return false;
  }

  get hasEnded(): boolean {
    return this.#hasEnded;
  }

  get clockRuns(): boolean {
    return this.clock.runningSinceS !== null;
  }

  /** Whether the avatar stands still: the time is up, and the freeze shows it. */
  get isFrozen(): boolean {
    return this.#frozenUntilS !== null;
  }

  /** Seconds of the freeze that remain at `timeS`; null while nothing is frozen. */
  freezeLeftS(timeS: number): number | null {
    return this.#frozenUntilS === null ? null : Math.max(0, this.#frozenUntilS - timeS);
  }

  /** Whether the clock waits for the operator to resume. */
  get isPaused(): boolean {
    return this.#isPaused;
  }

  /** Seconds of the preparation that remain at `timeS`; null once the clock has started. */
  preparationLeftS(timeS: number): number | null {
    if (this.clock.lastS !== null || this.#takesOver || this.isFrozen) return null;
    return Math.max(0, this.#beginsS - timeS);
  }

  /** The active time at `timeS`, at most the phase's duration. */
  activeS(timeS: number): number {
    const { lastS } = this.clock;
    if (lastS === null) return this.spentS;
    const activeS = this.spentS + this.clock.activeS(Math.max(timeS, lastS));
    return Math.min(activeS, this.order.duration_s);
  }

  /**
   * Pause or resume as the operator has ordered, and return the reports.
   *
   * `order` must reflect every report of this run: in response to an older one, the run would pause
   * again and again.
   */
  follow(order: PhaseOrder, timeS: number): Reports {
    this.order = order;
    if (order.pausing && this.clockRuns) return this.#pause(timeS, "operator");
    let reports = NOTHING;
    if (order.status === "paused" && this.clockRuns) {
      // The server lost the connection for a moment too short to be noticed here.
      reports = this.#pause(timeS, "disconnected");
    }
    if (this.#isPaused && this.clock.activeBeforeS === 0) {
      // Taken over, and the earlier run had used more active time than was known then.
      this.spentS = Math.max(this.spentS, order.active_s);
    }
    if (this.#isPaused && order.status === "running") {
      return [this.report("paused", timeS, "restarted")];
    }
    if (order.resuming && this.#isPaused && this.awaits === null) {
      this.#isPaused = false;
      this.command("resume", timeS);
      return [...reports, ...this.news(), this.report("resumed", timeS)];
    }
    return reports;
  }

  /** Advance by one frame and return its reports; `touches` are those of the frame shown. */
  frame(timeS: number, touches: Touches | null, isConnected: boolean): Reports {
    if (this.#takesOver) {
      this.#takesOver = false;
      return this.#takeOver(timeS);
    }
    if (this.#frozenUntilS !== null) return this.#thaw(timeS);
    if (!isConnected) {
      this.#beginsS = Math.max(this.#beginsS, timeS);
      return this.clockRuns ? this.#pause(timeS, "disconnected") : NOTHING;
    }
    if (this.clock.lastS === null && this.awaits !== null) {
      // Whoever has just come to the start gets the whole preparation.
      const leftS = this.awaits === "start" ? this.order.preparation_s : 0;
      this.#beginsS = Math.max(this.#beginsS, timeS + leftS);
      return NOTHING;
    }
    let reports = NOTHING;
    if (this.clock.lastS === null && timeS >= this.#beginsS) {
      this.command("start", timeS);
      reports = [this.report("started", timeS)];
    }
    const endS = this.clock.reachesS(this.order.duration_s - this.spentS);
    if (endS !== null && timeS >= endS) {
      // The phase ends when its time is up, not when the next frame is drawn.
      return [...reports, ...this.#freeze(Math.max(endS, this.clock.lastS ?? endS))];
    }
    if (this.clock.lastS !== null && touches !== null) this.touch(timeS, touches);
    reports = joined(reports, this.news());
    return this.endsEarly ? [...reports, ...this.#freeze(timeS)] : reports;
  }

  /**
   * Stop the clock at `timeS` for a reason of the headset's own, such as a moved origin; the operator
   * resumes. `cause` is part of the report.
   */
  stop(timeS: number, cause: string): Reports {
    return this.clockRuns ? this.#pause(timeS, cause) : NOTHING;
  }

  /**
   * The device was asleep from its last frame until `nowS`: none of it was active time, nor
   * preparation.
   */
  wake(lastFrameS: number, nowS: number): Reports {
    if (this.clock.lastS === null) this.#beginsS += nowS - lastFrameS;
    return this.stop(lastFrameS, "asleep");
  }

  protected report(what: What, timeS: number, cause = "headset"): ReportBody {
    const activeS = this.activeS(timeS);
    const { phase_id } = this.order;
    return { kind: "phase", phase_id, what, t_s: timeS, active_s: activeS, cause };
  }

  /**
   * Continue where another run of the client was lost, frozen or paused. If the server has not
   * noticed the loss yet, `follow` reports the pause.
   */
  #takeOver(timeS: number): Reports {
    if (this.order.status === "freezing") {
      this.#frozenUntilS = timeS + this.order.freeze_s;
      return NOTHING;
    }
    this.command("start", timeS);
    this.command("pause", timeS);
    this.#isPaused = true;
    const reports = this.news();
    if (this.order.status !== "walk_back") return reports;
    return [...reports, this.report("walk_back_ended", timeS)];
  }

  #pause(timeS: number, cause: string): Reports {
    this.#isPaused = true;
    this.command("pause", timeS);
    return [...this.news(), this.report("paused", timeS, cause)];
  }

  #freeze(timeS: number): Reports {
    this.command("freeze", timeS);
    this.#frozenUntilS = timeS + this.order.freeze_s;
    return [...this.news(), this.report("time_up", timeS)];
  }

  #thaw(timeS: number): Reports {
    if (this.#hasEnded || this.#frozenUntilS === null || timeS < this.#frozenUntilS) return NOTHING;
    this.#hasEnded = true;
    return [this.report("ended", timeS)];
  }
}

/** Both lists; neither is copied if the other is empty, since most frames have no reports. */
const joined = (first: Reports, second: Reports): Reports => {
  if (first.length === 0) return second;
  return second.length === 0 ? first : [...first, ...second];
};

/** A phase of free movement: a clock, and nothing to touch. */
export class FreeRun extends TimedRun {
  #clock = ActiveClock.unstarted;

  get clock(): ActiveClock {
    return this.#clock;
  }

  protected command(kind: CommandKind, timeS: number): void {
    if (kind === "start") this.#clock = this.#clock.begin(timeS);
    else if (kind === "resume") this.#clock = this.#clock.resume(timeS);
    else this.#clock = this.#clock.pause(timeS);
  }

  protected touch(): void {}

  protected news(): Reports {
    return NOTHING;
  }
}
