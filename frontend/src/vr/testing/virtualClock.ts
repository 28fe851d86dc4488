/**
 * A clock that a test steps: the page's frames come when the test says so, however slow the machine.
 *
 * It replaces `requestAnimationFrame`, `cancelAnimationFrame` and `performance.now` of the global
 * object, so it must be installed before anything that keeps one of them is imported (three, iwer,
 * the page itself). Timers, sockets and workers stay on real time.
 */

const FRAME_RATE_HZ = 90;

type FrameCallback = (timeMs: number) => void;

/** What the clock replaces; `globalThis` has all three. */
export interface Clocked {
  requestAnimationFrame(callback: FrameCallback): number;
  cancelAnimationFrame(handle: number): void;
  readonly performance: { now(): number };
}

export class VirtualClock {
  private timeMs: number;
  private waiting = new Map<number, FrameCallback>();
  private handles = 0;

  constructor(
    startMs: number,
    readonly frameMs: number,
    /** The real `performance.now`, to time the test itself. */
    readonly realNowMs: () => number,
    private readonly restore: () => void,
  ) {
    this.timeMs = startMs;
  }

  get nowMs(): number {
    return this.timeMs;
  }

  /** Callbacks that wait for the next frame. */
  get waitingCallbacks(): number {
    return this.waiting.size;
  }

  request(callback: FrameCallback): number {
    this.handles++;
    this.waiting.set(this.handles, callback);
    return this.handles;
  }

  cancel(handle: number): void {
    this.waiting.delete(handle);
  }

  /** Advance by one frame and run what waited for it; all errors are thrown after the last. */
  step(ms: number = this.frameMs): void {
    this.timeMs += ms;
    const due = this.waiting;
    this.waiting = new Map();
    const errors: unknown[] = [];
    for (const callback of due.values()) {
      try {
        callback(this.timeMs);
      } catch (error) {
        errors.push(error);
      }
    }
    if (errors.length === 1) throw errors[0];
    if (errors.length > 1) throw new AggregateError(errors, "Callbacks of one frame failed.");
  }

  /** Let time pass without frames: the device is asleep, or the page is hidden. */
  sleep(seconds: number): void {
    this.timeMs += seconds * 1000;
  }

  uninstall(): void {
    this.restore();
  }
}

/** Replace the clock of the global object; the first frame comes with the first `step`. */
export function installVirtualClock(
  { frameRateHz = FRAME_RATE_HZ }: { frameRateHz?: number } = {},
  of: Clocked = globalThis as unknown as Clocked,
): VirtualClock {
  const { requestAnimationFrame, cancelAnimationFrame, performance } = of;
  // The method may be the object's own or its prototype's.
  const ownNow = Object.getOwnPropertyDescriptor(performance, "now");
  const realNowMs = performance.now.bind(performance);
  const clock = new VirtualClock(realNowMs(), 1000 / frameRateHz, realNowMs, () => {
    of.requestAnimationFrame = requestAnimationFrame;
    of.cancelAnimationFrame = cancelAnimationFrame;
    if (ownNow === undefined) Reflect.deleteProperty(performance, "now");
    else Object.defineProperty(performance, "now", ownNow);
  });
  of.requestAnimationFrame = (callback) => clock.request(callback);
  of.cancelAnimationFrame = (handle) => clock.cancel(handle);
  Object.defineProperty(performance, "now", {
    configurable: true,
    writable: true,
    value: () => clock.nowMs,
  });
  return clock;
}
