/** The sender's position in the journal: message by message, reading old ones back from disk. */
import type { Contents } from "./contents";
import type { BlockStore, Entry } from "./entries";

/** Thrown when the browser has lost stored messages, which therefore cannot be delivered. */
export class JournalLost extends Error {
  override readonly name = "JournalLost";
}

/** Reads the journal in order; only one sender at a time may use it. */
export class Reader {
  readonly #contents: Contents;
  readonly #store: BlockStore;
  readonly #blocksAhead: number;
  #cursor = 0;
  /** Entries that were read back from disk, starting at this place. */
  #window: { readonly place: number; readonly entries: readonly Entry[] } = NOTHING;
  #wake: () => void = () => undefined;

  constructor(contents: Contents, store: BlockStore, blocksAhead: number) {
    this.#contents = contents;
    this.#store = store;
    this.#blocksAhead = blocksAhead;
  }

  /** Start sending from the front again. */
  rewind(): void {
    this.#cursor = 0;
    this.wake();
  }

  /** End the wait of `news`. */
  wake(): void {
    this.#wake();
  }

  /** Resolves when there is more to send, or on `wake`. */
  async moreToSend(): Promise<void> {
    if (this.#cursor < this.#contents.end) return;
    await new Promise<void>((resolve) => {
      this.#wake = resolve;
    });
  }

  /**
   * The next message that is not acknowledged; null at the end. Throws JournalLost if it is
   * missing.
   */
  async next(): Promise<Entry | null> {
    for (;;) {
      this.#cursor = Math.max(this.#cursor, this.#contents.front);
      if (this.#cursor >= this.#contents.end) {
        this.#window = NOTHING;
        return null;
      }
      const entry =
        this.#contents.inTail(this.#cursor) ??
        this.#window.entries[this.#cursor - this.#window.place];
      if (entry === undefined) await this.#readAt(this.#cursor);
      else {
        this.#cursor++;
        if (!this.#contents.stored.covers(entry)) return entry;
      }
    }
  }

  async #readAt(place: number): Promise<void> {
    const blocks = this.#contents.blocksFrom(place, this.#blocksAhead);
    const read = await this.#store.read(blocks.map((block) => block.place));
    const entries: Entry[] = [];
    for (const [at, block] of blocks.entries()) {
      const found = read[at];
      if (found) entries.push(...found);
      // Acknowledged and deleted while it was read, so nobody needs it any more.
      else if (block.place < this.#contents.front) entries.length = 0;
      else throw new JournalLost(`the browser has lost ${block.messages} messages of the journal`);
    }
    const last = blocks.at(-1);
    if (last === undefined) throw new JournalLost(`nothing of the journal is at place ${place}`);
    this.#window = { place: last.place + last.messages - entries.length, entries };
  }
}

const NOTHING = { place: 0, entries: [] } as const;
