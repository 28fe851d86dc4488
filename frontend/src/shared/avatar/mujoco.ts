/**
 * MuJoCo in the browser: the very version the server computes with, so both compute the same.
 *
 * Ten megabytes: whoever needs it loads it here, lazily, and everything else takes the loaded module
 * as an argument. The page's content security policy must allow `'unsafe-eval'`.
 */
import type { MainModule, MjModel } from "@mujoco/mujoco";

export type Mujoco = MainModule;

export async function loadMujoco(): Promise<Mujoco> {
  const { default: start } = await import("@mujoco/mujoco");
  return start();
}

/** A model from the MJCF the server writes; the caller ends its life with `delete()`. */
export function modelFrom(mujoco: Mujoco, mjcf: string): MjModel {
  return mujoco.MjModel.from_xml_string(mjcf);
}
