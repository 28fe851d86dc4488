/**
 * The best step within bounds: minimise x'Hx/2 - b'x with low <= x <= high.
 *
 * The server's `app/science/avatar/ik/bounded_step.py` explains the method; source: block principal
 * pivoting, Judice and Pires (1994), Computers & Operations Research 21(5), 587-596.
 */
import { residual, solveInPlace } from "./linear";

const MAX_PASSES = 200;
const SPARE_ATTEMPTS = 3;
const TOLERANCE = 1e-12;
const FREE = 0;
const AT_LOW = -1;
const AT_HIGH = 1;

export function boundedStep(
  hessian: Float64Array,
  pull: Float64Array,
  low: Float64Array,
  high: Float64Array,
): Float64Array {
  const sides = new Int8Array(pull.length);
  let step = solveFree(hessian, pull, sides, low, high);
  let fewest = pull.length + 1;
  let spare = SPARE_ATTEMPTS;
  for (let pass = 0; pass < MAX_PASSES; pass++) {
    const changes = violations(sides, residual(hessian, pull, step), step, low, high);
    const last = changes.at(-1);
    if (last === undefined) break;
    let applied = changes;
    if (changes.length < fewest) {
      fewest = changes.length;
      spare = SPARE_ATTEMPTS;
    } else if (spare > 0) spare -= 1;
    else applied = [last];
    for (const [i, side] of applied) sides[i] = side;
    step = solveFree(hessian, pull, sides, low, high);
  }
  return step.map((value, i) => Math.min(Math.max(value, low[i] as number), high[i] as number));
}

/**
 * The unknowns that are on the wrong side, each with its new side: free ones that left their
 * bounds, and held ones that are pulled inwards.
 */
function violations(
  sides: Int8Array,
  left: Float64Array,
  step: Float64Array,
  low: Float64Array,
  high: Float64Array,
): readonly (readonly [number, number])[] {
  const found: [number, number][] = [];
  for (let i = 0; i < sides.length; i++) {
    const side = sides[i];
    const drawn = left[i] as number;
    const value = step[i] as number;
    if (side === AT_LOW && drawn > TOLERANCE) found.push([i, FREE]);
    else if (side === AT_HIGH && drawn < -TOLERANCE) found.push([i, FREE]);
    else if (side === FREE && value < (low[i] as number) - TOLERANCE) found.push([i, AT_LOW]);
    else if (side === FREE && value > (high[i] as number) + TOLERANCE) found.push([i, AT_HIGH]);
  }
  return found;
}

function solveFree(
  hessian: Float64Array,
  pull: Float64Array,
  sides: Int8Array,
  low: Float64Array,
  high: Float64Array,
): Float64Array {
  const n = pull.length;
  const step = new Float64Array(n);
  const free: number[] = [];
  for (let i = 0; i < n; i++) {
    if (sides[i] === FREE) free.push(i);
    else step[i] = (sides[i] === AT_LOW ? low[i] : high[i]) as number;
  }
  const rest = residual(hessian, pull, step);
  const matrix = new Float64Array(free.length * free.length);
  const right = new Float64Array(free.length);
  free.forEach((row, i) => {
    right[i] = rest[row] as number;
    for (let j = 0; j <= i; j++) {
      matrix[i * free.length + j] = hessian[row * n + (free[j] as number)] as number;
    }
  });
  solveInPlace(matrix, right);
  free.forEach((row, i) => {
    step[row] = right[i] as number;
  });
  return step;
}
