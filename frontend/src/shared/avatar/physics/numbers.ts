/** Arithmetic on quaternions (w, x, y, z) in place, in arrays that are made once. */

export const TURN = 2 * Math.PI;

/** The nearest whole number; of two, the even one, as in Python and IEEE 754. */
export function roundHalfEven(value: number): number {
  const near = Math.round(value);
  return near - value === 0.5 && near % 2 !== 0 ? near - 1 : near;
}

export const clamp = (value: number, low: number, high: number): number =>
  Math.min(Math.max(value, low), high);

/** Write a b, from row `a` of one array and row `b` of another, to row `into`; they may be one. */
export const multiplyRows = productWriter(1);

/** Write a^-1 b: parent_from_joint for a = world_from_parent, b = world_from_joint. */
export const inverseMultiplyRows = productWriter(-1);

type RowWriter = (
  first: Float64Array,
  a: number,
  second: Float64Array,
  b: number,
  result: Float64Array,
  into: number,
) => void;

/** `sign` is -1 to take the first quaternion's conjugate, which is its inverse. */
function productWriter(sign: 1 | -1): RowWriter {
  return (first, a, second, b, result, into) => {
    const aw = first[a] as number;
    const ax = sign * (first[a + 1] as number);
    const ay = sign * (first[a + 2] as number);
    const az = sign * (first[a + 3] as number);
    const bw = second[b] as number;
    const bx = second[b + 1] as number;
    const by = second[b + 2] as number;
    const bz = second[b + 3] as number;
    result[into] = aw * bw - ax * bx - ay * by - az * bz;
    result[into + 1] = aw * bx + ax * bw + ay * bz - az * by;
    result[into + 2] = aw * by - ax * bz + ay * bw + az * bx;
    result[into + 3] = aw * bz + ax * by - ay * bx + az * bw;
  };
}

const SMALL_ANGLE_RAD = 1e-6;

/**
 * Interpolate a rotation from `a` (fraction 0) to `b` (1) at constant speed on the shorter arc: the
 * server's `rotations.arrays.slerp`.
 */
export function slerpRows(
  first: Float64Array,
  a: number,
  second: Float64Array,
  b: number,
  fraction: number,
  result: Float64Array,
  into: number,
): void {
  let cosine = 0;
  for (let i = 0; i < 4; i++) cosine += (first[a + i] as number) * (second[b + i] as number);
  const sign = cosine < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(sign * cosine, 1));
  const sine = Math.sin(angle);
  const straight = sine < SMALL_ANGLE_RAD;
  const weightA = straight ? 1 - fraction : Math.sin((1 - fraction) * angle) / sine;
  const weightB = sign * (straight ? fraction : Math.sin(fraction * angle) / sine);
  for (let i = 0; i < 4; i++) {
    result[into + i] = weightA * (first[a + i] as number) + weightB * (second[b + i] as number);
  }
}
