/**
 * The best step within bounds: minimise x'Hx/2 - b'x with low <= x <= high.
 *
 * The server's `app/science/avatar/ik/bounded_step.py` explains the method; source: block principal
 * pivoting, Judice and Pires (1994), Computers & Operations Research 21(5), 587-596.
 */
import { solveInPlace, writeResidual } from "./linear";

const MAX_PASSES = 200;
const SPARE_ATTEMPTS = 3;
const TOLERANCE = 1e-12;
const FREE = 0;
const AT_LOW = -1;
const AT_HIGH = 1;

/** The best step of a problem that is solved only once. */
export function boundedStep(
  hessian: Float64Array,
  pull: Float64Array,
  low: Float64Array,
  high: Float64Array,
): Float64Array {
  return new BoundedStep(pull.length).solve(hessian, pull, low, high);
}

/** Solves problems of one size without allocating anything: it does so twice in every frame. */
export class BoundedStep {
  private readonly step: Float64Array;
  private readonly left: Float64Array;
  private readonly matrix: Float64Array;
  private readonly right: Float64Array;
  private readonly sides: Int8Array;
  private readonly free: Int32Array;
  /** Unknowns that are on the wrong side, each with its new one. */
  private readonly wrong: Int32Array;
  private readonly better: Int8Array;

  constructor(private readonly size: number) {
    this.step = new Float64Array(size);
    this.left = new Float64Array(size);
    this.matrix = new Float64Array(size * size);
    this.right = new Float64Array(size);
    this.sides = new Int8Array(size);
    this.free = new Int32Array(size);
    this.wrong = new Int32Array(size);
    this.better = new Int8Array(size);
  }

  /** The best step; the array is used again by the next call. */
  solve(
    hessian: Float64Array,
    pull: Float64Array,
    low: Float64Array,
    high: Float64Array,
  ): Float64Array {
    const { size, sides, step, left, wrong, better } = this;
    sides.fill(FREE);
    this.solveFree(hessian, pull, low, high);
    let fewest = size + 1;
    let spare = SPARE_ATTEMPTS;
    for (let pass = 0; pass < MAX_PASSES; pass++) {
      writeResidual(hessian, pull, step, left);
      const changes = this.findWrong(low, high);
      if (changes === 0) break;
      let first = 0;
      if (changes < fewest) {
        fewest = changes;
        spare = SPARE_ATTEMPTS;
      } else if (spare > 0) spare -= 1;
      else first = changes - 1;
      for (let at = first; at < changes; at++) {
        sides[wrong[at] as number] = better[at] as number;
      }
      this.solveFree(hessian, pull, low, high);
    }
    for (let i = 0; i < size; i++) {
      step[i] = Math.min(Math.max(step[i] as number, low[i] as number), high[i] as number);
    }
    return step;
  }

  /**
   * Find the unknowns that are on the wrong side: free ones that left their bounds, and held ones
   * that are pulled inwards. Returns how many there are.
   */
  private findWrong(low: Float64Array, high: Float64Array): number {
    const { size, sides, step, left, wrong, better } = this;
    let found = 0;
    for (let i = 0; i < size; i++) {
      const side = sides[i];
      const drawn = left[i] as number;
      const value = step[i] as number;
      let next = side;
      if (side === AT_LOW && drawn > TOLERANCE) next = FREE;
      else if (side === AT_HIGH && drawn < -TOLERANCE) next = FREE;
      else if (side === FREE && value < (low[i] as number) - TOLERANCE) next = AT_LOW;
      else if (side === FREE && value > (high[i] as number) + TOLERANCE) next = AT_HIGH;
      if (next === side) continue;
      wrong[found] = i;
      better[found] = next as number;
      found++;
    }
    return found;
  }

  /** Solve for the free unknowns with the others at their bounds. */
  private solveFree(
    hessian: Float64Array,
    pull: Float64Array,
    low: Float64Array,
    high: Float64Array,
  ): void {
    const { size, sides, step, left, matrix, right, free } = this;
    let count = 0;
    for (let i = 0; i < size; i++) {
      if (sides[i] === FREE) {
        free[count] = i;
        step[i] = 0;
        count++;
      } else step[i] = (sides[i] === AT_LOW ? low[i] : high[i]) as number;
    }
    writeResidual(hessian, pull, step, left);
    for (let i = 0; i < count; i++) {
      const row = free[i] as number;
      right[i] = left[row] as number;
      for (let j = 0; j <= i; j++) {
        matrix[i * count + j] = hessian[row * size + (free[j] as number)] as number;
      }
    }
    solveInPlace(matrix, right, count);
    for (let i = 0; i < count; i++) step[free[i] as number] = right[i] as number;
  }
}
