import { afterEach, beforeEach, describe, expect, it } from "vitest";
import type { DirectClient } from "./directClient";
import type { Limits } from "./limits";
import { FakeServer } from "./testing/fakeServer";
import { MemoryBlocks } from "./testing/memoryBlocks";
import { eventually, openedClient, produce, seqs, startedClient } from "./testing/rig";

let server: FakeServer;
let client: DirectClient | null;

beforeEach(() => {
  server = new FakeServer();
  client = null;
});

afterEach(async () => {
  await client?.close();
});

async function opened(
  ...more: [disk?: MemoryBlocks, limits?: Partial<Limits>]
): Promise<DirectClient> {
  client = await openedClient(server, ...more);
  return client;
}

/** The page is gone from one moment to the next: no timer of it runs, no socket is open. */
async function killed(victim: DirectClient): Promise<void> {
  server.acknowledges = false;
  await victim.close();
  server.acknowledges = true;
}

describe("a page that starts again", () => {
  it("delivers what the one before left under its own number, then its own", async () => {
    const disk = new MemoryBlocks();
    const first = await openedClient(server, disk);
    server.isUp = false;
    server.breaks();
    await produce(first, 5);
    await killed(first);
    server.isUp = true;
    const second = await opened(disk);
    expect(second.epoch).toBe(2);
    expect(second.settled).toBe(false);
    await produce(second, 2);
    await second.drained();
    expect(server.stored).toEqual([...server.stored].sort((a, b) => epochOf(a) - epochOf(b)));
    expect(server.storedOf("target", 1)).toEqual(seqs("target", 1, 30));
    expect(server.storedOf("target", 2)).toEqual(seqs("target", 2, 12));
    expect(second.settled).toBe(true);
  });

  it("tells how far each run had come, right after the welcome", async () => {
    const disk = new MemoryBlocks();
    const first = await openedClient(server, disk);
    server.isUp = false;
    server.breaks();
    await produce(first, 5);
    await killed(first);
    server.isUp = true;
    server.heard.length = 0;
    const second = await opened(disk, { producedEveryS: 0.2 });
    await new Promise((resolve) => setTimeout(resolve, 10));
    const streams = { target: 30, actual: 30, reports: 1 };
    expect(server.of("produced")[0]).toEqual({ type: "produced", epoch: 1, streams });
    await produce(second, 1);
    await eventually(() => server.of("produced").some(({ epoch }) => epoch === 2));
  });

  it("does not deliver one session's frames to another", async () => {
    const disk = new MemoryBlocks();
    const first = await openedClient(server, disk);
    server.isUp = false;
    server.breaks();
    await produce(first, 1);
    await killed(first);
    Object.assign(server, { isUp: true, sessionId: "another" });
    const second = await startedClient(server, disk);
    await expect(second.opened()).rejects.toThrow("session session has not delivered");
    await second.close();
    expect(server.stored).toEqual([]);
    expect(disk.entries.size).toBeGreaterThan(0);
  });
});

const epochOf = (stored: string): number => Number(stored.split("/")[1]);
