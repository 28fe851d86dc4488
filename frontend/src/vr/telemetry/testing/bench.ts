/**
 * The page of the browser tests (`tests/e2e/test_telemetry_client.py`), which bundle it themselves:
 * no page of the product refers to it.
 *
 * What it sends is a function of stream, epoch and seq, so the test can check every bit of it, even
 * if the page was killed: row `seq % rows` of a table from the test, with epoch, stream and seq in
 * place of the root position.
 */
import {
  flushWhenLeft,
  type Level,
  openTelemetry,
  openTelemetryInWorker,
  type Status,
  type StreamName,
  type TelemetryClient,
  type TelemetryOptions,
  VALUES_PER_FRAME,
} from "../index";
import { BODY_STREAMS } from "../wire/batch";

const FRAMES_PER_BATCH = 6;
const RATE_HZ = 90;
const FRAMES_PER_REPORT = 90;

export class Bench {
  client: TelemetryClient | null = null;
  readonly produced = { frames: 0, reports: 0 };
  readonly levels: Level[] = [];
  /** The number of write transactions on IndexedDB in this thread. */
  journalWrites = 0;
  notices = 0;
  connectedAtMs = 0;
  error: string | null = null;
  #table = new Float32Array();

  constructor() {
    const bench = this;
    const begin = IDBDatabase.prototype.transaction;
    IDBDatabase.prototype.transaction = function counted(...how) {
      if (how[1] === "readwrite") bench.journalWrites++;
      return begin.apply(this, how);
    };
  }

  /** Open a client; `table`: rows of 91 float32 in base64. */
  async open(options: TelemetryOptions, inWorker: boolean, table: string): Promise<number> {
    this.#table = new Float32Array(Uint8Array.from(atob(table), (c) => c.charCodeAt(0)).buffer);
    const open = inWorker ? openTelemetryInWorker : openTelemetry;
    this.client = await open(options, { onStatus: (status) => this.#note(status) });
    if (!inWorker) flushWhenLeft(this.client);
    this.client.onNotice(() => {
      this.notices++;
    });
    return this.client.epoch;
  }

  /**
   * Produce batches of both streams, at `speed` times real time; null: as fast as they are
   * accepted.
   */
  async produce(batches: number, speed: number | null): Promise<void> {
    const client = this.#opened();
    const beganMs = performance.now() - (speed ? this.#dueMs(speed) : 0);
    for (let batch = 0; batch < batches; batch++) {
      const first = this.produced.frames;
      for (const stream of BODY_STREAMS)
        await client.sendFrames(stream, this.#frames(stream, first));
      this.produced.frames += FRAMES_PER_BATCH;
      if (this.produced.frames % FRAMES_PER_REPORT === 0) {
        await client.report({ kind: "materialised", t_s: this.produced.reports++ });
      }
      if (speed === null) continue;
      const waitMs = beganMs + this.#dueMs(speed) - performance.now();
      if (waitMs > 0) await new Promise((resolve) => setTimeout(resolve, waitMs));
    }
  }

  /** Produce in the background while the test does something else; `error` reports a failure. */
  begin(batches: number, speed: number | null): void {
    this.produce(batches, speed).catch((error) => {
      this.error = String(error);
    });
  }

  /** Wait until everything is stored; return the seconds since the newest connection. */
  async drained(): Promise<number> {
    await this.#opened().drained();
    return (performance.now() - this.connectedAtMs) / 1000;
  }

  #opened(): TelemetryClient {
    if (this.client === null) throw new Error("open the client first");
    return this.client;
  }

  #dueMs(speed: number): number {
    return (this.produced.frames * 1000) / RATE_HZ / speed;
  }

  #frames(stream: StreamName, first: number) {
    const rows = this.#table.length / VALUES_PER_FRAME;
    const values = new Float32Array(FRAMES_PER_BATCH * VALUES_PER_FRAME);
    const bytes = new Uint8Array(values.buffer);
    const rowBytes = 4 * VALUES_PER_FRAME;
    for (let frame = 0; frame < FRAMES_PER_BATCH; frame++) {
      const row = (first + frame) % rows;
      // Copied as bytes: a NaN must keep its payload.
      bytes.set(new Uint8Array(this.#table.buffer, row * rowBytes, rowBytes), frame * rowBytes);
      const place = [this.#opened().epoch, stream === "target" ? 1 : 2, first + frame];
      values.set(place, frame * VALUES_PER_FRAME);
    }
    const seqs = Array.from({ length: FRAMES_PER_BATCH }, (_, frame) => first + frame);
    return {
      phaseId: 0,
      timesS: Float64Array.from(seqs, (seq) => seq / RATE_HZ),
      flags: Uint8Array.from(seqs, (seq) => seq % 2),
      values,
      activeS: 0,
      closedAtS: (first + FRAMES_PER_BATCH) / RATE_HZ,
    };
  }

  #note(status: Status): void {
    if (status.level !== this.levels.at(-1)) this.levels.push(status.level);
    if (!status.connected) this.connectedAtMs = 0;
    else if (this.connectedAtMs === 0) this.connectedAtMs = performance.now();
  }
}

Object.assign(globalThis, { bench: new Bench() });
