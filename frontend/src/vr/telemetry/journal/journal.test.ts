import { describe, expect, it } from "vitest";
import { DEFAULT_LIMITS, type Limits } from "../limits";
import { seeded } from "../testing/frames";
import { MemoryBlocks } from "../testing/memoryBlocks";
import type { Entry } from "./entries";
import { Journal } from "./journal";

const SESSION = "session";

function entry(stream: string, seqEnd: number, { epoch = 1, size = 10, madeAtMs = 0 } = {}): Entry {
  return { stream, epoch, seqEnd, message: "x".repeat(size), madeAtMs };
}

async function opened(
  store: MemoryBlocks,
  limits: Partial<Limits> = {},
  room = async () => Number.POSITIVE_INFINITY,
): Promise<Journal> {
  const journal = await Journal.open({ store, limits: { ...DEFAULT_LIMITS, ...limits }, room });
  await journal.claim(SESSION);
  return journal;
}

async function filled(...entries: readonly Entry[]): Promise<[Journal, MemoryBlocks]> {
  const store = new MemoryBlocks();
  const journal = await opened(store);
  for (const one of entries) journal.add(one);
  return [journal, store];
}

/** Everything that would be sent now, from the front. */
async function toSend(journal: Journal): Promise<readonly string[]> {
  journal.reader.rewind();
  const found: string[] = [];
  for (;;) {
    const next = await journal.reader.next();
    if (next === null) return found;
    found.push(`${next.stream}/${next.epoch}/${next.seqEnd}`);
  }
}

const ack = (stream: string, next_seq: number, epoch = 1) => ({ stream, epoch, next_seq });

describe("a journal", () => {
  it("gives messages back in the order in which they came", async () => {
    const [journal] = await filled(entry("target", 6), entry("actual", 6), entry("reports", 1));
    const all = ["target/1/6", "actual/1/6", "reports/1/1"];
    expect(await toSend(journal)).toEqual(all);
    await journal.flush();
    expect(await toSend(journal)).toEqual(all);
    expect([journal.messages, journal.bytes]).toEqual([3, 30]);
  });

  it("lets go of what is stored, and of nothing else", async () => {
    const [journal] = await filled(entry("target", 10), entry("target", 20), entry("target", 30));
    journal.acknowledge([ack("target", 19), ack("actual", 99), ack("target", 99, 2)]);
    expect(await toSend(journal)).toEqual(["target/1/20", "target/1/30"]);
    expect(journal.bytes).toBe(20);
  });

  it("is not taken back by an acknowledgement that comes late", async () => {
    const [journal] = await filled(entry("target", 10), entry("target", 20));
    for (const next of [10, 5, 10]) journal.acknowledge([ack("target", next)]);
    expect(await toSend(journal)).toEqual(["target/1/20"]);
  });

  it("holds after any adding, acknowledging, writing and reloading what is not stored", async () => {
    const random = seeded(3);
    for (let round = 0; round < 40; round++) {
      const store = new MemoryBlocks();
      const limits = { blockBytes: 30, blocksAhead: 1 + (random() % 3) };
      let journal = await opened(store, limits);
      const made: Entry[] = [];
      const ends = { a: 0, b: 0 };
      const stored = { a: 0, b: 0 };
      for (let step = 0; step < 60; step++) {
        const stream = random() % 2 === 0 ? "a" : "b";
        const choice = random() % 10;
        if (choice < 5) {
          ends[stream] += 1 + (random() % 5);
          made.push(entry(stream, ends[stream], { size: 1 + (random() % 20) }));
          journal.add(made.at(-1) as Entry);
        } else if (choice < 7) {
          stored[stream] = Math.max(stored[stream], random() % (ends[stream] + 1));
          journal.acknowledge([ack(stream, stored[stream])]);
        } else if (choice < 8) void journal.tidy();
        else if (choice < 9) await journal.flush();
        else {
          await journal.flush();
          journal = await opened(store, limits);
        }
      }
      journal.acknowledge([ack("a", stored.a), ack("b", stored.b)]);
      const open = made.filter(({ stream, seqEnd }) => seqEnd > stored[stream as "a" | "b"]);
      expect(await toSend(journal)).toEqual(open.map((one) => `${one.stream}/1/${one.seqEnd}`));
      await journal.flush();
      expect(await toSend(journal)).toEqual(open.map((one) => `${one.stream}/1/${one.seqEnd}`));
    }
  });

  it("comes back after a reload with the session, the runs and what they had produced", async () => {
    const [journal, store] = await filled(entry("target", 6), entry("reports", 1));
    journal.note({ epoch: 1, produced: { target: 6, reports: 1 } });
    await journal.flush();
    const again = await opened(store);
    again.add(entry("target", 6, { epoch: 2 }));
    expect(await toSend(again)).toEqual(["target/1/6", "reports/1/1", "target/2/6"]);
    expect(again.sessionId).toBe(SESSION);
    expect(again.runs).toEqual([{ epoch: 1, produced: { target: 6, reports: 1 } }]);
  });

  it("does not mix sessions, and forgets a session that has nothing left", async () => {
    const [journal, store] = await filled(entry("target", 6));
    journal.note({ epoch: 1, produced: { target: 6 } });
    await journal.flush();
    expect(await (await opened(store)).claim("another")).toBe(false);
    journal.acknowledge([ack("target", 6)]);
    expect(await journal.claim("another")).toBe(true);
    expect(journal.runs).toEqual([]);
  });
});

describe("the disk of a journal", () => {
  it("takes many messages in one write, and those that were acknowledged before not at all", async () => {
    const [journal, store] = await filled(...[6, 12, 18, 24].map((end) => entry("target", end)));
    journal.acknowledge([ack("target", 12)]);
    await journal.flush();
    expect(store.writes).toBe(1);
    expect([...store.entries.values()].flat().map(({ seqEnd }) => seqEnd)).toEqual([18, 24]);
  });

  it("is not touched when there is nothing to do", async () => {
    const [journal, store] = await filled(entry("target", 6));
    journal.acknowledge([ack("target", 6)]);
    await journal.flush();
    await journal.flush();
    expect(store.writes).toBe(1);
    expect(store.blocks.size).toBe(0);
  });

  it("is emptied by the write after the acknowledgement", async () => {
    const [journal, store] = await filled(entry("target", 6), entry("target", 12));
    await journal.flush();
    journal.acknowledge([ack("target", 12)]);
    expect(store.blocks.size).toBe(1);
    await journal.flush();
    expect([store.blocks.size, store.entries.size, journal.messages]).toEqual([0, 0, 0]);
  });

  it("keeps a block until all of it is stored, and sends only what is not", async () => {
    const [journal] = await filled(entry("target", 6), entry("actual", 6), entry("target", 12));
    await journal.flush();
    journal.acknowledge([ack("target", 12)]);
    expect(journal.messages).toBe(3);
    expect(await toSend(journal)).toEqual(["actual/1/6"]);
  });

  it("is written to as soon as much has gathered, without waiting for the time", async () => {
    const store = new MemoryBlocks();
    const journal = await opened(store, { flushBytes: 100 });
    for (let end = 1; end <= 10; end++) journal.add(entry("target", end));
    await journal.tidy();
    expect(store.writes).toBe(1);
  });

  it("fails: nothing is lost, the memory stays bounded, and it goes on when it works again", async () => {
    const store = new MemoryBlocks();
    const journal = await opened(store, { memoryBytes: 25 });
    store.failure = new Error("the disk is broken");
    journal.add(entry("target", 1));
    await journal.flush();
    expect(journal.problem).toBe("Error: the disk is broken");
    expect(journal.hasRoom).toBe(true);
    for (const end of [2, 3]) journal.add(entry("target", end));
    expect([journal.hasRoom, journal.isFull]).toEqual([false, true]);
    store.failure = null;
    await journal.flush();
    expect([journal.hasRoom, journal.isFull, journal.problem]).toEqual([true, false, null]);
    expect(await toSend(journal)).toEqual(["target/1/1", "target/1/2", "target/1/3"]);
  });

  it("is full: what is acknowledged is still deleted, which makes room", async () => {
    const [journal, store] = await filled(entry("target", 1));
    await journal.flush();
    store.isFull = new DOMException("no space", "QuotaExceededError");
    journal.add(entry("target", 2));
    journal.acknowledge([ack("target", 1)]);
    await journal.flush();
    expect(journal.problem).toContain("QuotaExceededError");
    expect(store.blocks.size).toBe(0);
    expect(await toSend(journal)).toEqual(["target/1/2"]);
  });

  it("has lost a block: that is said, not passed over", async () => {
    const [journal, store] = await filled(entry("target", 1), entry("target", 2));
    await journal.flush();
    store.entries.clear();
    await expect(toSend(journal)).rejects.toThrow("lost 2 messages");
  });
});

describe("the limit of a journal", () => {
  it("holds the producer until an acknowledgement makes room", async () => {
    const journal = await opened(new MemoryBlocks(), { journalBytes: 20 });
    journal.add(entry("target", 10));
    expect(journal.isFull).toBe(false);
    journal.add(entry("target", 20));
    expect([journal.isFull, journal.hasRoom]).toEqual([true, false]);
    journal.acknowledge([ack("target", 10)]);
    expect(journal.hasRoom).toBe(true);
  });

  it("is what the browser still gives, less a reserve, where that is less", async () => {
    const limits = { memoryBytes: 10, quotaReserve: 0.1 };
    let room = 100;
    const journal = await opened(new MemoryBlocks(), limits, async () => room);
    for (let end = 1; end <= 8; end++) {
      journal.add(entry("target", end));
      room -= 10;
      await journal.flush();
    }
    // 80 bytes are held, and 20 more fit: of those 18 may be used.
    expect(journal.isFull).toBe(false);
    journal.add(entry("target", 9));
    journal.add(entry("target", 10));
    expect(journal.isFull).toBe(true);
    room = 1000;
    await journal.flush();
    expect(journal.isFull).toBe(false);
  });

  it("leaves the memory where the browser gives nothing", async () => {
    const journal = await opened(new MemoryBlocks(), { memoryBytes: 20 }, async () => 0);
    expect(journal.hasRoom).toBe(true);
  });

  it("keeps the memory small: what is not written yet is bounded, what is written has left", async () => {
    const store = new MemoryBlocks();
    const journal = await opened(store, { memoryBytes: 50, flushBytes: 1000 });
    for (let end = 1; end <= 5; end++) journal.add(entry("target", end));
    expect([journal.hasRoom, journal.isFull]).toEqual([false, false]);
    await journal.tidy();
    expect(journal.hasRoom).toBe(true);
  });
});

describe("reports", () => {
  it("are settled when those of every run are stored", async () => {
    const [journal] = await filled(
      entry("reports", 3, { epoch: 1 }),
      entry("target", 6, { epoch: 2 }),
      entry("reports", 1, { epoch: 2 }),
    );
    journal.acknowledge([ack("reports", 1, 2)]);
    expect(journal.isSettled("reports")).toBe(false);
    journal.acknowledge([ack("reports", 3, 1)]);
    expect(journal.isSettled("reports")).toBe(true);
  });
});

describe("the age of a journal", () => {
  it("is that of its oldest message, over a reload too", async () => {
    const [journal, store] = await filled(
      entry("target", 1, { madeAtMs: 1000 }),
      entry("target", 2, { madeAtMs: 2000 }),
    );
    expect(journal.oldestMs).toBe(1000);
    await journal.flush();
    expect((await opened(store)).oldestMs).toBe(1000);
    journal.acknowledge([ack("target", 2)]);
    expect(journal.oldestMs).toBe(null);
  });
});
