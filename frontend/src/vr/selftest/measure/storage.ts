/**
 * How batches are written down on the device, and how they are acknowledged: streams are sent in
 * order, and acknowledged up to a frame.
 */
import type { Report } from "../report";
import { Samples } from "./samples";

interface Batch {
  readonly stream: string;
  readonly seqEnd: number;
  readonly sentAtS: number;
}

export class StorageRecord {
  /** Those that are not acknowledged yet, in the order in which they were sent. */
  #waiting: readonly Batch[] = [];
  readonly #tripsS = new Samples();
  readonly #writesS = new Samples();
  #batches = 0;
  #bytes = 0;
  #firstSentS = 0;
  #lastSentS = 0;

  /** Note a batch handed over for sending; its frames end before `seqEnd`. */
  sent(stream: string, seqEnd: number, bytes: number, timeS: number): void {
    if (this.#batches === 0) this.#firstSentS = timeS;
    this.#batches += 1;
    this.#bytes += bytes;
    this.#lastSentS = timeS;
    this.#waiting = [...this.#waiting, { stream, seqEnd, sentAtS: timeS }];
  }

  /** Note that all frames of a stream before `nextSeq` are on disk. */
  acknowledged(stream: string, nextSeq: number, timeS: number): void {
    const isStored = (batch: Batch) => batch.stream === stream && batch.seqEnd <= nextSeq;
    for (const batch of this.#waiting) {
      if (isStored(batch)) this.#tripsS.add(timeS - batch.sentAtS);
    }
    this.#waiting = this.#waiting.filter((batch) => !isStored(batch));
  }

  /** Note a transaction of the device's journal by the time it took, s. */
  written(tookS: number): void {
    this.#writesS.add(tookS);
  }

  /** Batches that are not acknowledged yet. */
  get waiting(): number {
    return this.#waiting.length;
  }

  /** The figures of the report; null if nothing was to be sent. */
  figures(): Report["storage"] {
    if (this.#batches === 0) return null;
    const acknowledged = this.#tripsS.count;
    const [p50, p95, longest] = this.#tripsS.percentiles(0.5, 0.95, 1);
    const writes = this.#writesS.count;
    const [writeP95] = this.#writesS.percentiles(0.95);
    const sendingS = this.#lastSentS - this.#firstSentS;
    return {
      batches: this.#batches,
      bytes: this.#bytes,
      acknowledged,
      round_trip_p50_s: acknowledged > 0 ? p50 : null,
      round_trip_p95_s: acknowledged > 0 ? p95 : null,
      round_trip_longest_s: acknowledged > 0 ? longest : null,
      journal_writes: writes,
      journal_write_p95_s: writes > 0 ? writeP95 : null,
      bytes_per_s: sendingS > 0 ? this.#bytes / sendingS : 0,
    };
  }
}
