/** The force with which a pointer pulls at a part: that of a spring between the two. */
import type { Vector } from "./physics/commands";

/** Stiffness of the spring, N/m. */
export const STIFFNESS = 600;
export const STRONGEST_N = 300;
/** Directions of a push by button, in the world: the body looks towards -z. */
export const DIRECTIONS = {
  forward: [0, 0, -1],
  backward: [0, 0, 1],
  left: [-1, 0, 0],
  right: [1, 0, 0],
  up: [0, 1, 0],
  down: [0, -1, 0],
} as const satisfies Readonly<Record<string, Vector>>;
export type Direction = keyof typeof DIRECTIONS;
/** The other way of each direction. */
export const OPPOSITES = {
  forward: "backward",
  backward: "forward",
  left: "right",
  right: "left",
  up: "down",
  down: "up",
} as const satisfies Readonly<Record<Direction, Direction>>;

/** Return the force from where it acts towards the pointer, N; weaker than `STRONGEST_N`. */
export function pullOf(from: Vector, to: Vector): Vector {
  const along = to.map((value, i) => STIFFNESS * (value - (from[i] as number)));
  const strength = Math.hypot(...along);
  const share = strength > STRONGEST_N ? STRONGEST_N / strength : 1;
  return along.map((value) => share * value) as unknown as Vector;
}

export const strengthOf = (force: Vector): number => Math.hypot(...force);

export const scaled = (direction: Vector, by: number): Vector =>
  direction.map((value) => by * value) as unknown as Vector;
