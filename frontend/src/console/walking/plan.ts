/** The floor seen from above as a picture: x to the right, y up, the same scale on both axes. */
import type { Point, Scene } from "@shared/api/walking";

export const WIDTH = 640;
const MAX_HEIGHT = 520;
const LEFT = 46;
const BELOW = 42;
const EDGE = 12;

export interface Plan {
  readonly height: number;
  readonly scale: number;
  readonly bounds: Scene["bounds_m"];
  readonly x: (metres: number) => number;
  readonly y: (metres: number) => number;
  /** Convert a position in the picture to one on the floor, clamped to the bounds. */
  readonly floor: (x: number, y: number) => Point;
}

export function planOf(bounds: Scene["bounds_m"]): Plan {
  const [left, near, right, far] = bounds;
  const scale = Math.min(
    (WIDTH - LEFT - EDGE) / (right - left),
    (MAX_HEIGHT - BELOW - EDGE) / (far - near),
  );
  const height = (far - near) * scale + BELOW + EDGE;
  const shift = LEFT + (WIDTH - LEFT - EDGE - (right - left) * scale) / 2;
  const within = (value: number, low: number, high: number) => Math.min(high, Math.max(low, value));
  return {
    height,
    scale,
    bounds,
    x: (metres) => shift + (metres - left) * scale,
    y: (metres) => EDGE + (far - metres) * scale,
    floor: (x, y) => [
      within(left + (x - shift) / scale, left, right),
      within(far - (y - EDGE) / scale, near, far),
    ],
  };
}

const STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200];
const WIDEST_PX = 34;

/** Round numbers of metres from `low` to `high`, far enough apart to be readable. */
export function ticks(low: number, high: number, scale: number): readonly number[] {
  const step = STEPS.find((one) => one * scale >= WIDEST_PX) ?? 500;
  const first = Math.ceil(low / step - 1e-9);
  const count = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: Math.max(0, count) }, (_, at) =>
    Number(((first + at) * step).toFixed(6)),
  );
}

export const lineOf = (plan: Plan, points: readonly Point[]): string =>
  points.map(([x, y]) => `${plan.x(x).toFixed(1)},${plan.y(y).toFixed(1)}`).join(" ");
