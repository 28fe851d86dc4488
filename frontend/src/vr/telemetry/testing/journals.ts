/** Journals on a fake disk, with messages of a few bytes. */
import type { Entry } from "../journal/entries";
import { Journal } from "../journal/journal";
import { DEFAULT_LIMITS, type Limits } from "../limits";
import { MemoryBlocks } from "./memoryBlocks";

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
