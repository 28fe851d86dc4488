/** From where a stage is looked at, and how far away that must be. */
import { type PerspectiveCamera, Vector3 } from "three";
import { type Figure, facingOf, type LookFrom } from "./figure";
import type { FloorPlan } from "./floor";

/** The direction from the middle to the camera, of length 1; `facing` is where the body faces. */
export function directionOf(from: LookFrom, [x, z]: readonly [x: number, z: number]): Vector3 {
  const front = new Vector3(x, 0, z);
  // Its right hand: facing x up.
  const right = new Vector3(-z, 0, x);
  const up = new Vector3(0, 1, 0);
  if (from === "front") return front.addScaledVector(up, 0.1).normalize();
  if (from === "side") return right.addScaledVector(up, 0.1).normalize();
  // Not quite straight down: there, orbiting would not know which way is up.
  if (from === "top") return up.addScaledVector(right, 0.001).normalize();
  return right.addScaledVector(front, 0.6).addScaledVector(up, 0.36).normalize();
}

/** Along the lines of the floor where it is nearly so anyway: the picture is calmer. */
export function alongFloor(
  facing: readonly [x: number, z: number] | null,
): readonly [x: number, z: number] | null {
  if (facing === null) return null;
  const [x, z] = facing;
  if (Math.abs(x) > NEARLY) return [Math.sign(x), 0];
  return Math.abs(z) > NEARLY ? [0, Math.sign(z)] : facing;
}

/** The cosine of 30 degrees. */
const NEARLY = Math.cos(Math.PI / 6);

/** The nearest place in a direction from which everything that moves can be seen. */
export function fitting(
  plan: FloorPlan,
  away: Vector3,
  camera: PerspectiveCamera,
): { readonly middle: Vector3; readonly distance: number } {
  const corners = cornersOf(plan);
  const middle = corners.reduce((sum, corner) => sum.addScaledVector(corner, 1 / 8), new Vector3());
  const across = new Vector3(0, 1, 0).cross(away).normalize();
  const upwards = away.clone().cross(across);
  const half = Math.tan((camera.fov * Math.PI) / 360);
  let distance = 0;
  for (const corner of corners) {
    const from = corner.sub(middle);
    const toSides = Math.abs(from.dot(across)) / (half * camera.aspect);
    const toTop = Math.abs(from.dot(upwards)) / half;
    distance = Math.max(distance, Math.max(toSides, toTop) + from.dot(away));
  }
  return { middle, distance: distance * 1.06 };
}

/** Of what moves, with room around it for whoever stands in its corner. */
function cornersOf({ box, step }: FloorPlan): Vector3[] {
  const room = 0.2 * step;
  const sides = ([0, 2] as const).map((axis) => [box.min[axis] - room, box.max[axis] + room]);
  const [xs = [], zs = []] = sides;
  return xs.flatMap((x) =>
    [Math.min(0, box.min[1]), Math.max(box.max[1], room)].flatMap((y) =>
      zs.map((z) => new Vector3(x, y, z)),
    ),
  );
}

/** How far ahead eyes look at least, of how far they look down. */
const LEAST_AHEAD = 0.55;

/** Look out of the eyes of a figure at a place, or ahead where there is none; nothing happens where the body is not known. */
export function lookOut(
  camera: PerspectiveCamera,
  figure: Figure,
  placed: Float32Array,
  place: readonly [x: number, y: number, z: number] | null,
): void {
  const head = figure.roles?.head ?? null;
  const facing = facingOf(figure, placed);
  if (head === null || facing === null) return;
  const [x = 0, y = 0, z = 0] = placed.subarray(3 * head, 3 * head + 3);
  const [fx, fz] = facing;
  camera.position.set(x + 0.12 * fx, y + 0.08, z + 0.12 * fz);
  // A little downwards, as one looks when walking.
  const [px, py, pz] = place ?? [x + fx, y - 0.4, z + fz];
  // Never straight down: what is ahead stays at the top of the picture, and the own feet in it.
  const ahead = (px - x) * fx + (pz - z) * fz;
  const more = Math.max(0, LEAST_AHEAD * (y - py) - ahead);
  camera.lookAt(px + more * fx, py, pz + more * fz);
}
