/**
 * Sends what a visit would record, over a socket of the test's own, and measures how it is
 * acknowledged.
 *
 * The session's recorder makes the batches, so their size and number are those of a visit. The
 * server commits them to its database with the telemetry of all sessions before it acknowledges
 * them, and keeps none of them (docs/protocol.md, section 9). On the device they go through a journal,
 * as a visit's do; here it is written in the page's own thread, a visit's in a worker's.
 */
import { Recorder } from "../session";
import {
  encodeBatch,
  type Frames,
  type StreamName,
  SUBPROTOCOL,
  serverMessage,
  TrialJournal,
} from "../telemetry";
import { StorageRecord } from "./measure/storage";

/** The socket's epoch and phase: a test has only one run, and no phases. */
const EPOCH = 1;
/** How long the last acknowledgements are awaited, s. */
const PATIENCE_S = 5;
const OPEN_PATIENCE_S = 5;
const POLL_MS = 20;

export interface SendingOptions {
  readonly url: string;
  readonly token: string;
  readonly withFingers: boolean;
  /** The page's monotonic clock, s. */
  readonly clock: () => number;
  readonly onError: (message: string) => void;
}

export class Sending {
  readonly recorder: Recorder;
  readonly #record: StorageRecord;
  /** Null if the device has no place for one. */
  readonly #journal: TrialJournal | null;
  readonly #socket: WebSocket;
  readonly #options: SendingOptions;
  readonly #produced = new Map<StreamName, number>();
  #isClosed = false;

  private constructor(
    socket: WebSocket,
    journal: TrialJournal | null,
    record: StorageRecord,
    options: SendingOptions,
  ) {
    const { withFingers, onError, clock } = options;
    this.#journal = journal;
    this.#record = record;
    this.#socket = socket;
    this.#options = options;
    this.recorder = new Recorder(
      {
        sendFrames: async (stream, frames) => this.#send(stream, frames),
        report: async () => undefined,
      },
      { withFingers, onFailure: (error) => onError(String(error)) },
    );
    socket.onmessage = ({ data }) => this.#receive(String(data), clock());
    socket.onclose = ({ code }) => this.#closed(code);
  }

  /** Open the journal and the socket; rejects if the server does not answer. */
  static async open(options: SendingOptions): Promise<Sending> {
    const record = new StorageRecord();
    const onWritten = (tookS: number) => record.written(tookS);
    const journal = await TrialJournal.open({ onWritten }).catch((error: unknown) => {
      options.onError(`The device's journal cannot be opened: ${error}.`);
      return null;
    });
    try {
      return new Sending(await Sending.#connected(options), journal, record, options);
    } catch (error) {
      void journal?.close().catch(() => undefined);
      throw error;
    }
  }

  static async #connected({ url, token }: SendingOptions): Promise<WebSocket> {
    const socket = new WebSocket(url, [SUBPROTOCOL, `bearer.${token}`]);
    socket.binaryType = "arraybuffer";
    await new Promise<void>((resolve, reject) => {
      const giveUp = (why: string) => {
        socket.close();
        reject(new Error(`Nothing could be sent: ${why}.`));
      };
      const patience = setTimeout(() => giveUp("no answer"), OPEN_PATIENCE_S * 1000);
      socket.onopen = () => {
        clearTimeout(patience);
        resolve();
      };
      socket.onclose = ({ code }) => {
        clearTimeout(patience);
        giveUp(`the connection was closed (${code})`);
      };
    });
    return socket;
  }

  /** The figures so far. */
  get figures() {
    return this.#record.figures();
  }

  /** Send what is left, wait for the last acknowledgements, and close. */
  async end(timeS: number): Promise<void> {
    this.recorder.end(timeS);
    const polls = (PATIENCE_S * 1000) / POLL_MS;
    for (let poll = 0; poll < polls && this.#record.waiting > 0 && !this.#isClosed; poll++) {
      await new Promise((resolve) => setTimeout(resolve, POLL_MS));
    }
    this.close();
  }

  close(): void {
    this.#isClosed = true;
    this.#socket.close();
    const problem = this.#journal?.problem ?? null;
    if (problem !== null) this.#options.onError(`The device's journal: ${problem}`);
    void this.#journal?.close().catch(() => undefined);
  }

  #send(stream: StreamName, frames: Frames): void {
    const seqFirst = this.#produced.get(stream) ?? 0;
    const seqEnd = seqFirst + frames.timesS.length;
    this.#produced.set(stream, seqEnd);
    const message = encodeBatch({ ...frames, stream, epoch: EPOCH, seqFirst });
    const madeAtMs = Date.now();
    this.#journal?.add({ stream, epoch: EPOCH, seqEnd, message, madeAtMs });
    // What cannot be sent counts, too: a visit would have had to send it.
    this.#record.sent(stream, seqEnd, message.byteLength, this.#options.clock());
    if (this.#socket.readyState === WebSocket.OPEN) this.#socket.send(message);
  }

  #receive(text: string, timeS: number): void {
    const message = serverMessage(text);
    if (message?.type === "ack") {
      this.#journal?.acknowledge(message.positions);
      for (const { stream, next_seq } of message.positions) {
        this.#record.acknowledged(stream, next_seq, timeS);
      }
    } else if (message?.type === "error") this.#options.onError(message.message);
  }

  #closed(code: number): void {
    if (this.#isClosed) return;
    this.#isClosed = true;
    this.#options.onError(`The connection for sending was closed (${code}).`);
  }
}
