/** The telemetry client, in the thread that opens it. */
import { Admission } from "./admission";
import {
  ClientEvents,
  type Level,
  type Status,
  type TelemetryClient,
  type TelemetryOptions,
} from "./client";
import type { MakeSocket } from "./connection/channel";
import { Connection } from "./connection/connection";
import { CLOSED, type Failure, TelemetryError } from "./failure";
import type { Entry } from "./journal/entries";
import type { Journal } from "./journal/journal";
import type { Limits } from "./limits";
import { PROTOCOL_VERSION, REPORT_STREAM } from "./wire/basis";
import { encodeBatch, type Frames, MalformedBatch, type StreamName } from "./wire/batch";
import { type ReportBody, textOf } from "./wire/fromClient";
import type { Welcome } from "./wire/fromServer";

/** The environment that the client depends on; tests replace it. */
interface Environment {
  readonly journal: Journal;
  readonly limits: Limits;
  /** The client's monotonic clock, s. */
  readonly clock: () => number;
  /** Ms since 1970, without steps, from which the age of a message is computed. */
  readonly wallClockMs: () => number;
  readonly makeSocket: MakeSocket;
  readonly onStatus: (status: Status) => void;
  /** Called after everything else has ended, with the reason if there is one. */
  readonly onClosed: (failure: Failure | null) => Promise<void>;
}

export class DirectClient extends ClientEvents implements TelemetryClient {
  readonly #ground: Environment;
  readonly #journal: Journal;
  readonly #connection: Connection;
  readonly #admission: Admission;
  readonly #ticking: ReturnType<typeof setInterval>;
  readonly #running: Promise<void>;
  readonly #waiters = new Waiters();
  #produced: Record<string, number> = {};
  #closing: Promise<void> | null = null;
  #reported = "";
  #toldAll = "";

  constructor(options: TelemetryOptions, ground: Environment) {
    super();
    this.#ground = ground;
    this.#journal = ground.journal;
    this.#admission = new Admission(ground.journal);
    this.#connection = new Connection({
      ...ground,
      address: options,
      name: options.name,
      fingers: options.fingers ?? false,
      abilities: options.abilities ?? {},
      hooks: {
        onWelcome: (welcome) => this.#welcomed(welcome),
        onState: (state) => {
          this.newestState = state;
          this.states.notify(state);
        },
        onNotice: (notice) => this.notices.notify(notice),
        onChange: () => this.#changed(),
      },
    });
    this.statuses.add(ground.onStatus);
    this.#journal.onChange = () => this.#changed();
    this.#ticking = setInterval(() => this.#tick(), ground.limits.flushEveryS * 1000);
    this.#running = this.#connection.run();
  }

  /** Resolves at the first welcome; rejects if the server rejects the client. */
  async opened(): Promise<this> {
    await this.#until(() => this.#connection.epoch !== null);
    return this;
  }

  get settled(): boolean {
    const made = this.#produced[REPORT_STREAM] ?? 0;
    const epoch = this.#connection.epoch ?? 0;
    return (
      this.#journal.isSettled(REPORT_STREAM) && this.#journal.nextSeq(REPORT_STREAM, epoch) >= made
    );
  }

  get status(): Status {
    const { oldestMs } = this.#journal;
    const oldestS = oldestMs === null ? 0 : (this.#ground.wallClockMs() - oldestMs) / 1000;
    return {
      connected: this.#connection.isConnected,
      level: this.#level(oldestS),
      journaledMessages: this.#journal.messages,
      journaledBytes: this.#journal.bytes,
      oldestUnackedS: Math.max(0, oldestS),
      waitingCalls: this.#admission.waiting,
      reportsMade: this.#produced[REPORT_STREAM] ?? 0,
      settled: this.settled,
      problem: this.#journal.problem,
      failure: this.#connection.failure,
    };
  }

  async sendFrames(stream: StreamName, frames: Frames): Promise<void> {
    this.#requireOpen();
    const { framesPerBatch } = this.#ground.limits;
    const count = frames.timesS.length;
    if (count > framesPerBatch) {
      throw new MalformedBatch(`${count} frames at once; a batch takes at most ${framesPerBatch}`);
    }
    const seqFirst = this.#produced[stream] ?? 0;
    const message = encodeBatch({ ...frames, stream, epoch: this.epoch, seqFirst });
    await this.#produce(stream, seqFirst + count, message);
  }

  async report(body: ReportBody): Promise<void> {
    this.#requireOpen();
    const seq = this.#produced[REPORT_STREAM] ?? 0;
    const message = textOf({ type: "report", epoch: this.epoch, seq, body });
    await this.#produce(REPORT_STREAM, seq + 1, message);
  }

  async drained(): Promise<void> {
    await this.#until(() => this.#journal.messages === 0 && this.#admission.waiting === 0);
  }

  async flush(): Promise<void> {
    await this.#journal.flush();
  }

  async close(): Promise<void> {
    this.#closing ??= this.#close();
    await this.#closing;
  }

  async #close(): Promise<void> {
    clearInterval(this.#ticking);
    this.#connection.close();
    this.#changed();
    await this.#running;
    await this.#journal.flush();
    this.#journal.close();
    await this.#ground.onClosed(this.#connection.failure);
  }

  get #failure(): Failure | null {
    return this.#connection.failure ?? (this.#closing !== null ? CLOSED : null);
  }

  async #welcomed(welcome: Welcome): Promise<Failure | null> {
    if (welcome.protocol !== PROTOCOL_VERSION) return otherProtocol(welcome.protocol);
    if (!(await this.#journal.claim(welcome.session_id))) {
      return foreignJournal(this.#journal.sessionId ?? "", welcome.session_id);
    }
    this.newestWelcome = welcome;
    return null;
  }

  async #produce(stream: string, seqEnd: number, message: Entry["message"]): Promise<void> {
    this.#produced = { ...this.#produced, [stream]: seqEnd };
    this.#journal.note({ epoch: this.epoch, produced: this.#produced });
    const madeAtMs = this.#ground.wallClockMs();
    const entered = this.#admission.enter({ stream, epoch: this.epoch, seqEnd, message, madeAtMs });
    this.#changed();
    await entered;
  }

  #level(oldestS: number): Level {
    if (this.#journal.isFull) return "full";
    return oldestS > this.#ground.limits.behindAfterS ? "behind" : "clear";
  }

  #requireOpen(): void {
    if (this.#failure !== null) throw new TelemetryError(this.#failure);
  }

  async #until(isDone: () => boolean): Promise<void> {
    this.#requireOpen();
    await this.#waiters.until(isDone);
  }

  #tick(): void {
    void this.#journal.tidy();
    const status = this.status;
    if (this.#toldAll !== JSON.stringify(status)) this.#tellStatus(status);
  }

  #changed(): void {
    const failure = this.#failure;
    this.#admission.admit();
    if (failure !== null) this.#admission.refuseAll(failure);
    this.#waiters.check(failure);
    const status = this.status;
    if (this.#reported !== urgentPart(status)) this.#tellStatus(status);
  }

  #tellStatus(status: Status): void {
    this.#reported = urgentPart(status);
    this.#toldAll = JSON.stringify(status);
    this.statuses.notify(status);
  }
}

/**
 * The parts of a status that are reported immediately; the rest changes all the time and waits for
 * the next tick.
 */
const urgentPart = ({ connected, level, settled, reportsMade, failure }: Status): string =>
  `${connected} ${level} ${settled} ${reportsMade} ${failure?.code}`;

const otherProtocol = (version: number): Failure => ({
  code: "other_protocol",
  message: `the server speaks version ${version} of the protocol, this page ${PROTOCOL_VERSION}`,
  remedy: "Reload this page.",
});

const foreignJournal = (held: string, requested: string): Failure => ({
  code: "foreign_journal",
  message: `the journal holds what session ${held} has not delivered, and cannot take session ${requested}`,
  remedy: "Pair this headset with that session again, or use another storageKey for this one.",
});

interface Waiter {
  readonly isDone: () => boolean;
  readonly resolve: () => void;
  readonly reject: (error: TelemetryError) => void;
}

/** Calls that wait until a condition holds. */
class Waiters {
  #waiting: readonly Waiter[] = [];

  async until(isDone: () => boolean): Promise<void> {
    if (isDone()) return;
    await new Promise<void>((resolve, reject) => {
      this.#waiting = [...this.#waiting, { isDone, resolve, reject }];
    });
  }

  /** Check all conditions after a change. With a failure, the remaining calls are rejected. */
  check(failure: Failure | null): void {
    const over = this.#waiting.filter((one) => failure !== null || one.isDone());
    if (over.length === 0) return;
    this.#waiting = this.#waiting.filter((one) => !over.includes(one));
    for (const one of over) {
      if (one.isDone() || failure === null) one.resolve();
      else one.reject(new TelemetryError(failure));
    }
  }
}
