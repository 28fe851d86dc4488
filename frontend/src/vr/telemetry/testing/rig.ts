/** A client on a fake server and a fake disk; the disk outlives the client, as in a browser. */
import { afterEach, beforeEach } from "vitest";
import type { TelemetryClient } from "../client";
import { DirectClient } from "../directClient";
import { Journal } from "../journal/journal";
import { DEFAULT_LIMITS, type Limits } from "../limits";
import { FakeServer } from "./fakeServer";
import { standing } from "./frames";
import { MemoryBlocks } from "./journals";

/** Limits with milliseconds in place of seconds. */
const QUICK: Partial<Limits> = {
  flushEveryS: 0.005,
  retryS: [0.001, 0.002, 0.005],
  openTimeoutS: 1,
  silenceS: 5,
  probeEveryS: 5,
  producedEveryS: 0.01,
  bufferPollS: 0.001,
  resendPauseS: 0.01,
};

export async function startedClient(
  server: FakeServer,
  disk = new MemoryBlocks(),
  changed: Partial<Limits> = {},
): Promise<DirectClient> {
  const limits = { ...DEFAULT_LIMITS, ...QUICK, ...changed };
  const room = async () => Number.POSITIVE_INFINITY;
  const journal = await Journal.open({ store: disk, limits, room });
  return new DirectClient(
    { url: "ws://test/api/vr/stream", token: "TOKEN", name: "test", storageKey: "test" },
    {
      journal,
      limits,
      clock: () => performance.now() / 1000,
      wallClockMs: () => performance.timeOrigin + performance.now(),
      makeSocket: server.makeSocket,
      onStatus: () => undefined,
      onClosed: async () => undefined,
    },
  );
}

export async function openedClient(
  ...how: Parameters<typeof startedClient>
): Promise<DirectClient> {
  return (await startedClient(...how)).opened();
}

export const MATERIALISED = { kind: "materialised", t_s: 1 } as const;

/** Produce so many batches of six frames of each stream, followed by a report. */
export async function produce(producer: TelemetryClient, batches: number): Promise<void> {
  for (let batch = 0; batch < batches; batch++) {
    await producer.sendFrames("target", standing(6));
    await producer.sendFrames("actual", standing(6));
  }
  await producer.report(MATERIALISED);
}

/** So many seqs in the fake server's notation. */
export const seqs = (stream: string, epoch: number, count: number): readonly string[] =>
  Array.from({ length: count }, (_, seq) => `${stream}/${epoch}/${seq}`);

/** Wait until a condition holds; a test that waits in vain runs into its own time limit. */
export async function eventually(holds: () => boolean): Promise<void> {
  while (!holds()) await new Promise((resolve) => setTimeout(resolve, 1));
}

interface Bed {
  server: FakeServer;
  client: DirectClient | null;
  opened(...more: [disk?: MemoryBlocks, limits?: Partial<Limits>]): Promise<DirectClient>;
}

/**
 * A fake server and a client of it for each test of a file; the client is closed after the test.
 */
export function testBed(): Bed {
  const bed: Bed = {
    server: new FakeServer(),
    client: null,
    async opened(...more) {
      bed.client = await openedClient(bed.server, ...more);
      return bed.client;
    },
  };
  beforeEach(() => {
    bed.server = new FakeServer();
    bed.client = null;
  });
  afterEach(async () => {
    await bed.client?.close();
  });
  return bed;
}
