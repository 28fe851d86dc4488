/**
 * The file that runs in the worker that simulates what is being edited. Its name is known to the
 * server (`app/api/pages.py`): the policy of this file alone allows MuJoCo to make functions from text.
 */
import start from "@mujoco/mujoco";
import { serveTryout, type WorkerPort } from "./service";

serveTryout(globalThis as unknown as WorkerPort, (wasm) => start({ wasmBinary: wasm }));
