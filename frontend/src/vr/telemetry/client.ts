/** What a headset's page does with telemetry; the same in the page and through a worker. */
import type { Notice } from "./connection/connection";
import type { Failure } from "./failure";
import type { Durability } from "./journal/indexedDb";
import type { Limits } from "./limits";
import type { Frames, StreamName } from "./wire/batch";
import type { ReportBody } from "./wire/fromClient";
import type { HeadsetState, Welcome } from "./wire/fromServer";

/**
 * How the sending goes.
 *
 *     clear    what is made is stored within moments
 *     behind   something waits for longer than it should; it is safe in the journal
 *     full     the journal is at its limit: `sendFrames` and `report` wait
 */
export type Level = "clear" | "behind" | "full";

export interface Status {
  readonly connected: boolean;
  readonly level: Level;
  /** What is not known to be on the server's disk. */
  readonly journaledMessages: number;
  readonly journaledBytes: number;
  /** Age of the oldest of it, s. */
  readonly oldestUnackedS: number;
  /** Calls that wait for room in the journal. */
  readonly waitingCalls: number;
  /** Reports that this run has made. */
  readonly reportsMade: number;
  /** Whether all reports are stored, those of earlier runs too. */
  readonly settled: boolean;
  /** Why the browser's disk did not take the journal just now; sending goes on from memory. */
  readonly problem: string | null;
  /** Why it is over. */
  readonly failure: Failure | null;
}

export type Unsubscribe = () => void;

/**
 * One run (epoch) of a headset in one session.
 *
 *     const telemetry = await openTelemetry({ url, token, name: "headset 1", storageKey: sessionId });
 *     await telemetry.sendFrames("target", frames);   // journaled; waits while the journal is full
 *     await telemetry.report({ kind: "materialised", t_s });
 *     telemetry.state;                                // newest state of the session
 *     await telemetry.drained();                      // everything is on the server's disk
 *     await telemetry.close();
 *
 * Calls are taken in the order in which they are made, also without waiting for one another. All of
 * them reject with `TelemetryError` once the server has refused for good.
 */
export interface TelemetryClient {
  /** The number the server gave to this run. */
  readonly epoch: number;
  readonly welcome: Welcome;
  readonly state: HeadsetState;
  readonly status: Status;
  /**
   * Whether all reports are stored, those of earlier runs too: the state of a running phase may be
   * acted on only then, since one that was sent before may not know of them.
   */
  readonly settled: boolean;
  /** Journal and send frames under the next seqs of the stream; the arrays may be reused at once. */
  sendFrames(stream: StreamName, frames: Frames): Promise<void>;
  /** Journal and send a report. Send the frames that led to it before. */
  report(body: ReportBody): Promise<void>;
  /** Until everything sent is on the server's disk, what earlier runs left included. */
  drained(): Promise<void>;
  /** Write the journal to the browser's disk now. */
  flush(): Promise<void>;
  /** Hang up. What is not acknowledged stays in the journal for the next run. */
  close(): Promise<void>;
  onState(listener: (state: HeadsetState) => void): Unsubscribe;
  onStatus(listener: (status: Status) => void): Unsubscribe;
  onNotice(listener: (notice: Notice) => void): Unsubscribe;
}

export interface TelemetryOptions {
  /** `ws://HOST/api/vr/stream`, or `wss://`. */
  readonly url: string;
  /** From pairing. */
  readonly token: string;
  /** What the client calls itself: program and version, up to 120 characters. */
  readonly name: string;
  /** Names the journal on this device: use the id of the session. */
  readonly storageKey: string;
  readonly durability?: Durability;
  readonly limits?: Partial<Limits>;
}

/** Listeners of one kind of news. */
export class Listeners<News> {
  readonly #listeners = new Set<(news: News) => void>();

  add(listener: (news: News) => void): Unsubscribe {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  /** A listener that fails is reported as uncaught, and keeps nobody from hearing. */
  tell(news: News): void {
    for (const listener of this.#listeners) {
      try {
        listener(news);
      } catch (error) {
        queueMicrotask(() => {
          throw error;
        });
      }
    }
  }
}
