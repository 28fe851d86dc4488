/** The types of a journal's contents, in memory and on disk. */
import type { StreamPosition } from "../wire/fromServer";

/**
 * A message with the seqs it carries: those of its stream and epoch below `seqEnd`, after the
 * previous message.
 */
export interface Entry {
  readonly stream: string;
  readonly epoch: number;
  readonly seqEnd: number;
  readonly message: Uint8Array<ArrayBuffer> | string;
  /** When it was produced, ms since 1970: the only clock that survives a reload. */
  readonly madeAtMs: number;
}

/** How far one stream of one run goes. */
export interface End {
  readonly stream: string;
  readonly epoch: number;
  readonly seqEnd: number;
}

/**
 * Messages that are written together, oldest first. The first has the place `place`, the others
 * follow without a gap; places count up through the whole journal and are never reused.
 */
export interface Block {
  readonly place: number;
  readonly messages: number;
  readonly bytes: number;
  /** When its oldest message was produced, ms since 1970. */
  readonly madeAtMs: number;
  /** The whole block is stored once each of these ends is. */
  readonly ends: readonly End[];
}

/** One run of the client (an epoch), and how much it has produced: the next seq of each stream. */
export interface Run {
  readonly epoch: number;
  readonly produced: Readonly<Record<string, number>>;
}

/** What a journal finds on disk when it is opened. */
export interface StoredJournal {
  readonly sessionId: string | null;
  readonly blocks: readonly Block[];
  readonly runs: readonly Run[];
}

export interface NewBlock {
  readonly block: Block;
  readonly entries: readonly Entry[];
}

/** One transaction: afterwards all of it is on disk, or none. */
export interface Change {
  readonly sessionId: string;
  /** Delete all blocks below this place. */
  readonly forgetBelow: number;
  readonly added: readonly NewBlock[];
  readonly runs: readonly Run[];
}

/** The storage of blocks. */
export interface BlockStore {
  load(): Promise<StoredJournal>;
  write(change: Change): Promise<void>;
  /** The entries of the blocks at these places, null for a missing block. */
  read(places: readonly number[]): Promise<readonly (readonly Entry[] | null)[]>;
  /** Delete everything, including the runs. */
  clear(): Promise<void>;
  close(): void;
}

export const keyOf = (end: { readonly stream: string; readonly epoch: number }): string =>
  `${end.stream}/${end.epoch}`;

export const sizeOf = (entry: Entry): number => entry.message.length;

/** Pack entries into blocks of at most `blockBytes` (a larger message gets one of its own). */
export function packed(
  entries: readonly Entry[],
  firstPlace: number,
  blockBytes: number,
): readonly NewBlock[] {
  const groups: Entry[][] = [];
  let bytes = Number.POSITIVE_INFINITY;
  for (const entry of entries) {
    if (bytes + sizeOf(entry) > blockBytes) {
      groups.push([]);
      bytes = 0;
    }
    groups.at(-1)?.push(entry);
    bytes += sizeOf(entry);
  }
  let place = firstPlace;
  return groups.map((group) => {
    const block = blockOf(group, place);
    place += group.length;
    return { block, entries: group };
  });
}

function blockOf(entries: readonly Entry[], place: number): Block {
  const ends = new Map<string, End>();
  for (const { stream, epoch, seqEnd } of entries) {
    ends.set(keyOf({ stream, epoch }), { stream, epoch, seqEnd });
  }
  return {
    place,
    messages: entries.length,
    bytes: entries.reduce((sum, entry) => sum + sizeOf(entry), 0),
    madeAtMs: entries[0]?.madeAtMs ?? 0,
    ends: [...ends.values()],
  };
}

/** How far each stream is stored on the server, according to its acknowledgements. */
export class Positions {
  readonly #nextSeq = new Map<string, number>();

  /** Advance the positions; they never go back, even if acknowledgements arrive late. */
  advance(positions: readonly StreamPosition[]): void {
    for (const position of positions) {
      const key = keyOf(position);
      this.#nextSeq.set(key, Math.max(position.next_seq, this.#nextSeq.get(key) ?? 0));
    }
  }

  nextSeq(stream: string, epoch: number): number {
    return this.#nextSeq.get(keyOf({ stream, epoch })) ?? 0;
  }

  covers(end: End): boolean {
    return end.seqEnd <= this.nextSeq(end.stream, end.epoch);
  }
}
