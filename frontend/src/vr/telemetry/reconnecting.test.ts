import { describe, expect, it } from "vitest";
import { standing } from "./testing/frames";
import { MemoryBlocks } from "./testing/journals";
import { eventually, produce, seqs, testBed } from "./testing/rig";
import { batchBytes } from "./wire/batch";

const bed = testBed();

describe("a connection that breaks", () => {
  it("is restored as the same run, and what was not stored is resent, once", async () => {
    const telemetry = await bed.opened();
    bed.server.acknowledges = false;
    await produce(telemetry, 5);
    bed.server.breaks();
    await eventually(() => !telemetry.status.connected);
    await produce(telemetry, 5);
    bed.server.acknowledges = true;
    await telemetry.drained();
    expect(bed.server.of("hello").at(-1)?.epoch).toBe(1);
    expect(bed.server.storedOf("target", 1)).toEqual(seqs("target", 1, 60));
    expect(bed.server.storedOf("reports", 1)).toEqual(seqs("reports", 1, 2));
  });

  it("is retried until the server answers", async () => {
    const telemetry = await bed.opened();
    bed.server.goesDown();
    await eventually(() => bed.server.sockets.length > 5);
    bed.server.isUp = true;
    await eventually(() => telemetry.status.connected);
  });

  it("costs no memory: waiting messages are on disk and are read from there in order", async () => {
    const disk = new MemoryBlocks();
    const telemetry = await bed.opened(disk, { blockBytes: 5000, memoryBytes: 20_000 });
    bed.server.goesDown();
    await produce(telemetry, 50);
    await telemetry.flush();
    expect([...disk.entries.values()].flat()).toHaveLength(101);
    bed.server.isUp = true;
    await telemetry.drained();
    expect(bed.server.storedOf("target", 1)).toEqual(seqs("target", 1, 300));
  });

  it("is recognised by its silence", async () => {
    const telemetry = await bed.opened(undefined, { silenceS: 0.05, probeEveryS: 0.01 });
    bed.server.answersProbes = false;
    await eventually(() => bed.server.sockets.length > 1);
    bed.server.answersProbes = true;
    await eventually(() => telemetry.status.connected);
  });

  it("does not fill the browser's memory when the network takes nothing", async () => {
    const telemetry = await bed.opened(undefined, { bufferedBytes: 10_000 });
    bed.server.socket.isStuck = true;
    await produce(telemetry, 50);
    await telemetry.flush();
    expect(bed.server.socket.bufferedAmount).toBeLessThan(10_000 + batchBytes(6));
    bed.server.breaks();
    await telemetry.drained();
    expect(bed.server.storedOf("actual", 1)).toEqual(seqs("actual", 1, 300));
    expect(bed.server.resends, "what the network lost was left out at first").toBe(0);
  });
});

describe("the browser's disk", () => {
  it("only delays the sending when it cannot be read for a moment", async () => {
    const disk = new MemoryBlocks();
    const telemetry = await bed.opened(disk);
    bed.server.goesDown();
    await produce(telemetry, 5);
    await telemetry.flush();
    disk.unreadable = new DOMException("not now", "UnknownError");
    bed.server.isUp = true;
    await eventually(() => disk.failedReads > 0);
    expect(telemetry.status.failure).toBe(null);
    disk.unreadable = null;
    await telemetry.drained();
    expect(bed.server.storedOf("target", 1)).toEqual(seqs("target", 1, 30));
  });

  it("is reported as a failure with a remedy when it has lost the journal", async () => {
    const disk = new MemoryBlocks();
    const telemetry = await bed.opened(disk);
    bed.server.goesDown();
    await produce(telemetry, 5);
    await telemetry.flush();
    disk.entries.clear();
    bed.server.isUp = true;
    await expect(telemetry.drained()).rejects.toThrow("lost 11 messages");
    expect(telemetry.status.failure?.code).toBe("journal_lost");
  });
});

describe("a gap", () => {
  it("is filled from the journal", async () => {
    const telemetry = await bed.opened();
    bed.server.acknowledges = false;
    await produce(telemetry, 4);
    await eventually(() => bed.server.storedOf("reports", 1).length === 1);
    bed.server.positions.set("target/1", 6);
    bed.server.broadcast({ type: "resend", stream: "target", epoch: 1, next_seq: 6 });
    bed.server.acknowledges = true;
    await telemetry.drained();
    expect(bed.server.positions.get("target/1")).toBe(24);
  });

  it("that the journal cannot fill is a failure, not an endless loop", async () => {
    const telemetry = await bed.opened();
    await produce(telemetry, 4);
    await telemetry.drained();
    bed.server.positions.set("target/1", 6);
    const sending = setInterval(() => {
      telemetry.sendFrames("target", standing(1)).catch(() => clearInterval(sending));
    }, 1);
    await eventually(() => telemetry.status.failure !== null);
    expect(telemetry.status.failure?.code).toBe("lost_on_the_server");
  });
});
