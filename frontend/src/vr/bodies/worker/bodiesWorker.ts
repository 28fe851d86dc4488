/**
 * The file that runs in the worker of the bodies. Its name is known to the server
 * (`app/api/pages.py`): the policy of this file alone allows MuJoCo to make functions from text.
 */
import start from "@mujoco/mujoco";
import { serveBodies, type WorkerPort } from "./service";

serveBodies(globalThis as unknown as WorkerPort, (wasm) => start({ wasmBinary: wasm }));
