/**
 * Messages that are not known to be on the server's disk.
 *
 * Messages are appended to the tail in memory and sent from there. Every quarter of a second those
 * that are still unacknowledged are written to the browser's disk in one transaction and removed
 * from
 * memory, so a reload or an hour without network loses none, and memory does not grow. Acknowledged
 * blocks are deleted by the next transaction. Nothing else is ever removed.
 */
import type { Limits } from "../limits";
import type { StreamPosition } from "../wire/fromServer";
import { Contents } from "./contents";
import { type BlockStore, type Entry, packed, type Run, type StoredJournal } from "./entries";
import { Reader } from "./reader";

export interface JournalParts {
  readonly store: BlockStore;
  readonly limits: Limits;
  /** Bytes that the browser would still store; Infinity if it does not say. */
  readonly room: () => Promise<number>;
}

export class Journal {
  readonly reader: Reader;
  /** Called after an acknowledgement or a write, whether it succeeded or not. */
  onChange: () => void = () => undefined;

  readonly #parts: JournalParts;
  readonly #contents: Contents;
  readonly #runs: Map<number, Run>;
  #sessionId: string | null;
  #problem: string | null = null;
  /** Everything below this place is deleted on disk. */
  #forgottenBelow: number;
  #limitBytes: number;
  #measuredBytes: number | null = null;
  #writing: Promise<void> | null = null;

  private constructor(held: StoredJournal, parts: JournalParts) {
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

  /** Why the browser's last write failed; null if it succeeded. */
  get problem(): string | null {
    return this.#problem;
  }

  /** Whether the producer must wait for acknowledgements. */
  get isFull(): boolean {
    const stuck = this.#problem !== null && !this.#hasMemory;
    return stuck || this.bytes >= this.#limitBytes;
  }

  /** Whether a message may be added now; if not, it soon may, unless `isFull`. */
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

  /** Claim the journal for a session; return false while it contains another session's messages. */
  async claim(sessionId: string): Promise<boolean> {
    if (this.#sessionId !== null && this.#sessionId !== sessionId) {
      if (this.messages > 0) return false;
      await this.#parts.store.clear();
      this.#runs.clear();
    }
    this.#sessionId = sessionId;
    return true;
  }

  /** Record how far a run has come; stored along with the messages. */
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
    this.#contents.removeStored(this.#writing !== null);
    this.onChange();
  }

  /** Write what is not on disk yet and delete what is acknowledged; `problem` reports a failure. */
  async tidy(): Promise<void> {
    this.#writing ??= this.#write().finally(() => {
      this.#writing = null;
      this.#contents.removeStored(false);
      this.onChange();
    });
    await this.#writing;
  }

  /** Resolves once everything added so far is on disk, or there is a `problem`. */
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

  /** Only delete what is acknowledged: a full disk takes nothing new, but allows that. */
  async #forgetOnly(sessionId: string, forgetBelow: number): Promise<void> {
    if (forgetBelow === this.#forgottenBelow) return;
    try {
      await this.#parts.store.write({ sessionId, forgetBelow, added: [], runs: [] });
      this.#forgottenBelow = forgetBelow;
    } catch {
      // `problem` already reports it.
    }
  }

  /**
   * Update the limit: the requested one, or the browser's remaining space, queried every few
   * megabytes. If the browser grants nothing, memory can still be used.
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
