/** Places (position and rotation) as frames of reference, and as WebXR's matrices and poses. */
import type { Place } from "@shared/avatar/hips";
import {
  fromAxes,
  length,
  normalised,
  plus,
  type Quaternion,
  rotate,
  times,
  type Vector,
} from "@shared/rotations";

export const AT_ORIGIN: Place = { positionM: [0, 0, 0], rotation: [1, 0, 0, 0] };
const UP: Vector = [0, 1, 0];
const TINY = 1e-9;

export const conjugate = ([w, x, y, z]: Quaternion): Quaternion => [w, -x, -y, -z];

/**
 * world_from_b, of world_from_a and a_from_b: `plus(a, rotate(a, b))` and `normalised(multiply(a,
 * b))`, written out because every tracked part takes it in every frame, and each step of it would
 * leave an array behind.
 */
export function composed(a: Place, b: Place): Place {
  const [aw, ax, ay, az] = a.rotation;
  const [bw, bx, by, bz] = b.rotation;
  const [vx, vy, vz] = b.positionM;
  const cx = 2 * (ay * vz - az * vy);
  const cy = 2 * (az * vx - ax * vz);
  const cz = 2 * (ax * vy - ay * vx);
  const w = aw * bw - ax * bx - ay * by - az * bz;
  const x = aw * bx + ax * bw + ay * bz - az * by;
  const y = aw * by - ax * bz + ay * bw + az * bx;
  const z = aw * bz + ax * by - ay * bx + az * bw;
  const scale = 1 / Math.sqrt(w * w + x * x + y * y + z * z);
  return {
    positionM: [
      a.positionM[0] + (vx + aw * cx + ay * cz - az * cy),
      a.positionM[1] + (vy + aw * cy + az * cx - ax * cz),
      a.positionM[2] + (vz + aw * cz + ax * cy - ay * cx),
    ],
    rotation: [w * scale, x * scale, y * scale, z * scale],
  };
}

export function inverted({ positionM, rotation }: Place): Place {
  const back = conjugate(rotation);
  return { positionM: times(rotate(back, positionM), -1), rotation: back };
}

/** The rotation on the shorter way from `a` (0) to `b` (1). */
export function blendedRotation(a: Quaternion, b: Quaternion, share: number): Quaternion {
  const dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const angle = Math.acos(Math.min(1, Math.abs(dot)));
  const sine = Math.sin(angle);
  const near = sine < 1e-6;
  const from = near ? 1 - share : Math.sin((1 - share) * angle) / sine;
  const to = (near ? share : Math.sin(share * angle) / sine) * (dot < 0 ? -1 : 1);
  return normalised([
    from * a[0] + to * b[0],
    from * a[1] + to * b[1],
    from * a[2] + to * b[2],
    from * a[3] + to * b[3],
  ]);
}

/** The place on the way from `a` (0) to `b` (1). */
export const blended = (a: Place, b: Place, share: number): Place => ({
  positionM: plus(times(a.positionM, 1 - share), times(b.positionM, share)),
  rotation: blendedRotation(a.rotation, b.rotation, share),
});

/** A rotation about a unit axis, right-handed. */
export function turned(axis: Vector, angleRad: number): Quaternion {
  const sine = Math.sin(angleRad / 2);
  return [Math.cos(angleRad / 2), sine * axis[0], sine * axis[1], sine * axis[2]];
}

/** The smallest rotation that turns the unit vector `from` to the unit vector `to`. */
export function rotationTo(from: Vector, to: Vector): Quaternion {
  const [ax, ay, az] = from;
  const [bx, by, bz] = to;
  const w = 1 + ax * bx + ay * by + az * bz;
  // Opposite vectors: half a turn about any axis across them.
  if (w < TINY)
    return Math.abs(ax) < 0.9
      ? turned(across(from, [1, 0, 0]), Math.PI)
      : turned(across(from, UP), Math.PI);
  return normalised([w, ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]);
}

function across(v: Vector, other: Vector): Vector {
  const along = v[0] * other[0] + v[1] * other[1] + v[2] * other[2];
  const rest = plus(other, times(v, -along));
  return times(rest, 1 / length(rest));
}

/** The heading of a place: its turn about the vertical, by where its -z looks on the floor. */
export function headingOf({ rotation }: Place): number {
  const [x, , z] = rotate(rotation, [0, 0, -1]);
  return Math.hypot(x, z) < TINY ? 0 : Math.atan2(-x, -z);
}

/** The upright frame on the floor at (x, z), turned by a heading. */
export const onFloor = (x: number, z: number, headingRad: number): Place => ({
  positionM: [x, 0, z],
  rotation: turned(UP, headingRad),
});

/** The place of a pose as WebXR gives it. */
export function placeOf(transform: XRRigidTransform): Place {
  const { position, orientation } = transform;
  return {
    positionM: [position.x, position.y, position.z],
    rotation: [orientation.w, orientation.x, orientation.y, orientation.z],
  };
}

/** The place of a rigid transform: 16 numbers, column by column, from `at` on. */
export function placeAt(matrix: ArrayLike<number>, at = 0): Place {
  const axis = (column: number): Vector => [
    matrix[at + 4 * column] as number,
    matrix[at + 4 * column + 1] as number,
    matrix[at + 4 * column + 2] as number,
  ];
  return { positionM: axis(3), rotation: normalised(fromAxes(axis(0), axis(1), axis(2))) };
}

/** Write the place as the 16 numbers of a transform, column by column. */
export function writeMatrix(into: { [index: number]: number }, place: Place): void {
  const { positionM, rotation } = place;
  for (const [column, axis] of (
    [
      [1, 0, 0],
      [0, 1, 0],
      [0, 0, 1],
    ] as const
  ).entries()) {
    const [x, y, z] = rotate(rotation, axis);
    into[4 * column] = x;
    into[4 * column + 1] = y;
    into[4 * column + 2] = z;
    into[4 * column + 3] = 0;
  }
  for (const [index, value] of positionM.entries()) into[12 + index] = value;
  into[15] = 1;
}
