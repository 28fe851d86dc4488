/**
 * A journal that nothing is resent from: it shows how long this device takes to write telemetry down.
 *
 * What is added is written and deleted as a visit's journal does it: in the same blocks, as often,
 * and without what is acknowledged before.
 */
import { DEFAULT_LIMITS } from "../limits";
import type { StreamPosition } from "../wire/fromServer";
import type { BlockStore, Entry } from "./entries";
import { IndexedDbBlocks } from "./indexedDb";
import { Journal } from "./journal";

/** It belongs to no session, and what it holds is worth nothing to the next page. */
const NAME = "self-test";

export interface TrialOptions {
  /** Told of every transaction how long it took, s. */
  readonly onWritten: (tookS: number) => void;
  /** Where blocks are kept, if not in the browser's own database. */
  readonly store?: BlockStore;
}

export class TrialJournal {
  readonly #store: BlockStore;
  readonly #journal: Journal;
  readonly #ticking: ReturnType<typeof setInterval>;

  private constructor(store: BlockStore, journal: Journal) {
    this.#store = store;
    this.#journal = journal;
    const tick = () => void journal.tidy();
    this.#ticking = setInterval(tick, DEFAULT_LIMITS.flushEveryS * 1000);
  }

  /** Open it empty: a page that was killed in a test may have left something. */
  static async open({ onWritten, store }: TrialOptions): Promise<TrialJournal> {
    const blocks = store ?? (await IndexedDbBlocks.open(NAME, "relaxed"));
    await blocks.clear();
    const room = async () => Number.POSITIVE_INFINITY;
    const parts = { store: timed(blocks, onWritten), limits: DEFAULT_LIMITS, room };
    const journal = await Journal.open(parts);
    await journal.claim(NAME);
    return new TrialJournal(blocks, journal);
  }

  /** Why the last write failed; null if it succeeded. */
  get problem(): string | null {
    return this.#journal.problem;
  }

  add(entry: Entry): void {
    this.#journal.add(entry);
  }

  acknowledge(positions: readonly StreamPosition[]): void {
    this.#journal.acknowledge(positions);
  }

  /** Delete what it holds, and close it. */
  async close(): Promise<void> {
    clearInterval(this.#ticking);
    await this.#journal.flush();
    await this.#store.clear();
    this.#store.close();
  }
}

const timed = (store: BlockStore, onWritten: (tookS: number) => void): BlockStore => ({
  load: () => store.load(),
  read: (places) => store.read(places),
  clear: () => store.clear(),
  close: () => store.close(),
  write: async (change) => {
    const beganMs = performance.now();
    await store.write(change);
    onWritten((performance.now() - beganMs) / 1000);
  },
});
