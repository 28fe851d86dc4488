/**
 * What was made and is not known to be on the server's disk.
 *
 * Messages join the tail in memory and are sent from there. Every quarter of a second those that are
 * still unacknowledged are written to the browser's disk in one transaction and leave the memory: so
 * neither a reload nor an hour without network costs any, and memory does not grow. Acknowledged
 * blocks are deleted by the next transaction. Nothing else ever leaves.
 */
import type { Limits } from "../limits";
import type { StreamPosition } from "../wire/fromServer";
import { Contents } from "./contents";
import { type BlockStore, type Entry, type Held, packed, type Run } from "./entries";
import { Reader } from "./reader";

export interface JournalParts {
  readonly store: BlockStore;
  readonly limits: Limits;
  /** Bytes that the browser would still store; Infinity if it does not say. */
  readonly room: () => Promise<number>;
}

export class Journal {
  readonly reader: Reader;
  /** Called when something was acknowledged, was written or could not be. */
  onChange: () => void = () => undefined;

  readonly #parts: JournalParts;
  readonly #contents: Contents;
  readonly #runs: Map<number, Run>;
  #sessionId: string | null;
  #problem: string | null = null;
  /** Everything below is deleted on disk. */
  #forgottenBelow: number;
  #limitBytes: number;
  #measuredBytes: number | null = null;
  #writing: Promise<void> | null = null;

  private constructor(held: Held, parts: JournalParts) {
    this.#parts = parts;
    this.#sessionId = held.sessionId;
    this.#contents = new Contents(held);
    this.#forgottenBelow = this.#contents.front;
    this.#runs = new Map(held.runs.map((run) => [run.epoch, run]));
    this.#limitBytes = parts.limits.journalBytes;
    this.reader = new Reader(this.#contents, parts.store, parts.limits.blocksAhead);
  }

  static async open(parts: JournalParts): Promise<Journal> {
    const journal = new Journal(await parts.store.load(), parts);
    await journal.#measure();
    return journal;
  }

  get sessionId(): string | null {
    return this.#sessionId;
  }

  get runs(): readonly Run[] {
    return [...this.#runs.values()];
  }

  get messages(): number {
    return this.#contents.messages;
  }

  get bytes(): number {
    return this.#contents.bytes;
  }

  get oldestMs(): number | null {
    return this.#contents.oldestMs;
  }

  /** Why the browser could not write the last time; null if it could. */
  get problem(): string | null {
    return this.#problem;
  }

  /** Whether the producer must wait for acknowledgements. */
  get isFull(): boolean {
    const stuck = this.#problem !== null && !this.#hasMemory;
    return stuck || this.bytes >= this.#limitBytes;
  }

  /** Whether a message may join now; if not, soon, unless `isFull`. */
  get hasRoom(): boolean {
    return !this.isFull && this.#hasMemory;
  }

  nextSeq(stream: string, epoch: number): number {
    return this.#contents.stored.nextSeq(stream, epoch);
  }

  /** Whether all messages of a stream are stored, of every run. */
  isSettled(stream: string): boolean {
    return this.#contents.isSettled(stream);
  }

  /** Whether it may carry this session's messages: not while it holds another's. */
  async claim(sessionId: string): Promise<boolean> {
    if (this.#sessionId !== null && this.#sessionId !== sessionId) {
      if (this.messages > 0) return false;
      await this.#parts.store.clear();
      this.#runs.clear();
    }
    this.#sessionId = sessionId;
    return true;
  }

  /** How far a run has come; it is kept beside the messages. */
  note(run: Run): void {
    this.#runs.set(run.epoch, run);
  }

  add(entry: Entry): void {
    this.#contents.add(entry);
    this.reader.wake();
    if (this.#contents.tailBytes >= this.#parts.limits.flushBytes) void this.tidy();
  }

  acknowledge(positions: readonly StreamPosition[]): void {
    this.#contents.stored.advance(positions);
    this.#contents.letGo(this.#writing !== null);
    this.onChange();
  }

  /** Write what is not on disk yet and delete what is acknowledged; `problem` says what went wrong. */
  async tidy(): Promise<void> {
    this.#writing ??= this.#write().finally(() => {
      this.#writing = null;
      this.#contents.letGo(false);
      this.onChange();
    });
    await this.#writing;
  }

  /** All that was added before is on disk afterwards, unless there is a `problem`. */
  async flush(): Promise<void> {
    if (this.#writing !== null) await this.#writing;
    await this.tidy();
  }

  close(): void {
    this.#parts.store.close();
  }

  get #hasMemory(): boolean {
    return this.#contents.tailBytes < this.#parts.limits.memoryBytes;
  }

  async #write(): Promise<void> {
    const { tail, tailPlace, front } = this.#contents;
    if (this.#sessionId !== null && (tail.length > 0 || front !== this.#forgottenBelow)) {
      const added = packed(tail, tailPlace, this.#parts.limits.blockBytes);
      const change = { sessionId: this.#sessionId, forgetBelow: front, added, runs: this.runs };
      try {
        await this.#parts.store.write(change);
        this.#problem = null;
        this.#forgottenBelow = front;
        this.#contents.moveToDisk(added.map(({ block }) => block));
      } catch (error) {
        this.#problem = error instanceof Error ? `${error.name}: ${error.message}` : String(error);
        await this.#forgetOnly(change.sessionId, front);
      }
    }
    await this.#measure();
  }

  /** A disk that is full takes nothing more, but lets go of what is acknowledged. */
  async #forgetOnly(sessionId: string, forgetBelow: number): Promise<void> {
    if (forgetBelow === this.#forgottenBelow) return;
    try {
      await this.#parts.store.write({ sessionId, forgetBelow, added: [], runs: [] });
      this.#forgottenBelow = forgetBelow;
    } catch {
      // `problem` tells already.
    }
  }

  /**
   * The limit is what was asked for, or what the browser still gives, asked every few megabytes. A
   * browser that gives nothing still leaves the memory.
   */
  async #measure(): Promise<void> {
    const { journalBytes, quotaReserve, memoryBytes } = this.#parts.limits;
    const isOld = Math.abs(this.bytes - (this.#measuredBytes ?? Number.NaN)) >= memoryBytes;
    if (this.#measuredBytes !== null && !isOld && !this.isFull) return;
    this.#measuredBytes = this.bytes;
    const given = this.bytes + (await this.#parts.room()) * (1 - quotaReserve);
    this.#limitBytes = Math.min(journalBytes, Math.max(memoryBytes, given));
  }
}
