/** A journal's disk for tests: it counts, fails when told, and outlives the journal on it. */
import type { Block, BlockStore, Change, Entry, Held, Run } from "../journal/entries";

export class MemoryBlocks implements BlockStore {
  readonly blocks = new Map<number, Block>();
  readonly entries = new Map<number, readonly Entry[]>();
  readonly runs = new Map<number, Run>();
  sessionId: string | null = null;
  writes = 0;
  /** Every write fails with it while it is set. */
  failure: Error | null = null;
  /** Writes that add something fail with it. */
  isFull: Error | null = null;
  /** Every read fails with it while it is set. */
  unreadable: Error | null = null;
  failedReads = 0;

  async load(): Promise<Held> {
    return {
      sessionId: this.sessionId,
      blocks: [...this.blocks.values()],
      runs: [...this.runs.values()],
    };
  }

  async write(change: Change): Promise<void> {
    this.writes++;
    // The state at the call is what is written, as a browser copies it.
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
