import type { PointMotion } from "@shared/stage/motion";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { poseOf } from "@shared/stage/skin/pose";
import type { Worn } from "@shared/stage/skin/worn";

/** The body of a figure, if there is one and the movement has rotations. */
export function wornBy(
  motion: PointMotion,
  model: BodyModel | null,
  statureM: number | null,
): { readonly worn?: Worn } {
  const pose = poseOf(motion);
  if (model === null || pose === null || statureM === null) return {};
  return { worn: { model, statureM, pose } };
}
