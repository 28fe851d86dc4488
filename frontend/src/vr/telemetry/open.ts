/** Open a telemetry client in this thread: a page's or a worker's. */
import type { Status, TelemetryClient, TelemetryOptions } from "./client";
import { DirectClient } from "./directClient";
import { TelemetryError } from "./failure";
import { deleteJournal, IndexedDbBlocks } from "./journal/indexedDb";
import { Journal } from "./journal/journal";
import { DEFAULT_LIMITS } from "./limits";

/** Options that cannot be sent to a worker. */
export interface Surroundings {
  /** The client's monotonic clock, s; `performance.now()` unless another is given. */
  readonly clock?: () => number;
  /** Receives the status from the first attempt to connect onwards. */
  readonly onStatus?: (status: Status) => void;
  /** Aborts the wait for the server. */
  readonly signal?: AbortSignal;
}

/**
 * Open the journal and connect; resolves once the server has answered, however long that takes.
 *
 * What a previous run left in the journal is sent first, under its own epoch: it contains reports
 * without which the session's state would not make sense. Rejects with TelemetryError if the server
 * rejects the client, or if another page uses the journal.
 */
export async function openTelemetry(
  options: TelemetryOptions,
  around: Surroundings = {},
): Promise<TelemetryClient> {
  const client = await started(options, around);
  const giveUp = () => void client.close();
  around.signal?.addEventListener("abort", giveUp, { once: true });
  try {
    return await client.opened();
  } catch (error) {
    await client.close();
    throw error;
  } finally {
    around.signal?.removeEventListener("abort", giveUp);
  }
}

async function started(options: TelemetryOptions, around: Surroundings): Promise<DirectClient> {
  const { storageKey, durability = "relaxed" } = options;
  const limits = { ...DEFAULT_LIMITS, ...options.limits };
  const release = await takeLock(`reembody-telemetry/${storageKey}`, limits.lockTimeoutS);
  if (release === null) throw inUse(storageKey);
  try {
    const store = await IndexedDbBlocks.open(storageKey, durability);
    const journal = await Journal.open({ store, limits, room: storageRoom });
    return new DirectClient(options, {
      journal,
      limits,
      clock: around.clock ?? (() => performance.now() / 1000),
      wallClockMs: () => performance.timeOrigin + performance.now(),
      makeSocket: (url, protocols) => new WebSocket(url, protocols),
      onStatus: around.onStatus ?? (() => undefined),
      onClosed: async (failure) => {
        // Of somebody who has withdrawn nothing is kept, and the server takes nothing.
        const isOver = journal.messages === 0 || failure?.code === "withdrawn";
        if (isOver) await deleteJournal(storageKey);
        release();
      },
    });
  } catch (error) {
    release();
    throw error;
  }
}

const inUse = (storageKey: string): TelemetryError =>
  new TelemetryError({
    code: "journal_in_use",
    message: `another page has the journal of session ${storageKey} open`,
    remedy: "Close the other page, and reload this one.",
  });

// One page at a time may use a journal; the browser releases the lock of a page that dies.

/**
 * Wait for the lock `name`, at most `timeoutS`; return a function that releases it, or null after
 * the timeout.
 */
export async function takeLock(
  name: string,
  timeoutS: number,
  locks: LockManager | undefined = globalThis.navigator?.locks,
): Promise<(() => void) | null> {
  // Browsers offer no locks to pages without https; two such pages have to be kept apart by hand.
  if (locks === undefined) return () => undefined;
  return new Promise((resolve, reject) => {
    const held = () => new Promise<void>((release) => resolve(release));
    locks.request(name, { signal: AbortSignal.timeout(timeoutS * 1000) }, held).catch((error) => {
      if (error instanceof DOMException && /^(Timeout|Abort)Error$/.test(error.name)) resolve(null);
      else reject(error);
    });
  });
}

/** Bytes that the browser would still store for this site; Infinity if it does not say. */
async function storageRoom(storage = globalThis.navigator?.storage): Promise<number> {
  try {
    const { quota, usage } = await storage.estimate();
    return quota === undefined ? Number.POSITIVE_INFINITY : quota - (usage ?? 0);
  } catch {
    return Number.POSITIVE_INFINITY;
  }
}
