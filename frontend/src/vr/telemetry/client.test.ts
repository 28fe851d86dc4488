import { describe, expect, it } from "vitest";
import type { Level, Status } from "./client";
import { FakeServer, stateOf } from "./testing/fakeServer";
import { standing } from "./testing/frames";
import { MemoryBlocks } from "./testing/journals";
import {
  eventually,
  MATERIALISED,
  openedClient,
  produce,
  seqs,
  startedClient,
  testBed,
} from "./testing/rig";
import { batchBytes } from "./wire/batch";

const bed = testBed();

describe("a client", () => {
  it("sends hello, takes its epoch, and offers the token as a subprotocol", async () => {
    const telemetry = await bed.opened();
    expect(bed.server.received[0]).toEqual({
      type: "hello",
      protocol: 1,
      client: "test",
      epoch: null,
    });
    expect(bed.server.socket.protocols).toEqual(["reembody.v1", "bearer.TOKEN"]);
    expect([telemetry.epoch, telemetry.state.version]).toEqual([1, 1]);
    expect(telemetry.status.connected).toBe(true);
  });

  it("numbers frames and reports from 0, and is drained when all of them are stored", async () => {
    const telemetry = await bed.opened();
    await produce(telemetry, 10);
    await telemetry.drained();
    for (const stream of ["target", "actual"])
      expect(bed.server.storedOf(stream, 1)).toEqual(seqs(stream, 1, 60));
    expect(bed.server.storedOf("reports", 1)).toEqual(seqs("reports", 1, 1));
    expect([telemetry.status.journaledMessages, telemetry.settled]).toEqual([0, true]);
  });

  it("keeps the order of calls that are not awaited", async () => {
    const telemetry = await bed.opened();
    const sending = [
      telemetry.sendFrames("target", standing(6)),
      telemetry.report(MATERIALISED),
      telemetry.sendFrames("target", standing(3)),
    ];
    await Promise.all(sending);
    await telemetry.drained();
    expect(bed.server.stored).toEqual([
      ...seqs("target", 1, 6),
      "reports/1/0",
      ...seqs("target", 1, 9).slice(6),
    ]);
  });

  it("reports new states and the server's notices about its data", async () => {
    const telemetry = await bed.opened();
    const versions: number[] = [];
    const notices: string[] = [];
    telemetry.onState((state) => versions.push(state.version));
    telemetry.onNotice((notice) => notices.push(notice.type));
    bed.server.broadcast(stateOf(2));
    bed.server.broadcast({ type: "refused", epoch: 1, seq: 0, message: "m", remedy: "r" });
    bed.server.broadcast({ type: "weather", message: "a newer server says more" });
    bed.server.broadcast(stateOf(3));
    await eventually(() => versions.length === 2);
    expect([versions, notices, telemetry.state.version]).toEqual([[2, 3], ["refused"], 3]);
  });

  it("is not settled while a report of it is under way", async () => {
    const telemetry = await bed.opened();
    bed.server.acknowledges = false;
    await telemetry.report(MATERIALISED);
    expect(telemetry.settled).toBe(false);
    await eventually(() => bed.server.stored.length === 1);
    expect(telemetry.settled).toBe(false);
    bed.server.acknowledge();
    await eventually(() => telemetry.settled);
  });

  it("rejects what the server would reject, and reuses the number", async () => {
    const telemetry = await bed.opened();
    await expect(telemetry.report({ kind: "materialised", t_s: Number.NaN })).rejects.toThrow(
      "t_s",
    );
    const broken = { ...standing(6), activeS: Number.NaN };
    await expect(telemetry.sendFrames("target", broken)).rejects.toThrow("active_s");
    await expect(telemetry.sendFrames("target", standing(513))).rejects.toThrow("at most 512");
    await produce(telemetry, 1);
    await telemetry.drained();
    expect(bed.server.stored).toHaveLength(13);
  });
});

describe("a full journal", () => {
  it("makes the producer wait, reports it, and lets it continue; nothing is lost", async () => {
    const telemetry = await bed.opened(undefined, { journalBytes: 10 * batchBytes(6) });
    const levels = new Set<Level>();
    telemetry.onStatus((status: Status) => levels.add(status.level));
    bed.server.goesDown();
    const producing = produce(telemetry, 20);
    await eventually(() => telemetry.status.level === "full");
    expect(telemetry.status.waitingCalls).toBe(1);
    bed.server.isUp = true;
    await producing;
    await telemetry.drained();
    expect(levels).toContain("full");
    expect(telemetry.status.level).toBe("clear");
    expect(bed.server.storedOf("target", 1)).toEqual(seqs("target", 1, 120));
  });

  it("counts waiting messages as produced, and announces them to the server", async () => {
    const disk = new MemoryBlocks();
    const telemetry = await bed.opened(disk, { journalBytes: 1 });
    bed.server.acknowledges = false;
    await telemetry.sendFrames("target", standing(6));
    void telemetry.sendFrames("target", standing(6)).catch(() => undefined);
    await eventually(() => bed.server.of("produced").at(-1)?.streams !== undefined);
    await eventually(() =>
      JSON.stringify(bed.server.of("produced").at(-1)).includes('"target":12'),
    );
  });

  it("lets no call wait forever: a failure rejects it, and so does closing", async () => {
    const telemetry = await bed.opened(undefined, { journalBytes: 1 });
    bed.server.acknowledges = false;
    await telemetry.sendFrames("target", standing(6));
    const refused = telemetry.sendFrames("target", standing(6));
    bed.server.socket.breaks(4401, "replaced");
    await expect(refused).rejects.toThrow("replaced");
    const other = await openedClient(new FakeServer(), new MemoryBlocks(), { memoryBytes: 1 });
    await other.sendFrames("target", standing(6));
    const closed = other.sendFrames("target", standing(6));
    void other.close();
    await expect(closed).rejects.toThrow("closed");
  });

  it("is preceded by the level `behind`", async () => {
    const telemetry = await bed.opened(undefined, { behindAfterS: 0.01 });
    bed.server.acknowledges = false;
    await telemetry.sendFrames("target", standing(6));
    await eventually(() => telemetry.status.level === "behind");
    expect(telemetry.status.oldestUnackedS).toBeGreaterThan(0.01);
  });
});

describe("closing", () => {
  it("announces how far the run has come, and leaves the rest in the journal", async () => {
    const disk = new MemoryBlocks();
    const telemetry = await bed.opened(disk, { producedEveryS: 60 });
    bed.server.acknowledges = false;
    await produce(telemetry, 2);
    await telemetry.close();
    expect(bed.server.of("produced").at(-1)).toMatchObject({ streams: { target: 12, actual: 12 } });
    expect([...disk.entries.values()].flat()).toHaveLength(5);
    await expect(telemetry.report(MATERIALISED)).rejects.toThrow("closed");
  });

  it("ends the wait for an unreachable server", async () => {
    bed.server.isUp = false;
    bed.client = await startedClient(bed.server);
    const opening = bed.client.opened();
    await bed.client.close();
    await expect(opening).rejects.toThrow("closed");
  });
});
