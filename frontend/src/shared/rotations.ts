/** Vectors and unit quaternions (w, x, y, z) of single frames; the server's `rotations.scalars`. */

export type Vector = readonly [number, number, number];
export type Quaternion = readonly [number, number, number, number];

const TINY = 1e-12;

export const plus = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (v: Vector, by: number): Vector => [v[0] * by, v[1] * by, v[2] * by];
export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (v: Vector): number => Math.sqrt(dot(v, v));
export const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** The product a b: the rotation b followed by the rotation a. */
export function multiply(a: Quaternion, b: Quaternion): Quaternion {
  const [aw, ax, ay, az] = a;
  const [bw, bx, by, bz] = b;
  return [
    aw * bw - ax * bx - ay * by - az * bz,
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
  ];
}

export function rotate(q: Quaternion, v: Vector): Vector {
  const [w, x, y, z] = q;
  const [vx, vy, vz] = v;
  const cx = 2 * (y * vz - z * vy);
  const cy = 2 * (z * vx - x * vz);
  const cz = 2 * (x * vy - y * vx);
  return [
    vx + w * cx + y * cz - z * cy,
    vy + w * cy + z * cx - x * cz,
    vz + w * cz + x * cy - y * cx,
  ];
}

export function normalised(q: Quaternion): Quaternion {
  const [w, x, y, z] = q;
  const scale = 1 / Math.sqrt(w * w + x * x + y * y + z * z);
  return [w * scale, x * scale, y * scale, z * scale];
}

/**
 * The rotation whose matrix has these orthonormal, right-handed columns.
 *
 * Source: Shepperd (1978), J. Guidance and Control 1:223-224: divide by the largest component, so
 * that no digits are lost.
 */
export function fromAxes(xAxis: Vector, yAxis: Vector, zAxis: Vector): Quaternion {
  const [m00, m10, m20] = xAxis;
  const [m01, m11, m21] = yAxis;
  const [m02, m12, m22] = zAxis;
  const trace = m00 + m11 + m22;
  if (trace > m00 && trace > m11 && trace > m22) {
    const s = 2 * Math.sqrt(1 + trace);
    return [0.25 * s, (m21 - m12) / s, (m02 - m20) / s, (m10 - m01) / s];
  }
  if (m00 >= m11 && m00 >= m22) {
    const s = 2 * Math.sqrt(1 + m00 - m11 - m22);
    return [(m21 - m12) / s, 0.25 * s, (m01 + m10) / s, (m02 + m20) / s];
  }
  if (m11 >= m22) {
    const s = 2 * Math.sqrt(1 + m11 - m00 - m22);
    return [(m02 - m20) / s, (m01 + m10) / s, 0.25 * s, (m12 + m21) / s];
  }
  const s = 2 * Math.sqrt(1 + m22 - m00 - m11);
  return [(m10 - m01) / s, (m02 + m20) / s, (m12 + m21) / s, 0.25 * s];
}

/** The rotation vector, in the world, that rotates `current` to `goal`; at most pi long. */
export function rotationBetween(current: Quaternion, goal: Quaternion): Vector {
  const [w, x, y, z] = current;
  const [dw, dx, dy, dz] = multiply(goal, [w, -x, -y, -z]);
  const sign = dw < 0 ? -1 : 1;
  const sine = Math.sqrt(dx * dx + dy * dy + dz * dz);
  const factor = sign * (sine > TINY ? (2 * Math.atan2(sine, sign * dw)) / sine : 2);
  return [factor * dx, factor * dy, factor * dz];
}

/** `rotationBetween` the quaternion at `at` in `values` and `goal`, written into an array. */
export function writeRotationBetween(
  values: Float64Array,
  at: number,
  [aw, ax, ay, az]: Quaternion,
  into: Float64Array,
  start: number,
): void {
  const bw = values[at] as number;
  const bx = -(values[at + 1] as number);
  const by = -(values[at + 2] as number);
  const bz = -(values[at + 3] as number);
  const dw = aw * bw - ax * bx - ay * by - az * bz;
  const dx = aw * bx + ax * bw + ay * bz - az * by;
  const dy = aw * by - ax * bz + ay * bw + az * bx;
  const dz = aw * bz + ax * by - ay * bx + az * bw;
  const sign = dw < 0 ? -1 : 1;
  const sine = Math.sqrt(dx * dx + dy * dy + dz * dz);
  const factor = sign * (sine > TINY ? (2 * Math.atan2(sine, sign * dw)) / sine : 2);
  into[start] = factor * dx;
  into[start + 1] = factor * dy;
  into[start + 2] = factor * dz;
}

/** `current` rotated by a rotation vector in the world. */
export function rotated(current: Quaternion, by: Vector): Quaternion {
  const [x, y, z] = by;
  const angle = Math.sqrt(x * x + y * y + z * z);
  const half = angle > TINY ? Math.sin(angle / 2) / angle : 0.5;
  return normalised(multiply([Math.cos(angle / 2), half * x, half * y, half * z], current));
}
