/** What only a page can do for the worker of the bodies: start it, and fetch MuJoCo for it. */
import wasmUrl from "@mujoco/mujoco/mujoco.wasm?url";
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
  const answer = await fetch(wasmUrl);
  if (!answer.ok) throw new Error(`MuJoCo could not be loaded (HTTP ${answer.status}).`);
  const wasm = await answer.arrayBuffer();
  const worker = new Worker(workerUrl, { type: "module" });
  const port = worker as unknown as BodiesPort;
  worker.addEventListener("error", ({ message }) => {
    const problem = message || "it could not be started";
    port.onmessage?.({ data: { kind: "failed", problem } } as MessageEvent);
  });
  return { port, wasm };
}
