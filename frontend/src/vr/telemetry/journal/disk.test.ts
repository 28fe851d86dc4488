import { describe, expect, it } from "vitest";
import { ack, entry, filled, MemoryBlocks, opened, toSend } from "../testing/journals";

describe("the disk of a journal", () => {
  it("takes many messages in one write, without those that were acknowledged before", async () => {
    const [journal, store] = await filled(...[6, 12, 18, 24].map((end) => entry("target", end)));
    journal.acknowledge([ack("target", 12)]);
    await journal.flush();
    expect(store.writes).toBe(1);
    expect([...store.entries.values()].flat().map(({ seqEnd }) => seqEnd)).toEqual([18, 24]);
  });

  it("deletes what was acknowledged during a write, and loses nothing that was added meanwhile", async () => {
    const [journal] = await filled(entry("target", 6), entry("target", 12), entry("target", 18));
    const writing = journal.tidy();
    journal.acknowledge([ack("target", 6)]);
    journal.add(entry("target", 24));
    await writing;
    journal.add(entry("target", 30));
    const rest = ["target/1/12", "target/1/18", "target/1/24", "target/1/30"];
    expect(await toSend(journal)).toEqual(rest);
    await journal.flush();
    expect(await toSend(journal)).toEqual(rest);
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

  it("keeps a block until all of it is stored, and only the rest of it is sent", async () => {
    const [journal] = await filled(entry("target", 6), entry("actual", 6), entry("target", 12));
    await journal.flush();
    journal.acknowledge([ack("target", 12)]);
    expect(journal.messages).toBe(3);
    expect(await toSend(journal)).toEqual(["actual/1/6"]);
  });

  it("is written to as soon as enough has accumulated, without waiting for the timer", async () => {
    const store = new MemoryBlocks();
    const journal = await opened(store, { flushBytes: 100 });
    for (let end = 1; end <= 10; end++) journal.add(entry("target", end));
    await journal.tidy();
    expect(store.writes).toBe(1);
  });

  it("may fail: nothing is lost, memory stays bounded, and writing resumes when it works again", async () => {
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

  it("may be full: what is acknowledged is still deleted, which makes room", async () => {
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

  it("may lose a block: that is reported, not ignored", async () => {
    const [journal, store] = await filled(entry("target", 1), entry("target", 2));
    await journal.flush();
    store.entries.clear();
    await expect(toSend(journal)).rejects.toThrow("lost 2 messages");
  });
});
