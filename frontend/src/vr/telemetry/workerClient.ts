/** The page's side of a client in a worker. */
import { ClientEvents, type Status, type TelemetryClient, type TelemetryOptions } from "./client";
import { CLOSED, type Failure, TelemetryError } from "./failure";
import type { Call, FromWorker, Port, PortError, ToWorker } from "./port";
import type { Frames, StreamName } from "./wire/batch";
import type { ReportBody } from "./wire/fromClient";

interface Pending {
  readonly resolve: () => void;
  readonly reject: (error: Error) => void;
}

export class WorkerClient extends ClientEvents implements TelemetryClient {
  readonly #port: Port<ToWorker, FromWorker>;
  readonly #pending = new Map<number, Pending>();
  readonly #opening: Pending;
  readonly #opened: Promise<void>;
  #nextId = 0;
  #reportsMade = 0;
  #status = NOTHING_YET;
  #failure: Failure | null = null;

  /** `timeOriginMs`: of the page, whose clock the client's times refer to. */
  constructor(port: Port<ToWorker, FromWorker>, options: TelemetryOptions, timeOriginMs: number) {
    super();
    let opening: Pending = { resolve: () => undefined, reject: () => undefined };
    this.#opened = new Promise((resolve, reject) => {
      opening = { resolve, reject };
    });
    this.#opening = opening;
    this.#port = port;
    port.addEventListener("message", ({ data }) => this.#receive(data));
    port.postMessage({ kind: "open", options, timeOriginMs }, []);
  }

  async opened(): Promise<this> {
    await this.#opened;
    return this;
  }

  /** Abort the wait for the server. */
  giveUp(): void {
    this.#port.postMessage({ kind: "giveUp" }, []);
  }

  /** Called when the worker itself has failed; what it had journaled is on disk. */
  fail(failure: Failure): void {
    this.#failure = failure;
    const error = new TelemetryError(failure);
    this.#opening.reject(error);
    for (const { reject } of this.#pending.values()) reject(error);
    this.#pending.clear();
    this.#tellStatus({ ...this.#status, connected: false, failure });
  }

  get status(): Status {
    return this.#status;
  }

  /** Whether all reports are stored; the worker may not have heard of the newest ones yet. */
  get settled(): boolean {
    return this.#status.settled && this.#status.reportsMade >= this.#reportsMade;
  }

  async sendFrames(stream: StreamName, frames: Frames): Promise<void> {
    // The caller reuses the arrays, so copies are transferred, which need not be copied a second
    // time.
    const timesS = frames.timesS.slice();
    const flags = frames.flags.slice();
    const values = frames.values.slice();
    const copy = { ...frames, timesS, flags, values };
    const arrays = [timesS.buffer, flags.buffer, values.buffer];
    await this.#call({ what: "sendFrames", stream, frames: copy }, arrays);
  }

  async report(body: ReportBody): Promise<void> {
    this.#reportsMade++;
    try {
      await this.#call({ what: "report", body });
    } catch (error) {
      // A report that was rejected before it was made never becomes settled.
      this.#reportsMade--;
      throw error;
    }
  }

  async drained(): Promise<void> {
    await this.#call({ what: "drained" });
  }

  async flush(): Promise<void> {
    await this.#call({ what: "flush" });
  }

  async close(): Promise<void> {
    if (this.#failure !== null) return;
    if (this.newestWelcome === null) {
      this.giveUp();
      return;
    }
    const closed = this.#call({ what: "close" });
    this.#failure = CLOSED;
    await closed;
  }

  async #call(call: Call, transfer: Transferable[] = []): Promise<void> {
    if (this.#failure !== null) throw new TelemetryError(this.#failure);
    const id = this.#nextId++;
    await new Promise<void>((resolve, reject) => {
      this.#pending.set(id, { resolve, reject });
      this.#port.postMessage({ kind: "call", id, call }, transfer);
    });
  }

  #receive(message: FromWorker): void {
    switch (message.kind) {
      case "opened":
        this.newestWelcome = message.welcome;
        this.newestState = message.state;
        this.#opening.resolve();
        break;
      case "refused":
        this.#failure = message.wrong.failure ?? CLOSED;
        this.#opening.reject(errorOf(message.wrong));
        break;
      case "done":
        this.#answered(message.id, message.wrong);
        break;
      case "state":
        this.newestWelcome = message.welcome;
        this.newestState = message.state;
        this.states.notify(message.state);
        break;
      case "status":
        this.#tellStatus(message.status);
        break;
      case "notice":
        this.notices.notify(message.notice);
    }
  }

  #answered(id: number, wrong: PortError | null): void {
    const call = this.#pending.get(id);
    this.#pending.delete(id);
    if (wrong === null) call?.resolve();
    else call?.reject(errorOf(wrong));
  }

  #tellStatus(status: Status): void {
    this.#status = status;
    this.statuses.notify(status);
  }
}

const NOTHING_YET: Status = {
  connected: false,
  level: "clear",
  journaledMessages: 0,
  journaledBytes: 0,
  oldestUnackedS: 0,
  waitingCalls: 0,
  reportsMade: 0,
  settled: false,
  problem: null,
  failure: null,
};

function errorOf({ name, message, failure }: PortError): Error {
  if (failure !== null) return new TelemetryError(failure);
  return Object.assign(new Error(message), { name });
}
