import { describe, expect, it } from "vitest";
import type { DirectClient } from "./directClient";
import { MemoryBlocks } from "./testing/journals";
import { eventually, openedClient, produce, seqs, startedClient, testBed } from "./testing/rig";

const bed = testBed();

/** Kill the page without warning: none of its timers runs, none of its sockets is open. */
async function killed(victim: DirectClient): Promise<void> {
  bed.server.acknowledges = false;
  await victim.close();
  bed.server.acknowledges = true;
}

/** What a run leaves on this disk that produced five reports while the server was away. */
async function interrupted(disk: MemoryBlocks): Promise<void> {
  const first = await openedClient(bed.server, disk);
  bed.server.goesDown();
  await produce(first, 5);
  await killed(first);
  bed.server.isUp = true;
}

describe("a page that restarts", () => {
  it("delivers the previous run's messages under their own epoch, then its own", async () => {
    const disk = new MemoryBlocks();
    await interrupted(disk);
    const second = await bed.opened(disk);
    expect(second.epoch).toBe(2);
    expect(second.settled).toBe(false);
    await produce(second, 2);
    await second.drained();
    expect(bed.server.stored).toEqual(
      [...bed.server.stored].sort((a, b) => epochOf(a) - epochOf(b)),
    );
    expect(bed.server.storedOf("target", 1)).toEqual(seqs("target", 1, 30));
    expect(bed.server.storedOf("target", 2)).toEqual(seqs("target", 2, 12));
    expect(second.settled).toBe(true);
  });

  it("announces how much each run had produced, right after the welcome", async () => {
    const disk = new MemoryBlocks();
    await interrupted(disk);
    bed.server.received.length = 0;
    const second = await bed.opened(disk, { producedEveryS: 0.2 });
    await new Promise((resolve) => setTimeout(resolve, 10));
    const streams = { target: 30, actual: 30, reports: 1 };
    expect(bed.server.of("produced")[0]).toEqual({ type: "produced", epoch: 1, streams });
    await produce(second, 1);
    await eventually(() => bed.server.of("produced").some(({ epoch }) => epoch === 2));
  });

  it("does not deliver one session's frames to another", async () => {
    const disk = new MemoryBlocks();
    const first = await openedClient(bed.server, disk);
    bed.server.goesDown();
    await produce(first, 1);
    await killed(first);
    Object.assign(bed.server, { isUp: true, sessionId: "another" });
    const second = await startedClient(bed.server, disk);
    await expect(second.opened()).rejects.toThrow("session session has not delivered");
    await second.close();
    expect(bed.server.stored).toEqual([]);
    expect(disk.entries.size).toBeGreaterThan(0);
  });
});

const epochOf = (stored: string): number => Number(stored.split("/")[1]);
