/**
 * What only a page can do for its telemetry: start the worker, and notice that it is being left.
 */
import { reportUnloaded } from "@shared/ui/unloaded";
import type { TelemetryClient, TelemetryOptions } from "./client";
import type { Surroundings } from "./open";
import type { FromWorker, Port, ToWorker } from "./port";
import { WorkerClient } from "./workerClient";

/**
 * Like `openTelemetry`, but in a worker: there neither a slow frame nor a browser that suspends the
 * timers of
 * hidden pages (as some do while a headset shows the scene) delays acknowledgements, probes
 * and the journal, and draining a long backlog costs the frame loop nothing.
 *
 * The client's clock is the page's `performance.now()`, in seconds.
 */
export async function openTelemetryInWorker(
  options: TelemetryOptions,
  { onStatus, signal }: Omit<Surroundings, "clock"> = {},
): Promise<TelemetryClient> {
  // Without this a browser that runs out of disk may silently delete the journal. Some browsers ask
  // the user first, so the answer is not awaited.
  void navigator.storage?.persist?.().catch(() => false);
  const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
  const port = worker as Port<ToWorker, FromWorker>;
  const client = new PageClient(port, options, performance.timeOrigin);
  worker.addEventListener("error", ({ message }) => {
    // Without words it is the browser that could not load the worker.
    if (!message) reportUnloaded(null);
    client.fail({
      code: "worker_failed",
      message: `the telemetry worker has failed: ${message || "it could not be loaded"}`,
      remedy: "Reload this page; it continues as a new run.",
    });
  });
  if (onStatus) client.onStatus(onStatus);
  signal?.addEventListener("abort", () => client.giveUp(), { once: true });
  try {
    await client.opened();
  } catch (error) {
    worker.terminate();
    throw error;
  }
  const stopWatching = flushWhenLeft(client);
  client.onClosed = () => {
    stopWatching();
    worker.terminate();
  };
  return client;
}

/** `beforeunload` comes earlier; `pagehide` also comes when the user is not asked. */
const LEAVING = ["beforeunload", "pagehide"] as const;

/** A client whose worker ends with it. */
class PageClient extends WorkerClient {
  onClosed: () => void = () => undefined;

  override async close(): Promise<void> {
    await super.close();
    this.onClosed();
  }
}

/**
 * Write the journal to disk when the page is hidden or left; return a function that stops this.
 *
 * A client in the page's own thread has issued its write by the time the page is gone. A worker
 * must
 * first be notified, and browsers end it without waiting: so it is notified as early as possible,
 * and
 * what it produced within `flushEveryS` may be lost.
 */
export function flushWhenLeft(client: TelemetryClient): () => void {
  const flush = () => void client.flush().catch(() => undefined);
  const flushIfHidden = () => {
    if (document.visibilityState === "hidden") flush();
  };
  document.addEventListener("visibilitychange", flushIfHidden);
  for (const leaving of LEAVING) window.addEventListener(leaving, flush);
  return () => {
    document.removeEventListener("visibilitychange", flushIfHidden);
    for (const leaving of LEAVING) window.removeEventListener(leaving, flush);
  };
}
