import { afterEach, beforeEach, describe, expect, it } from "vitest";
import type { DirectClient } from "./directClient";
import type { Limits } from "./limits";
import { FakeServer } from "./testing/fakeServer";
import { standing } from "./testing/frames";
import type { MemoryBlocks } from "./testing/memoryBlocks";
import { eventually, openedClient, produce, startedClient } from "./testing/rig";

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
