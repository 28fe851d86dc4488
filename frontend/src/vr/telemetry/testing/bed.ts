/** A fake server and a client of it for each test of a file; the client is closed behind it. */
import { afterEach, beforeEach } from "vitest";
import type { DirectClient } from "../directClient";
import type { Limits } from "../limits";
import { FakeServer } from "./fakeServer";
import type { MemoryBlocks } from "./memoryBlocks";
import { openedClient } from "./rig";

export interface Bed {
  server: FakeServer;
  client: DirectClient | null;
  opened(...more: [disk?: MemoryBlocks, limits?: Partial<Limits>]): Promise<DirectClient>;
}

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
