/**
 * The contents of a journal: blocks on disk, of which only the description is in memory, then the
 * tail.
 *
 *     front [ block | block | block ][ tail ] end        places count up from the front to the end
 *              on disk                 in memory
 */
import {
  type Block,
  type End,
  type Entry,
  keyOf,
  Positions,
  type StoredJournal,
  sizeOf,
} from "./entries";

export class Contents {
  readonly stored = new Positions();
  /** The last end of every stream and run that the journal has contained. */
  readonly #ends = new Map<string, End>();
  readonly #blocks: Block[];
  readonly #tail: Entry[] = [];
  #tailPlace = 0;
  #tailBytes = 0;
  #diskBytes = 0;

  constructor(held: StoredJournal) {
    this.#blocks = [...held.blocks];
    for (const block of held.blocks) {
      this.#diskBytes += block.bytes;
      this.#tailPlace = block.place + block.messages;
      for (const end of block.ends) this.#ends.set(keyOf(end), end);
    }
  }

  get front(): number {
    return this.#blocks[0]?.place ?? this.#tailPlace;
  }

  get end(): number {
    return this.#tailPlace + this.#tail.length;
  }

  get messages(): number {
    return this.end - this.front;
  }

  get tailPlace(): number {
    return this.#tailPlace;
  }

  get tailBytes(): number {
    return this.#tailBytes;
  }

  get bytes(): number {
    return this.#diskBytes + this.#tailBytes;
  }

  /** When the oldest message was produced, ms since 1970; null if there is none. */
  get oldestMs(): number | null {
    return this.#blocks[0]?.madeAtMs ?? this.#tail[0]?.madeAtMs ?? null;
  }

  get tail(): readonly Entry[] {
    return this.#tail;
  }

  /** Whether all messages of a stream are stored, of every run. */
  isSettled(stream: string): boolean {
    return [...this.#ends.values()].every(
      (end) => end.stream !== stream || this.stored.covers(end),
    );
  }

  /** The message at a place in the tail. */
  inTail(place: number): Entry | undefined {
    return this.#tail[place - this.#tailPlace];
  }

  /** `count` blocks, starting with the one that contains this place. */
  blocksFrom(place: number, count: number): readonly Block[] {
    const at = this.#blocks.findIndex((block) => place < block.place + block.messages);
    return at < 0 ? [] : this.#blocks.slice(at, at + count);
  }

  add(entry: Entry): void {
    this.#tail.push(entry);
    this.#tailBytes += sizeOf(entry);
    const { stream, epoch, seqEnd } = entry;
    this.#ends.set(keyOf(entry), { stream, epoch, seqEnd });
  }

  /** Replace the front of the tail by these blocks. */
  moveToDisk(blocks: readonly Block[]): void {
    for (const block of blocks) {
      this.#blocks.push(block);
      this.#diskBytes += block.bytes;
      this.#cutTail(block.messages);
    }
  }

  /**
   * Remove what is stored, starting from the front: an acknowledged message behind one that is not
   * stays until that one is removed; sending it again would do no harm. `exceptTail`: the tail is
   * being written.
   */
  removeStored(exceptTail: boolean): void {
    const firstKept = this.#blocks.findIndex(
      (block) => !block.ends.every((end) => this.#covers(end)),
    );
    const removed = this.#blocks.splice(0, firstKept < 0 ? this.#blocks.length : firstKept);
    for (const block of removed) this.#diskBytes -= block.bytes;
    if (this.#blocks.length > 0 || exceptTail) return;
    const first = this.#tail.findIndex((entry) => !this.#covers(entry));
    this.#cutTail(first < 0 ? this.#tail.length : first);
  }

  #covers(end: End): boolean {
    return this.stored.covers(end);
  }

  #cutTail(count: number): void {
    for (const entry of this.#tail.splice(0, count)) this.#tailBytes -= sizeOf(entry);
    this.#tailPlace += count;
  }
}
