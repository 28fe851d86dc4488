/** Which point of the figures is pointed at. */
import { type PerspectiveCamera, Vector3 } from "three";
import type { Placing } from "./placing";

/** A point of a figure on the screen; pixels from the stage's upper left corner. */
export interface Pointed {
  readonly name: string;
  readonly x: number;
  readonly y: number;
}

/** Farther away nothing is meant, pixels. */
const WITHIN = 14;

/** The point that is nearest to a place on the stage, where one is near. */
export function nearestPoint(
  bodies: readonly { readonly placing: Placing }[],
  camera: PerspectiveCamera,
  [width, height]: readonly [width: number, height: number],
  [xPx, yPx]: readonly [x: number, y: number],
): Pointed | null {
  let best: Pointed | null = null;
  let least = WITHIN;
  const at = new Vector3();
  for (const { placing } of bodies) {
    placing.figure.motion.names.forEach((name, point) => {
      at.fromArray(placing.placed, 3 * point).project(camera);
      const x = (0.5 + at.x / 2) * width;
      const y = (0.5 - at.y / 2) * height;
      const far = Math.hypot(x - xPx, y - yPx);
      if (at.z < 1 && far < least) {
        least = far;
        best = { name, x, y };
      }
    });
  }
  return best;
}
