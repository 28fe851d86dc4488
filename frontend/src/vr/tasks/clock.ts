/**
 * The active clock of a phase, which is stopped while the phase is paused: the server's
 * `app/science/tasks/clock.py`.
 *
 * All times are seconds of the headset's monotonic clock, so wall time and active time differ only
 * by the pauses.
 */

/** A call to the clock that is not valid in its state, such as a time that goes back. */
export class ClockError extends Error {
  override name = "ClockError";
}

/** An immutable clock that counts active time; every change returns a new one. */
export class ActiveClock {
  private constructor(
    /** Active time up to the last start of the clock. */
    readonly activeBeforeS: number,
    /** When it was last started or resumed; null while it is stopped. */
    readonly runningSinceS: number | null,
    /** The time of its latest change; null before its start. */
    readonly lastS: number | null,
  ) {}

  static readonly unstarted = new ActiveClock(0, null, null);

  /** Start from zero active time. */
  begin(timeS: number): ActiveClock {
    if (this.lastS !== null) {
      throw new ClockError(`The clock was started before. Resume it instead (at ${timeS} s).`);
    }
    this.check(timeS);
    return new ActiveClock(0, timeS, timeS);
  }

  pause(timeS: number): ActiveClock {
    if (this.runningSinceS === null) {
      throw new ClockError(`The clock is stopped. Resume it before pausing (at ${timeS} s).`);
    }
    return new ActiveClock(this.activeS(timeS), null, timeS);
  }

  /** Run again from this time on. */
  resume(timeS: number): ActiveClock {
    if (this.lastS === null) {
      throw new ClockError(`The clock has not started. Begin it before resuming (at ${timeS} s).`);
    }
    if (this.runningSinceS !== null) {
      throw new ClockError(`The clock is running. Pause it before resuming (at ${timeS} s).`);
    }
    this.check(timeS);
    return new ActiveClock(this.activeBeforeS, timeS, timeS);
  }

  /** The active time at `timeS`, which must not be earlier than the latest change. */
  activeS(timeS: number): number {
    this.check(timeS);
    if (this.runningSinceS === null) return this.activeBeforeS;
    return this.activeBeforeS + (timeS - this.runningSinceS);
  }

  /** When the active time will reach `activeS` if it is not paused; null while stopped. */
  reachesS(activeS: number): number | null {
    if (this.runningSinceS === null) return null;
    return this.runningSinceS + (activeS - this.activeBeforeS);
  }

  private check(timeS: number): void {
    if (!Number.isFinite(timeS)) {
      throw new ClockError(`The time is ${timeS}. Give finite seconds of the monotonic clock.`);
    }
    if (this.lastS !== null && timeS < this.lastS) {
      throw new ClockError(
        `Time went back from ${this.lastS} s to ${timeS} s. Give times of one monotonic clock, in order.`,
      );
    }
  }
}
