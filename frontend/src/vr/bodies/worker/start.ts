/** What only a page can do for the worker of the bodies: start it, and fetch MuJoCo for it. */
import wasmUrl from "@mujoco/mujoco/mujoco.wasm?url";
import { fetchPart, reportUnloaded } from "@shared/ui/unloaded";
import workerUrl from "./bodiesWorker?worker&url";
import type { BodiesPort } from "./messages";

/**
 * Have the worker and MuJoCo in the browser's cache before they are needed: their names contain a
 * hash, so they are kept. What fails now is fetched again, and reported, when the bodies are made.
 */
export async function fetchBeforehand(): Promise<void> {
  const wanted = [wasmUrl, workerUrl].map(async (url) => {
    const answer = await fetch(url, { priority: "low" });
    await answer.arrayBuffer();
  });
  await Promise.allSettled(wanted);
}

export async function startWorker(): Promise<{ port: BodiesPort; wasm: ArrayBuffer }> {
  const wasm = await fetchPart(wasmUrl);
  const worker = new Worker(workerUrl, { type: "module" });
  const port = worker as unknown as BodiesPort;
  worker.addEventListener("error", ({ message }) => {
    // Without words it is the browser that could not load the worker.
    if (!message) reportUnloaded(null);
    const problem = message || "it could not be started";
    port.onmessage?.({ data: { kind: "failed", problem } } as MessageEvent);
  });
  return { port, wasm };
}
