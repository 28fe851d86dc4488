/**
 * Announce how much the client has produced, so that the server knows what it is missing.
 *
 * Runs from before a reload of the page are announced if the server may be missing parts of them.
 */
import { keyOf, type Run } from "../journal/entries";
import type { Journal } from "../journal/journal";
import type { Limits } from "../limits";
import { type Counts, textOf } from "../wire/fromClient";

export class Announcer {
  readonly #send: (text: string) => void;
  readonly #journal: Journal;
  readonly #ticking: ReturnType<typeof setInterval>;
  readonly #announced = new Map<string, number>();

  constructor(send: (text: string) => void, journal: Journal, limits: Limits) {
    this.#send = send;
    this.#journal = journal;
    this.announce();
    this.#ticking = setInterval(() => this.announce(), limits.producedEveryS * 1000);
  }

  /** Announce what has changed since the last time; the first time, everything. */
  announce(): void {
    for (const run of this.#journal.runs) {
      const streams = this.#changes(run);
      if (Object.keys(streams).length === 0) continue;
      this.#send(textOf({ type: "produced", epoch: run.epoch, streams }));
    }
  }

  stop(): void {
    clearInterval(this.#ticking);
  }

  #changes({ epoch, produced }: Run): Counts {
    const streams: Counts = {};
    for (const stream of STREAMS) {
      const count = produced[stream] ?? 0;
      const key = keyOf({ stream, epoch });
      if (count === (this.#announced.get(key) ?? 0)) continue;
      streams[stream] = count;
      this.#announced.set(key, count);
    }
    return streams;
  }
}

const STREAMS = ["target", "actual", "target_fingers", "actual_fingers", "reports"] as const;
