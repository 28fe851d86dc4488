import type { PointMotion } from "@shared/stage/motion";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { type PoseSource, poseOf } from "@shared/stage/skin/pose";
import type { Worn } from "@shared/stage/skin/worn";

/**
 * The body of a figure, if there is one and the movement has rotations.
 *
 * `hipsScale`: the height of the body's hips over that in the movement, so that somebody else's
 * movement stands on the floor in a body with other legs.
 */
export function wornBy(
  motion: PointMotion,
  model: BodyModel | null,
  statureM: number | null,
  hipsScale = 1,
): { readonly worn?: Worn } {
  const pose = poseOf(motion);
  if (model === null || pose === null || statureM === null) return {};
  return { worn: { model, statureM, pose: hipsScale === 1 ? pose : raised(pose, hipsScale) } };
}

function raised(pose: PoseSource, hipsScale: number): PoseSource {
  const read = (frame: number, values: Float32Array): void => {
    pose.read(frame, values);
    values[1] = (values[1] ?? Number.NaN) * hipsScale;
  };
  return { ...pose, read };
}

/** The height of one movement's hips over another's, in the first frame that has both; else 1. */
export function hipsScaleOf(of: PointMotion, over: PointMotion): number {
  for (let frame = 0; frame < Math.min(of.frames, over.frames); frame++) {
    const ratio =
      (of.positions[3 * frame * of.names.length + 1] ?? Number.NaN) /
      (over.positions[3 * frame * over.names.length + 1] ?? Number.NaN);
    if (Number.isFinite(ratio) && ratio > 0) return ratio;
  }
  return 1;
}
