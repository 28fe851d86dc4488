/** What only a page can do for the worker: start it, and fetch MuJoCo for it. */
import wasmUrl from "@mujoco/mujoco/mujoco.wasm?url";
import { fetchPart, reportUnloaded } from "@shared/ui/unloaded";
import type { TryoutPort } from "./messages";
import workerUrl from "./tryoutWorker?worker&url";

export async function startWorker(): Promise<{ port: TryoutPort; wasm: ArrayBuffer }> {
  const wasm = await fetchPart(wasmUrl);
  const worker = new Worker(workerUrl, { type: "module" });
  const port = worker as unknown as TryoutPort;
  worker.addEventListener("error", ({ message }) => {
    // Without words it is the browser that could not load the worker.
    if (!message) reportUnloaded(null);
    const problem = message || "it could not be started";
    port.onmessage?.({ data: { kind: "failed", problem } } as MessageEvent);
  });
  return { port, wasm };
}
