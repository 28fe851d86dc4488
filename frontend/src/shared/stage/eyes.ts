/** Where a camera is that looks out of a figure's eyes. */
import type { PerspectiveCamera } from "three";
import { type Figure, facingOf } from "./figure";

/** How far ahead eyes look at least, of how far they look down. */
const LEAST_AHEAD = 0.55;

/** Look at a place, or ahead where there is none; nothing happens where the body is not known. */
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
