/** What only a page can do for its telemetry: start the worker, notice that it is being left. */
import type { TelemetryClient, TelemetryOptions } from "./client";
import type { Surroundings } from "./open";
import type { FromWorker, Port, ToWorker } from "./port";
import { WorkerClient } from "./workerClient";

/**
 * Like `openTelemetry`, in a worker: there neither a slow frame nor a browser that lets the timers of
 * hidden pages sleep (as some do while a headset shows the scene) holds up acknowledgements, probes
 * and the journal, and draining a long backlog costs the frame loop nothing.
 *
 * The client's clock is the page's `performance.now()`, in seconds.
 */
export async function openTelemetryInWorker(
  options: TelemetryOptions,
  { onStatus, signal }: Omit<Surroundings, "clock"> = {},
): Promise<TelemetryClient> {
  // Without this a browser that runs out of disk may delete the journal without a word. Some ask the
  // user first: nobody waits for the answer.
  void navigator.storage?.persist?.().catch(() => false);
  const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
  const port = worker as Port<ToWorker, FromWorker>;
  const client = new PageClient(port, options, performance.timeOrigin);
  worker.addEventListener("error", ({ message }) => {
    client.fail({
      code: "worker_failed",
      message: `the telemetry worker has failed: ${message}`,
      remedy: "Reload this page: it goes on as a new run.",
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

/** The first comes earlier, the second also where nobody is asked. */
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
 * Bring the journal to disk when the page is hidden or left; returns what ends the watching.
 *
 * A client of the page itself has then asked for everything before the page goes. One in a worker
 * must still be told, and browsers end it without waiting: so it is told as early as possible, and
 * what it has made within `flushEveryS` may be lost.
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
