/** Where the camera of a stage is placed, and how far away it must be. */
import { type PerspectiveCamera, Vector3 } from "three";
import type { Seconds } from "../units";
import { sightAt } from "./eyes";
import { type CameraSide, type Figure, facingOf } from "./figure";
import type { FloorPlan } from "./floor";
import { frameAt } from "./motion";

/** The unit vector from the middle to the camera; `facing` is the direction the body faces. */
export function directionOf(from: CameraSide, [x, z]: readonly [x: number, z: number]): Vector3 {
  const front = new Vector3(x, 0, z);
  // Its right-hand side: facing x up.
  const right = new Vector3(-z, 0, x);
  const up = new Vector3(0, 1, 0);
  if (from === "front") return front.addScaledVector(up, 0.1).normalize();
  if (from === "back") return front.multiplyScalar(-1).addScaledVector(up, 0.1).normalize();
  if (from === "side") return right.addScaledVector(up, 0.1).normalize();
  // Not quite straight down: orbiting needs an up direction there.
  if (from === "top") return up.addScaledVector(right, 0.001).normalize();
  return right.addScaledVector(front, 0.6).addScaledVector(up, 0.36).normalize();
}

/** Snap a direction to the lines of the floor if it is almost parallel: the picture is calmer. */
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

/** The corners of the movement's box, with a margin for a body that stands in one of them. */
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

/** The least distance ahead at which eyes look, relative to the distance down. */
const MIN_AHEAD = 0.55;

/**
 * Look through a figure's eyes: where its head looks, or where the head's rotation is unknown, at a
 * place, or ahead if that is null. Do nothing if the body's parts are unknown.
 */
export function lookThroughEyes(
  camera: PerspectiveCamera,
  figure: Figure,
  placed: Float32Array,
  { time, place }: { readonly time: Seconds; readonly place: Place | null },
): void {
  const head = figure.roles?.head ?? null;
  if (head === null) return;
  const { seenBy } = figure;
  const sight = seenBy === undefined ? null : sightAt(seenBy, frameAt(seenBy, time));
  if (sight !== null) {
    camera.position.set(...sight.fromM);
    camera.lookAt(...sight.toM);
    return;
  }
  const facing = facingOf(figure, placed);
  if (facing === null) return;
  const [x = 0, y = 0, z = 0] = placed.subarray(3 * head, 3 * head + 3);
  const [fx, fz] = facing;
  camera.position.set(x + 0.12 * fx, y + 0.08, z + 0.12 * fz);
  // A little downwards, as people look when walking.
  const [px, py, pz] = place ?? [x + fx, y - 0.4, z + fz];
  // Never straight down: what is ahead stays at the top of the picture, with the own feet in view.
  const ahead = (px - x) * fx + (pz - z) * fz;
  const more = Math.max(0, MIN_AHEAD * (y - py) - ahead);
  camera.lookAt(px + more * fx, py, pz + more * fz);
}

type Place = readonly [x: number, y: number, z: number];
