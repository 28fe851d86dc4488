/** Journals on a fake disk, with messages of a few bytes. */
import type { Block, BlockStore, Change, Entry, Run, StoredJournal } from "../journal/entries";
import { Journal } from "../journal/journal";
import { DEFAULT_LIMITS, type Limits } from "../limits";

export const SESSION = "session";

export function entry(
  stream: string,
  seqEnd: number,
  { epoch = 1, size = 10, madeAtMs = 0 } = {},
): Entry {
  return { stream, epoch, seqEnd, message: "x".repeat(size), madeAtMs };
}

export async function opened(
  store: MemoryBlocks,
  limits: Partial<Limits> = {},
  room = async () => Number.POSITIVE_INFINITY,
): Promise<Journal> {
  const journal = await Journal.open({ store, limits: { ...DEFAULT_LIMITS, ...limits }, room });
  await journal.claim(SESSION);
  return journal;
}

export async function filled(...entries: readonly Entry[]): Promise<[Journal, MemoryBlocks]> {
  const store = new MemoryBlocks();
  const journal = await opened(store);
  for (const one of entries) journal.add(one);
  return [journal, store];
}

/** Everything that would be sent now, from the front. */
export async function toSend(journal: Journal): Promise<readonly string[]> {
  journal.reader.rewind();
  const found: string[] = [];
  for (;;) {
    const next = await journal.reader.next();
    if (next === null) return found;
    found.push(`${next.stream}/${next.epoch}/${next.seqEnd}`);
  }
}

export const ack = (stream: string, next_seq: number, epoch = 1) => ({ stream, epoch, next_seq });

/** A journal's disk for tests: it counts writes, fails on request, and outlives its journal. */
export class MemoryBlocks implements BlockStore {
  readonly blocks = new Map<number, Block>();
  readonly entries = new Map<number, readonly Entry[]>();
  readonly runs = new Map<number, Run>();
  sessionId: string | null = null;
  writes = 0;
  /** While it is set, every write fails with it. */
  failure: Error | null = null;
  /** While it is set, every write that adds something fails with it. */
  isFull: Error | null = null;
  /** While it is set, every read fails with it. */
  unreadable: Error | null = null;
  failedReads = 0;

  async load(): Promise<StoredJournal> {
    return {
      sessionId: this.sessionId,
      blocks: [...this.blocks.values()],
      runs: [...this.runs.values()],
    };
  }

  async write(change: Change): Promise<void> {
    this.writes++;
    // Write the state at the time of the call, as a browser copies it.
    const copy = structuredClone(change);
    await Promise.resolve();
    if (this.failure !== null) throw this.failure;
    if (this.isFull !== null && copy.added.length > 0) throw this.isFull;
    this.sessionId = copy.sessionId;
    for (const place of this.blocks.keys()) if (place < copy.forgetBelow) this.forget(place);
    for (const run of copy.runs) this.runs.set(run.epoch, run);
    for (const { block, entries } of copy.added) {
      this.blocks.set(block.place, block);
      this.entries.set(block.place, entries);
    }
  }

  async read(places: readonly number[]): Promise<readonly (readonly Entry[] | null)[]> {
    await Promise.resolve();
    if (this.unreadable !== null) {
      this.failedReads++;
      throw this.unreadable;
    }
    return places.map((place) => this.entries.get(place) ?? null);
  }

  async clear(): Promise<void> {
    for (const map of [this.blocks, this.entries, this.runs]) map.clear();
    this.sessionId = null;
  }

  close(): void {}

  forget(place: number): void {
    this.blocks.delete(place);
    this.entries.delete(place);
  }
}
