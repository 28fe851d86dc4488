/**
 * Which body parts touch which surfaces, by distance: capsules against axis-aligned blocks. The
 * server's `app/science/tasks/contacts.py` explains the geometry; this is the same, operation by
 * operation, and allocates nothing per frame.
 *
 * A body part is a capsule: all points within a radius of a segment. A contact that has begun may
 * continue until the part is `releaseMarginM` further away (hysteresis), or one that flickers at its
 * edge would be counted many times.
 */
import type { Surface } from "./layout";

/** How far a part may move away from a surface before its touch ends. */
export const RELEASE_MARGIN_M = 0.005;

/** By surface and part (S x P, 0 or 1): what is touched, and what is near enough to keep a touch. */
export interface Touches {
  readonly touched: Uint8Array;
  readonly near: Uint8Array;
}

/** Finds the touches of P parts on the surfaces of one layout, frame by frame. */
export class CapsuleContacts implements Touches {
  readonly touched: Uint8Array;
  readonly near: Uint8Array;
  /** Corners of the surfaces, six values each: low x, y, z, high x, y, z. */
  readonly #corners: Float64Array;
  readonly #all: Float64Array;
  readonly #partCount: number;
  readonly #reach = new Float64Array(6);

  constructor(surfaces: readonly Pick<Surface, "centerM" | "halfSizeM">[], partCount: number) {
    this.#partCount = partCount;
    this.touched = new Uint8Array(surfaces.length * partCount);
    this.near = new Uint8Array(surfaces.length * partCount);
    this.#corners = new Float64Array(6 * surfaces.length);
    this.#all = Float64Array.of(Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity);
    surfaces.forEach(({ centerM, halfSizeM }, index) => {
      for (let axis = 0; axis < 3; axis++) {
        const low = (centerM[axis] as number) - (halfSizeM[axis] as number);
        const high = (centerM[axis] as number) + (halfSizeM[axis] as number);
        this.#corners[6 * index + axis] = low;
        this.#corners[6 * index + 3 + axis] = high;
        this.#all[axis] = Math.min(this.#all[axis] as number, low);
        this.#all[3 + axis] = Math.max(this.#all[3 + axis] as number, high);
      }
    });
  }

  /**
   * Find the touches of one frame, in `touched` and `near`; a part whose place is unknown (NaN), such
   * as a hand that is not tracked, touches nothing.
   *
   * `segmentsM`: start and end of each part, six values a part; `radiiM`: one a part. World frame.
   */
  find(segmentsM: Float64Array, radiiM: Float64Array, releaseMarginM = RELEASE_MARGIN_M): void {
    const parts = this.#partCount;
    if (segmentsM.length !== 6 * parts || radiiM.length !== parts) {
      throw new RangeError(
        `Expected ${6 * parts} values of segments and ${parts} radii, got ${segmentsM.length} and ` +
          `${radiiM.length}.`,
      );
    }
    this.touched.fill(0);
    this.near.fill(0);
    const surfaces = this.#corners.length / 6;
    for (let part = 0; part < parts; part++) {
      const radius = radiiM[part] as number;
      this.#setReach(segmentsM, 6 * part, radius + releaseMarginM);
      if (!this.#meets(this.#all, 0)) continue;
      for (let surface = 0; surface < surfaces; surface++) {
        if (!this.#meets(this.#corners, 6 * surface)) continue;
        const distanceM = segmentBoxDistanceM(segmentsM, 6 * part, this.#corners, 6 * surface);
        const at = surface * parts + part;
        if (distanceM <= radius) this.touched[at] = 1;
        if (distanceM <= radius + releaseMarginM) this.near[at] = 1;
      }
    }
  }

  #setReach(segments: Float64Array, at: number, reachM: number): void {
    for (let axis = 0; axis < 3; axis++) {
      const start = segments[at + axis] as number;
      const end = segments[at + 3 + axis] as number;
      this.#reach[axis] = Math.min(start, end) - reachM;
      this.#reach[3 + axis] = Math.max(start, end) + reachM;
    }
  }

  /** Whether the part's bounding box meets the box with these corners. */
  #meets(corners: Float64Array, at: number): boolean {
    const reach = this.#reach;
    for (let axis = 0; axis < 3; axis++) {
      if ((corners[at + axis] as number) > (reach[3 + axis] as number)) return false;
      if ((corners[at + 3 + axis] as number) < (reach[axis] as number)) return false;
    }
    return true;
  }
}

const ALONG = new Float64Array(3);
const crossings = new Float64Array(8);

/**
 * The exact distance between a segment (six values at `at`) and a box (its corners at `boxAt`).
 *
 * Along the segment p(t) the squared distance is convex and piecewise quadratic; its pieces meet
 * where p crosses a face plane. Half its derivative rises monotonically and is linear in between:
 * the last crossing where it is not positive and the first where it is not negative enclose the
 * minimum.
 */
export function segmentBoxDistanceM(
  segments: Float64Array,
  at: number,
  corners: Float64Array,
  boxAt: number,
): number {
  crossings.fill(0);
  crossings[7] = 1;
  for (let axis = 0; axis < 3; axis++) {
    const start = segments[at + axis] as number;
    const along = (segments[at + 3 + axis] as number) - start;
    ALONG[axis] = along;
    if (along === 0) continue;
    crossings[1 + axis] = clipped(((corners[boxAt + axis] as number) - start) / along, 0, 1);
    crossings[4 + axis] = clipped(((corners[boxAt + 3 + axis] as number) - start) / along, 0, 1);
  }
  let tLow = 0;
  let tHigh = 1;
  let slopeLow = -Infinity;
  let slopeHigh = Infinity;
  for (let index = 0; index < 8; index++) {
    const t = crossings[index] as number;
    let slope = 0;
    for (let axis = 0; axis < 3; axis++) {
      slope += outside(segments, at, corners, boxAt, axis, t) * (ALONG[axis] as number);
    }
    if (slope <= 0) {
      tLow = Math.max(tLow, t);
      slopeLow = Math.max(slopeLow, slope);
    }
    if (slope >= 0) {
      tHigh = Math.min(tHigh, t);
      slopeHigh = Math.min(slopeHigh, slope);
    }
  }
  const isEnclosed =
    Number.isFinite(slopeLow) && Number.isFinite(slopeHigh) && slopeHigh > slopeLow;
  const share = isEnclosed ? -slopeLow / (slopeHigh - slopeLow) : 0;
  // If the distance only increases, the minimum is at 0; if it only decreases, at 1: both are tLow.
  const best = tLow + share * (tHigh - tLow);
  let squared = 0;
  for (let axis = 0; axis < 3; axis++) {
    const off = outside(segments, at, corners, boxAt, axis, best);
    squared += off * off;
  }
  return Math.sqrt(squared);
}

/** How far the point at `t` is outside the box along one axis, signed. */
function outside(
  segments: Float64Array,
  at: number,
  corners: Float64Array,
  boxAt: number,
  axis: number,
  t: number,
): number {
  const point = (segments[at + axis] as number) + t * (ALONG[axis] as number);
  return (
    point - clipped(point, corners[boxAt + axis] as number, corners[boxAt + 3 + axis] as number)
  );
}

const clipped = (value: number, low: number, high: number): number =>
  Math.min(Math.max(value, low), high);
