/** What only a page can do for the worker: start it, and fetch MuJoCo for it. */
import wasmUrl from "@mujoco/mujoco/mujoco.wasm?url";
import type { TryoutPort } from "./messages";
import workerUrl from "./tryoutWorker?worker&url";

export async function startWorker(): Promise<{ port: TryoutPort; wasm: ArrayBuffer }> {
  const answer = await fetch(wasmUrl);
  if (!answer.ok) throw new Error(`MuJoCo could not be loaded (HTTP ${answer.status}).`);
  const wasm = await answer.arrayBuffer();
  const worker = new Worker(workerUrl, { type: "module" });
  const port = worker as unknown as TryoutPort;
  worker.addEventListener("error", ({ message }) => {
    const problem = message || "it could not be started";
    port.onmessage?.({ data: { kind: "failed", problem } } as MessageEvent);
  });
  return { port, wasm };
}
