/** From where a stage is looked at, and how far away that must be. */
import { type PerspectiveCamera, Vector3 } from "three";
import type { LookFrom } from "./figure";
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
