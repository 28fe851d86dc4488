/**
 * MuJoCo in the browser: exactly the version that the server uses, so both compute the same.
 *
 * It has ten megabytes: callers that need it load it here, lazily, and all other code takes the
 * loaded module as an argument. The page's content security policy must allow `'unsafe-eval'`.
 */
import type { MainModule, MjModel } from "@mujoco/mujoco";

export type Mujoco = MainModule;

export async function loadMujoco(): Promise<Mujoco> {
  const { default: start } = await import("@mujoco/mujoco");
  return start();
}

/** A model from the MJCF that the server writes; the caller must `delete()` it. */
export function modelFrom(mujoco: Mujoco, mjcf: string): MjModel {
  return mujoco.MjModel.from_xml_string(mjcf);
}
