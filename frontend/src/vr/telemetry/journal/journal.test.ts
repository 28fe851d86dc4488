import { describe, expect, it } from "vitest";
import { seeded } from "../testing/frames";
import { ack, entry, filled, MemoryBlocks, opened, SESSION, toSend } from "../testing/journals";
import type { Entry } from "./entries";

describe("a journal", () => {
  it("returns messages in the order in which they were added", async () => {
    const [journal] = await filled(entry("target", 6), entry("actual", 6), entry("reports", 1));
    const all = ["target/1/6", "actual/1/6", "reports/1/1"];
    expect(await toSend(journal)).toEqual(all);
    await journal.flush();
    expect(await toSend(journal)).toEqual(all);
    expect([journal.messages, journal.bytes]).toEqual([3, 30]);
  });

  it("removes what is stored, and nothing else", async () => {
    const [journal] = await filled(entry("target", 10), entry("target", 20), entry("target", 30));
    journal.acknowledge([ack("target", 19), ack("actual", 99), ack("target", 99, 2)]);
    expect(await toSend(journal)).toEqual(["target/1/20", "target/1/30"]);
    expect(journal.bytes).toBe(20);
  });

  it("does not go back when an acknowledgement arrives late", async () => {
    const [journal] = await filled(entry("target", 10), entry("target", 20));
    for (const next of [10, 5, 10]) journal.acknowledge([ack("target", next)]);
    expect(await toSend(journal)).toEqual(["target/1/20"]);
  });

  it("contains what is not stored after any sequence of adding, acknowledging, writing and reloading", async () => {
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

  it("is restored after a reload with the session, the runs and what they had produced", async () => {
    const [journal, store] = await filled(entry("target", 6), entry("reports", 1));
    journal.note({ epoch: 1, produced: { target: 6, reports: 1 } });
    await journal.flush();
    const reopened = await opened(store);
    reopened.add(entry("target", 6, { epoch: 2 }));
    expect(await toSend(reopened)).toEqual(["target/1/6", "reports/1/1", "target/2/6"]);
    expect(reopened.sessionId).toBe(SESSION);
    expect(reopened.runs).toEqual([{ epoch: 1, produced: { target: 6, reports: 1 } }]);
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

describe("the limit of a journal", () => {
  it("makes the producer wait until an acknowledgement makes room", async () => {
    const journal = await opened(new MemoryBlocks(), { journalBytes: 20 });
    journal.add(entry("target", 10));
    expect(journal.isFull).toBe(false);
    journal.add(entry("target", 20));
    expect([journal.isFull, journal.hasRoom]).toEqual([true, false]);
    journal.acknowledge([ack("target", 10)]);
    expect(journal.hasRoom).toBe(true);
  });

  it("is the browser's remaining space minus a reserve, if that is less", async () => {
    const limits = { memoryBytes: 10, quotaReserve: 0.1 };
    let room = 100;
    const journal = await opened(new MemoryBlocks(), limits, async () => room);
    for (let end = 1; end <= 8; end++) {
      journal.add(entry("target", end));
      room -= 10;
      await journal.flush();
    }
    // 80 bytes are stored, and 20 more fit: of those 18 may be used.
    expect(journal.isFull).toBe(false);
    journal.add(entry("target", 9));
    journal.add(entry("target", 10));
    expect(journal.isFull).toBe(true);
    room = 1000;
    await journal.flush();
    expect(journal.isFull).toBe(false);
  });

  it("leaves the memory to use if the browser grants no space", async () => {
    const journal = await opened(new MemoryBlocks(), { memoryBytes: 20 }, async () => 0);
    expect(journal.hasRoom).toBe(true);
  });

  it("keeps memory small: unwritten messages are bounded, written ones have left", async () => {
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
  it("is that of its oldest message, also after a reload", async () => {
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
