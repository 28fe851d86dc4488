import { afterEach, beforeEach, describe, expect, it } from "vitest";
import type { Level, Status } from "./client";
import type { DirectClient } from "./directClient";
import { FakeServer, stateOf } from "./testing/fakeServer";
import { standing } from "./testing/frames";
import { MemoryBlocks } from "./testing/memoryBlocks";
import { eventually, openedClient, startedClient } from "./testing/rig";
import { batchBytes } from "./wire/batch";

const MATERIALISED = { kind: "materialised", t_s: 1 } as const;
let server: FakeServer;
let client: DirectClient | null;

beforeEach(() => {
  server = new FakeServer();
  client = null;
});

afterEach(async () => {
  await client?.close();
});

async function opened(...more: [disk?: MemoryBlocks, limits?: object]): Promise<DirectClient> {
  client = await openedClient(server, ...more);
  return client;
}

/** So many batches of six frames of each stream, and a report after them. */
async function produce(producer: DirectClient, batches: number): Promise<void> {
  for (let batch = 0; batch < batches; batch++) {
    await producer.sendFrames("target", standing(6));
    await producer.sendFrames("actual", standing(6));
  }
  await producer.report(MATERIALISED);
}

/** The page is gone from one moment to the next: no timer of it runs, no socket is open. */
async function killed(victim: DirectClient): Promise<void> {
  server.acknowledges = false;
  await victim.close();
  server.acknowledges = true;
}

const seqs = (stream: string, epoch: number, count: number): readonly string[] =>
  Array.from({ length: count }, (_, seq) => `${stream}/${epoch}/${seq}`);
const storedOf = (stream: string, epoch: number): readonly string[] =>
  server.stored.filter((one) => one.startsWith(`${stream}/${epoch}/`));

describe("a client", () => {
  it("greets, takes its number, and offers the token as a subprotocol", async () => {
    const telemetry = await opened();
    expect(server.heard[0]).toEqual({ type: "hello", protocol: 1, client: "test", epoch: null });
    expect(server.socket.protocols).toEqual(["reembody.v1", "bearer.TOKEN"]);
    expect([telemetry.epoch, telemetry.state.version]).toEqual([1, 1]);
    expect(telemetry.status.connected).toBe(true);
  });

  it("numbers frames and reports from 0, and is drained when all of them are stored", async () => {
    const telemetry = await opened();
    await produce(telemetry, 10);
    await telemetry.drained();
    for (const stream of ["target", "actual"])
      expect(storedOf(stream, 1)).toEqual(seqs(stream, 1, 60));
    expect(storedOf("reports", 1)).toEqual(seqs("reports", 1, 1));
    expect([telemetry.status.journaledMessages, telemetry.settled]).toEqual([0, true]);
  });

  it("keeps the order of calls that nobody waits for", async () => {
    const telemetry = await opened();
    const sending = [
      telemetry.sendFrames("target", standing(6)),
      telemetry.report(MATERIALISED),
      telemetry.sendFrames("target", standing(3)),
    ];
    await Promise.all(sending);
    await telemetry.drained();
    expect(server.stored).toEqual([
      ...seqs("target", 1, 6),
      "reports/1/0",
      ...seqs("target", 1, 9).slice(6),
    ]);
  });

  it("tells new states and what the server says of its data", async () => {
    const telemetry = await opened();
    const versions: number[] = [];
    const notices: string[] = [];
    telemetry.onState((state) => versions.push(state.version));
    telemetry.onNotice((notice) => notices.push(notice.type));
    server.say(stateOf(2));
    server.say({ type: "refused", epoch: 1, seq: 0, message: "m", remedy: "r" });
    server.say({ type: "weather", message: "a newer server says more" });
    server.say(stateOf(3));
    await eventually(() => versions.length === 2);
    expect([versions, notices, telemetry.state.version]).toEqual([[2, 3], ["refused"], 3]);
  });

  it("is not settled while a report of it is under way", async () => {
    const telemetry = await opened();
    server.acknowledges = false;
    await telemetry.report(MATERIALISED);
    expect(telemetry.settled).toBe(false);
    await eventually(() => server.stored.length === 1);
    expect(telemetry.settled).toBe(false);
    server.acknowledge();
    await eventually(() => telemetry.settled);
  });

  it("refuses what the server would refuse, and goes on with the same number", async () => {
    const telemetry = await opened();
    await expect(telemetry.report({ kind: "materialised", t_s: Number.NaN })).rejects.toThrow(
      "t_s",
    );
    const broken = { ...standing(6), activeS: Number.NaN };
    await expect(telemetry.sendFrames("target", broken)).rejects.toThrow("active_s");
    await expect(telemetry.sendFrames("target", standing(513))).rejects.toThrow("at most 512");
    await produce(telemetry, 1);
    await telemetry.drained();
    expect(server.stored).toHaveLength(13);
  });
});

describe("a connection that breaks", () => {
  it("comes back as the same run, and what was not stored is sent again, once", async () => {
    const telemetry = await opened();
    server.acknowledges = false;
    await produce(telemetry, 5);
    server.breaks();
    await eventually(() => !telemetry.status.connected);
    await produce(telemetry, 5);
    server.acknowledges = true;
    await telemetry.drained();
    expect(server.of("hello").at(-1)?.epoch).toBe(1);
    expect(storedOf("target", 1)).toEqual(seqs("target", 1, 60));
    expect(storedOf("reports", 1)).toEqual(seqs("reports", 1, 2));
  });

  it("is tried again and again while nobody answers", async () => {
    const telemetry = await opened();
    server.isUp = false;
    server.breaks();
    await eventually(() => server.sockets.length > 5);
    server.isUp = true;
    await eventually(() => telemetry.status.connected);
  });

  it("costs nothing in memory: what waits lies on disk, and comes back from there in order", async () => {
    const disk = new MemoryBlocks();
    const telemetry = await opened(disk, { blockBytes: 5000, memoryBytes: 20_000 });
    server.isUp = false;
    server.breaks();
    await produce(telemetry, 50);
    await telemetry.flush();
    expect([...disk.entries.values()].flat()).toHaveLength(101);
    server.isUp = true;
    await telemetry.drained();
    expect(storedOf("target", 1)).toEqual(seqs("target", 1, 300));
  });

  it("that says nothing any more counts as broken", async () => {
    const telemetry = await opened(undefined, { silenceS: 0.05, probeEveryS: 0.01 });
    server.answersProbes = false;
    await eventually(() => server.sockets.length > 1);
    server.answersProbes = true;
    await eventually(() => telemetry.status.connected);
  });

  it("that takes nothing does not fill the memory of the browser", async () => {
    const telemetry = await opened(undefined, { bufferedBytes: 10_000 });
    server.socket.isStuck = true;
    await produce(telemetry, 50);
    await telemetry.flush();
    expect(server.socket.bufferedAmount).toBeLessThan(10_000 + batchBytes(6));
    server.breaks();
    await telemetry.drained();
    expect(storedOf("actual", 1)).toEqual(seqs("actual", 1, 300));
  });
});

describe("a hole", () => {
  it("is filled from the journal", async () => {
    const telemetry = await opened();
    server.acknowledges = false;
    await produce(telemetry, 4);
    await eventually(() => storedOf("reports", 1).length === 1);
    server.positions.set("target/1", 6);
    server.say({ type: "resend", stream: "target", epoch: 1, next_seq: 6 });
    server.acknowledges = true;
    await telemetry.drained();
    expect(server.positions.get("target/1")).toBe(24);
  });

  it("that the journal cannot fill is a failure, not an endless loop", async () => {
    const telemetry = await opened();
    await produce(telemetry, 4);
    await telemetry.drained();
    server.positions.set("target/1", 6);
    const sending = setInterval(() => {
      telemetry.sendFrames("target", standing(1)).catch(() => clearInterval(sending));
    }, 1);
    await eventually(() => telemetry.status.failure !== null);
    expect(telemetry.status.failure?.code).toBe("lost_on_the_server");
  });
});

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
    expect(storedOf("target", 1)).toEqual(seqs("target", 1, 30));
    expect(storedOf("target", 2)).toEqual(seqs("target", 2, 12));
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
    const second = await opened(disk);
    await eventually(() => server.of("produced").length > 0);
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

describe("a refusal", () => {
  it("is final and told in the server's words, also to those who wait", async () => {
    const telemetry = await opened();
    server.acknowledges = false;
    await produce(telemetry, 1);
    const waiting = telemetry.drained();
    server.refusal = {
      code: 4401,
      error: { type: "error", code: "not_signed_in", message: "not paired", remedy: "Pair again." },
    };
    server.breaks();
    await expect(waiting).rejects.toThrow("not paired. Pair again.");
    expect(telemetry.status.failure?.code).toBe("not_signed_in");
    await expect(telemetry.sendFrames("target", standing(1))).rejects.toThrow("Pair again.");
    const attempts = server.sockets.length;
    await new Promise((resolve) => setTimeout(resolve, 30));
    expect(server.sockets.length).toBe(attempts);
    expect(telemetry.status.journaledMessages).toBe(3);
  });

  it.each([4400, 4401, 4403, 1009])("by close code %i alone is final too", async (code) => {
    const telemetry = await opened();
    server.socket.breaks(code, "these are the words");
    await eventually(() => telemetry.status.failure !== null);
    expect(telemetry.status.failure).toMatchObject({ message: "these are the words" });
  });

  it.each([1000, 1001, 1006, 1011, 1012])("is not what close code %i means", async (code) => {
    const telemetry = await opened();
    server.socket.breaks(code);
    await eventually(() => server.sockets.length === 2 && telemetry.status.connected);
  });

  it("is met at the first attempt: opening rejects", async () => {
    const error = { type: "error", code: "invalid", message: "too old", remedy: "Update." };
    server.refusal = { code: 4400, error };
    client = await startedClient(server);
    await expect(client.opened()).rejects.toThrow("too old. Update.");
  });

  it("is ours when the server is not understood", async () => {
    server.welcomeWith = { positions: undefined as never };
    client = await startedClient(server);
    await expect(client.opened()).rejects.toThrow("positions");
  });

  it("is ours when the server speaks another protocol", async () => {
    server.welcomeWith = { protocol: 2 };
    client = await startedClient(server);
    await expect(client.opened()).rejects.toThrow("version 2");
  });
});

describe("a full journal", () => {
  it("holds the producer, says so, and lets it go on; nothing is lost", async () => {
    const telemetry = await opened(undefined, { journalBytes: 10 * batchBytes(6) });
    const levels = new Set<Level>();
    telemetry.onStatus((status: Status) => levels.add(status.level));
    server.isUp = false;
    server.breaks();
    const producing = produce(telemetry, 20);
    await eventually(() => telemetry.status.level === "full");
    expect(telemetry.status.waitingCalls).toBe(1);
    server.isUp = true;
    await producing;
    await telemetry.drained();
    expect(levels).toContain("full");
    expect(telemetry.status.level).toBe("clear");
    expect(storedOf("target", 1)).toEqual(seqs("target", 1, 120));
  });

  it("counts what waits as produced: the server learns of it", async () => {
    const disk = new MemoryBlocks();
    const telemetry = await opened(disk, { journalBytes: 1 });
    server.acknowledges = false;
    await telemetry.sendFrames("target", standing(6));
    void telemetry.sendFrames("target", standing(6)).catch(() => undefined);
    await eventually(() => server.of("produced").at(-1)?.streams !== undefined);
    await eventually(() => JSON.stringify(server.of("produced").at(-1)).includes('"target":12'));
  });

  it("is behind before it is full", async () => {
    const telemetry = await opened(undefined, { behindAfterS: 0.01 });
    server.acknowledges = false;
    await telemetry.sendFrames("target", standing(6));
    await eventually(() => telemetry.status.level === "behind");
    expect(telemetry.status.oldestUnackedS).toBeGreaterThan(0.01);
  });
});

describe("closing", () => {
  it("tells how far the run has come, and leaves the rest in the journal", async () => {
    const disk = new MemoryBlocks();
    const telemetry = await opened(disk, { producedEveryS: 60 });
    server.acknowledges = false;
    await produce(telemetry, 2);
    await telemetry.close();
    expect(server.of("produced").at(-1)).toMatchObject({ streams: { target: 12, actual: 12 } });
    expect([...disk.entries.values()].flat()).toHaveLength(5);
    await expect(telemetry.report(MATERIALISED)).rejects.toThrow("closed");
  });

  it("ends the waiting for a server that is not there", async () => {
    server.isUp = false;
    client = await startedClient(server);
    const opening = client.opened();
    await client.close();
    await expect(opening).rejects.toThrow("closed");
  });
});
