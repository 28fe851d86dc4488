import "fake-indexeddb/auto";
import { uuid } from "@shared/uuid";
import { beforeEach, describe, expect, it } from "vitest";
import type { Entry, NewBlock } from "./entries";
import { packed } from "./entries";
import { deleteJournal, IndexedDbBlocks, leftJournals } from "./indexedDb";

const RUN = { epoch: 1, produced: { target: 12 } };
const NONE = { forgetBelow: 0, added: [], runs: [] };
let name: string;
let store: IndexedDbBlocks;

beforeEach(async () => {
  name = uuid();
  store = await IndexedDbBlocks.open(name, "relaxed");
});

function blocks(count: number, firstPlace = 0): readonly NewBlock[] {
  const entries = Array.from({ length: count }, (_, at): Entry => {
    const message = Uint8Array.of(1, 2, at);
    return { stream: "target", epoch: 1, seqEnd: firstPlace + at + 1, message, madeAtMs: 5 };
  });
  return packed(entries, firstPlace, 3);
}

describe("blocks in IndexedDB", () => {
  it("are restored after a reload of the page, byte by byte", async () => {
    const added = blocks(3);
    await store.write({ ...NONE, sessionId: "s", added, runs: [RUN] });
    store.close();
    const reopened = await IndexedDbBlocks.open(name, "relaxed");
    const stored = { sessionId: "s", runs: [RUN], blocks: added.map(({ block }) => block) };
    expect(await reopened.load()).toEqual(stored);
    expect(await reopened.read([1, 2])).toEqual(added.slice(1).map(({ entries }) => entries));
  });

  it("are deleted below a place, and then reported as missing", async () => {
    await store.write({ ...NONE, sessionId: "s", added: blocks(3) });
    await store.write({ ...NONE, sessionId: "s", forgetBelow: 2, added: blocks(1, 3) });
    expect((await store.load()).blocks.map(({ place }) => place)).toEqual([2, 3]);
    expect((await store.read([1, 2])).map((found) => found?.length ?? null)).toEqual([null, 1]);
  });

  it("are deleted by clearing, with the runs and the session", async () => {
    await store.write({ ...NONE, sessionId: "s", added: blocks(1), runs: [RUN] });
    await store.clear();
    expect(await store.load()).toEqual({ sessionId: null, runs: [], blocks: [] });
  });

  it("are written all or not at all", async () => {
    const [good] = blocks(1);
    const bad = { block: { ...blocks(2)[1]?.block, place: Number.NaN }, entries: [] };
    const added = [good, bad] as unknown as readonly NewBlock[];
    await expect(store.write({ ...NONE, sessionId: "s", added })).rejects.toThrow();
    expect((await store.load()).blocks).toEqual([]);
  });

  it("are found when a session left them behind", async () => {
    await store.write({ ...NONE, sessionId: "s", added: blocks(3) });
    const empty = await IndexedDbBlocks.open(uuid(), "relaxed");
    await empty.write({ ...NONE, sessionId: "other" });
    const left = { storageKey: name, sessionId: "s", messages: 3, bytes: 9 };
    expect((await leftJournals()).filter((one) => one.storageKey === name)).toEqual([left]);
    expect((await leftJournals()).some((one) => one.sessionId === "other")).toBe(false);
    store.close();
    await deleteJournal(name);
    expect((await leftJournals()).some((one) => one.storageKey === name)).toBe(false);
  });
});
