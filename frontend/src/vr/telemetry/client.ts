/** The telemetry interface of a headset's page; the same in the page's thread and in a worker. */
import type { Abilities, Notice } from "./connection/connection";
import type { Failure } from "./failure";
import type { Durability } from "./journal/indexedDb";
import type { Limits } from "./limits";
import type { Frames, StreamName } from "./wire/batch";
import type { ReportBody } from "./wire/fromClient";
import type { HeadsetState, Welcome } from "./wire/fromServer";

/**
 * How well the sending keeps up.
 *
 *     clear    what is produced is stored within moments
 *     behind   something has waited for longer than it should; it is safe in the journal
 *     full     the journal is at its limit: `sendFrames` and `report` wait
 */
export type Level = "clear" | "behind" | "full";

export interface Status {
  readonly connected: boolean;
  readonly level: Level;
  /** Messages that are not known to be on the server's disk. */
  readonly journaledMessages: number;
  readonly journaledBytes: number;
  /** Age of the oldest of them, s. */
  readonly oldestUnackedS: number;
  /** Calls that wait for room in the journal. */
  readonly waitingCalls: number;
  /** Reports that this run has produced. */
  readonly reportsMade: number;
  /** Whether all reports are stored, including those of earlier runs. */
  readonly settled: boolean;
  /**
   * Why the last write of the journal to the browser's disk failed; sending continues from memory.
   */
  readonly problem: string | null;
  /** Why the client has failed for good. */
  readonly failure: Failure | null;
}

export type Unsubscribe = () => void;

/**
 * One run (epoch) of a headset in one session.
 *
 *     const telemetry = await openTelemetry({ url, token, name: "headset 1", storageKey: sessionId
 *     });
 *     await telemetry.sendFrames("target", frames);   // journaled; waits while the journal is full
 *     await telemetry.report({ kind: "materialised", t_s });
 *     telemetry.state;                                // newest state of the session
 *     await telemetry.drained();                      // everything is on the server's disk
 *     await telemetry.close();
 *
 * Calls take effect in the order in which they are made, even if they are not awaited. All of them
 * reject with `TelemetryError` once the server has rejected the client for good.
 */
export interface TelemetryClient {
  /** The number that the server gave to this run. */
  readonly epoch: number;
  readonly welcome: Welcome;
  readonly state: HeadsetState;
  readonly status: Status;
  /**
   * Whether all reports are stored, including those of earlier runs. Only then may the state of a
   * running phase be acted on, since a state sent earlier may not include them.
   */
  readonly settled: boolean;
  /**
   * Journal and send frames under the next seqs of the stream; the arrays may be reused
   * immediately.
   */
  sendFrames(stream: StreamName, frames: Frames): Promise<void>;
  /** Journal and send a report. Send the frames that led to it first. */
  report(body: ReportBody): Promise<void>;
  /** Resolves once everything sent is on the server's disk, including the rest of earlier runs. */
  drained(): Promise<void>;
  /** Write the journal to the browser's disk now. */
  flush(): Promise<void>;
  /** Disconnect. What is not acknowledged stays in the journal for the next run. */
  close(): Promise<void>;
  onState(listener: (state: HeadsetState) => void): Unsubscribe;
  onStatus(listener: (status: Status) => void): Unsubscribe;
  onNotice(listener: (notice: Notice) => void): Unsubscribe;
}

export interface TelemetryOptions {
  /** `ws://HOST/api/vr/stream`, or `wss://`. */
  readonly url: string;
  /** The token received from pairing. */
  readonly token: string;
  /** The client's name: program and version, up to 120 characters. */
  readonly name: string;
  /** Whether this client sends the streams of fingers with every frame; it does not by default. */
  readonly fingers?: boolean;
  /** What else the client can do; the server sends it only what it can carry out. */
  readonly abilities?: Abilities;
  /** The name of the journal on this device: use the id of the session. */
  readonly storageKey: string;
  readonly durability?: Durability;
  readonly limits?: Partial<Limits>;
}

/** The listeners of one kind of event. */
export class Listeners<News> {
  readonly #listeners = new Set<(news: News) => void>();

  add(listener: (news: News) => void): Unsubscribe {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  /** Call all listeners; an error in one is reported as uncaught and does not stop the others. */
  notify(news: News): void {
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

/** The newest welcome and state of a connection, and the listeners for what happens on it. */
export abstract class ClientEvents {
  protected readonly states = new Listeners<HeadsetState>();
  protected readonly statuses = new Listeners<Status>();
  protected readonly notices = new Listeners<Notice>();
  protected newestWelcome: Welcome | null = null;
  protected newestState: HeadsetState | null = null;

  get epoch(): number {
    return this.welcome.epoch;
  }

  get welcome(): Welcome {
    if (this.newestWelcome === null) throw new Error("the client is not connected yet");
    return this.newestWelcome;
  }

  get state(): HeadsetState {
    return this.newestState ?? this.welcome.state;
  }

  onState(listener: (state: HeadsetState) => void): Unsubscribe {
    return this.states.add(listener);
  }

  onStatus(listener: (status: Status) => void): Unsubscribe {
    return this.statuses.add(listener);
  }

  onNotice(listener: (notice: Notice) => void): Unsubscribe {
    return this.notices.add(listener);
  }
}
