import { describe, expect, it } from "vitest";
import { standing } from "./testing/frames";
import { eventually, produce, startedClient, testBed } from "./testing/rig";

const bed = testBed();

describe("a rejection by the server", () => {
  it("is final and reported in the server's words, also to waiting calls", async () => {
    const telemetry = await bed.opened();
    bed.server.acknowledges = false;
    await produce(telemetry, 1);
    const waiting = telemetry.drained();
    bed.server.refusal = {
      code: 4401,
      error: { type: "error", code: "not_signed_in", message: "not paired", remedy: "Pair again." },
    };
    bed.server.breaks();
    await expect(waiting).rejects.toThrow("not paired. Pair again.");
    expect(telemetry.status.failure?.code).toBe("not_signed_in");
    await expect(telemetry.sendFrames("target", standing(1))).rejects.toThrow("Pair again.");
    const attempts = bed.server.sockets.length;
    await new Promise((resolve) => setTimeout(resolve, 30));
    expect(bed.server.sockets.length).toBe(attempts);
    expect(telemetry.status.journaledMessages).toBe(3);
  });

  it.each([4400, 4401, 4403, 1009])("by close code %i alone is final too", async (code) => {
    const telemetry = await bed.opened();
    bed.server.socket.breaks(code, "these are the words");
    await eventually(() => telemetry.status.failure !== null);
    expect(telemetry.status.failure).toMatchObject({ message: "these are the words" });
  });

  it.each([1000, 1001, 1006, 1011, 1012])("is not what close code %i means", async (code) => {
    const telemetry = await bed.opened();
    bed.server.socket.breaks(code);
    await eventually(() => bed.server.sockets.length === 2 && telemetry.status.connected);
  });

  it("at the first attempt makes opening reject", async () => {
    const error = { type: "error", code: "invalid", message: "too old", remedy: "Update." };
    bed.server.refusal = { code: 4400, error };
    bed.client = await startedClient(bed.server);
    await expect(bed.client.opened()).rejects.toThrow("too old. Update.");
  });

  it("comes from the client if it does not understand the server", async () => {
    bed.server.welcomeWith = { positions: undefined as never };
    bed.client = await startedClient(bed.server);
    await expect(bed.client.opened()).rejects.toThrow("positions");
  });

  it("comes from the client if the server speaks another protocol", async () => {
    bed.server.welcomeWith = { protocol: 2 };
    bed.client = await startedClient(bed.server);
    await expect(bed.client.opened()).rejects.toThrow("version 2");
  });
});
