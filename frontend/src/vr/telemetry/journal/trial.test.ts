import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { DEFAULT_LIMITS } from "../limits";
import { ack, entry, MemoryBlocks } from "../testing/journals";
import { TrialJournal } from "./trial";

const TICK_MS = DEFAULT_LIMITS.flushEveryS * 1000;

describe("a journal for a test of the device", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  it("writes at a visit's rate what is not acknowledged, times each write, and leaves nothing", async () => {
    const store = new MemoryBlocks();
    const tookS: number[] = [];
    const journal = await TrialJournal.open({ store, onWritten: (s) => tookS.push(s) });
    await vi.advanceTimersByTimeAsync(4 * TICK_MS);
    expect(tookS).toEqual([]);
    journal.add(entry("target", 6));
    journal.add(entry("target", 12));
    journal.acknowledge([ack("target", 6)]);
    await vi.advanceTimersByTimeAsync(TICK_MS);
    expect([...store.entries.values()].flat().map(({ seqEnd }) => seqEnd)).toEqual([12]);
    journal.acknowledge([ack("target", 12)]);
    await vi.advanceTimersByTimeAsync(TICK_MS);
    expect(store.blocks.size).toBe(0);
    expect(tookS).toEqual([0, 0]);
    journal.add(entry("target", 18));
    await journal.close();
    expect([store.blocks.size, store.entries.size, tookS.length]).toEqual([0, 0, 3]);
  });

  it("says why nothing could be written, and counts no such write", async () => {
    const store = new MemoryBlocks();
    let writes = 0;
    const journal = await TrialJournal.open({ store, onWritten: () => writes++ });
    store.failure = new Error("the disk is broken");
    journal.add(entry("target", 6));
    await vi.advanceTimersByTimeAsync(TICK_MS);
    expect([journal.problem, writes]).toEqual(["Error: the disk is broken", 0]);
  });

  it("begins empty, whatever a killed page has left", async () => {
    const store = new MemoryBlocks();
    const killed = await TrialJournal.open({ store, onWritten: () => undefined });
    killed.add(entry("target", 6));
    await vi.advanceTimersByTimeAsync(TICK_MS);
    expect(store.blocks.size).toBe(1);
    await TrialJournal.open({ store, onWritten: () => undefined });
    expect([store.blocks.size, store.sessionId]).toEqual([0, null]);
  });
});
