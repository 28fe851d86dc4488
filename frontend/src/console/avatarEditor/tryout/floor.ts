/** The floor under the bodies that are tried: a grid of metres, as far as they have walked. */
import type { FloorPlan } from "@shared/stage/floor";

/** How far the bodies have been from where they began, whole metres. */
export interface Reach {
  readonly min: readonly [x: number, z: number];
  readonly max: readonly [x: number, z: number];
}

export const NOWHERE: Reach = { min: [0, 0], max: [0, 0] };
/** A body that is lost does not make the floor endless. */
const FARTHEST_M = 30;

/** Extend a reach to where a body is; the same object if it is within. */
export function reaching(reach: Reach, place: readonly [x: number, z: number]): Reach {
  if (!place.every(Number.isFinite)) return reach;
  const [x, z] = place.map((value) =>
    Math.max(Math.min(Math.round(value), FARTHEST_M), -FARTHEST_M),
  ) as [number, number];
  const { min, max } = reach;
  if (x >= min[0] && z >= min[1] && x <= max[0] && z <= max[1]) return reach;
  return {
    min: [Math.min(min[0], x), Math.min(min[1], z)],
    max: [Math.max(max[0], x), Math.max(max[1], z)],
  };
}

/** The floor for bodies side by side, with their arms spread; `box` is what must be in view. */
export function floorOf(bodies: number, apartM: number, reach: Reach = NOWHERE): FloorPlan {
  const half = ((bodies - 1) / 2) * apartM;
  const wide = Math.ceil(half + 1);
  return {
    min: [reach.min[0] - wide, reach.min[1] - 1],
    max: [reach.max[0] + wide, reach.max[1] + 1],
    step: 1,
    box: { min: [-half - 0.8, 0, -0.3], max: [half + 0.8, 1.85, 0.3] },
  };
}
