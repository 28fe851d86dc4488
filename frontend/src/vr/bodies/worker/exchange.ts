/**
 * Hands values from one thread to another through shared memory: the newest one wins, none waits.
 *
 * Three slots: one that the writer fills, one that the reader reads, and one between them. Each side
 * swaps its own slot for the one between them, so neither ever waits for the other, nothing queues
 * up, and nothing is read half-written.
 */

const SLOTS = 3;
const INDEX = 3;
const FRESH = 4;
const FIRST_READER = 0;
const FIRST_BETWEEN = 1;
const FIRST_WRITER = 2;

/** Where one exchange lies in shared memory. */
export interface Exchange {
  readonly control: Int32Array;
  /** The word of `control` that names the slot between the two sides. */
  readonly word: number;
}

export const slotBytes = (bytes: number): number => SLOTS * bytes;
export const slotOffsets = (at: number, bytes: number): readonly number[] =>
  [...Array(SLOTS).keys()].map((slot) => at + slot * bytes);

/** Call once, before either side begins. */
export function prepare({ control, word }: Exchange): void {
  Atomics.store(control, word, FIRST_BETWEEN);
}

export class Writer<Slot> {
  private own = FIRST_WRITER;

  constructor(
    private readonly exchange: Exchange,
    private readonly slots: readonly Slot[],
  ) {}

  /** The slot to fill; `publish` hands it over. */
  get slot(): Slot {
    return this.slots[this.own] as Slot;
  }

  publish(): void {
    const { control, word } = this.exchange;
    this.own = Atomics.exchange(control, word, this.own | FRESH) & INDEX;
  }
}

export class Reader<Slot> {
  private own = FIRST_READER;

  constructor(
    private readonly exchange: Exchange,
    private readonly slots: readonly Slot[],
  ) {}

  /** The newest value, if it was not taken before. */
  take(): Slot | null {
    const { control, word } = this.exchange;
    if ((Atomics.load(control, word) & FRESH) === 0) return null;
    this.own = Atomics.exchange(control, word, this.own) & INDEX;
    return this.slots[this.own] as Slot;
  }
}
