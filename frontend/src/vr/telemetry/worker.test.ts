import { afterEach, beforeEach, expect, it } from "vitest";
import type { TelemetryClient } from "./client";
import type { FromWorker, Port, ToWorker } from "./port";
import { serveTelemetry } from "./service";
import { FakeServer, stateOf } from "./testing/fakeServer";
import { standing } from "./testing/frames";
import { MemoryBlocks } from "./testing/journals";
import { eventually, startedClient } from "./testing/rig";
import { WorkerClient } from "./workerClient";

const OPTIONS = { url: "ws://test", token: "TOKEN", name: "test", storageKey: "test" };
let server: FakeServer;
let channel: MessageChannel;
let client: WorkerClient;
let clock: (() => number) | undefined;

/** Both sides in one thread, on the two ends of a channel: messages are copied all the same. */
beforeEach(() => {
  server = new FakeServer();
  channel = new MessageChannel();
  for (const port of [channel.port1, channel.port2]) port.start();
  const disk = new MemoryBlocks();
  serveTelemetry(channel.port1 as Port<FromWorker, ToWorker>, async (_options, around) => {
    clock = around?.clock;
    const inside = await startedClient(server, disk);
    if (around?.onStatus) inside.onStatus(around.onStatus);
    around?.signal?.addEventListener("abort", () => void inside.close());
    return inside.opened();
  });
  const port = channel.port2 as Port<ToWorker, FromWorker>;
  client = new WorkerClient(port, OPTIONS, performance.timeOrigin - 60_000);
});

afterEach(async () => {
  await client.close().catch(() => undefined);
  channel.port1.close();
});

it("behaves like the client in the page's thread", async () => {
  const telemetry: TelemetryClient = await client.opened();
  await telemetry.sendFrames("target", standing(6));
  await telemetry.sendFrames("actual", standing(6));
  await telemetry.report({ kind: "materialised", t_s: 1 });
  await telemetry.drained();
  expect(server.stored).toHaveLength(13);
  expect([telemetry.epoch, telemetry.welcome.session_id]).toEqual([1, "session"]);
});

it("copies the frames at the call, so the caller may reuse the arrays", async () => {
  await client.opened();
  const frames = standing(6);
  const sending = client.sendFrames("target", frames);
  frames.timesS.fill(Number.NaN);
  await sending;
  await client.drained();
  expect(frames.values).toHaveLength(6 * 91);
  expect(server.stored).toHaveLength(6);
});

it("passes events on, and its state is the last one received", async () => {
  await client.opened();
  const [states, notices]: [number[], string[]] = [[], []];
  client.onState((state) => states.push(state.version));
  client.onNotice((notice) => notices.push(notice.type));
  server.broadcast(stateOf(2));
  server.broadcast({ type: "refused", epoch: 1, seq: 0, message: "m", remedy: "r" });
  await eventually(() => notices.length === 1);
  expect([states, client.state.version]).toEqual([[2], 2]);
});

it("is not settled from the call of a report until the worker has heard that it is stored", async () => {
  await client.opened();
  await eventually(() => client.settled);
  const reporting = client.report({ kind: "materialised", t_s: 1 });
  expect(client.settled).toBe(false);
  await reporting;
  await eventually(() => client.settled);
});

it("passes errors on by name, and does not wait for a report that was rejected locally", async () => {
  await client.opened();
  const report = client.report({ kind: "materialised", t_s: Number.NaN });
  await expect(report).rejects.toMatchObject({ name: "MalformedMessage" });
  await eventually(() => client.settled);
});

it("passes on a rejection by the server unchanged", async () => {
  await client.opened();
  server.refusal = {
    code: 4401,
    error: { type: "error", code: "not_signed_in", message: "not paired", remedy: "Pair again." },
  };
  server.breaks();
  await eventually(() => client.status.failure !== null);
  const sending = client.sendFrames("target", standing(1));
  await expect(sending).rejects.toMatchObject({ failure: { code: "not_signed_in" } });
});

it("gives up waiting for the server", async () => {
  server.isUp = false;
  client.giveUp();
  await expect(client.opened()).rejects.toThrow("closed");
});

it("rejects all waiting calls when the worker has failed", async () => {
  await client.opened();
  server.acknowledges = false;
  await client.sendFrames("target", standing(1));
  const waiting = client.drained();
  client.fail({ code: "worker_failed", message: "out of memory", remedy: "Reload." });
  await expect(waiting).rejects.toThrow("out of memory. Reload.");
  expect(client.status).toMatchObject({ connected: false, failure: { code: "worker_failed" } });
});

it("reads the page's clock, not the worker's own", async () => {
  await client.opened();
  // The page in this test was opened a minute before the thread started.
  expect(clock?.()).toBeGreaterThan(60);
});
