/**
 * A body in the angles of its axes, and the plane, limits and place of each axis in that pose.
 *
 * An axis turns its part about a direction that is fixed in the part's frame, and carries the axes
 * after it (`app/science/avatar/body/parts.py`): the rotation of a part in its parent's frame is
 * the product of its axes' rotations, outermost first.
 */
import { AXES, PARTS } from "@shared/avatar/anatomy.generated";
import {
  cross,
  dot,
  length,
  multiply,
  type Quaternion,
  rotate,
  times,
  type Vector,
} from "@shared/rotations";
import { type BodyBinding, numbersOf, type Parts } from "@shared/stage/skin/pose";
import type { AvatarFile } from "./axes";

/** Degrees by axis name; an axis that is left out is as near to the T-pose as its limits allow. */
export type Angles = ReadonlyMap<string, number>;

/** One axis in a pose; vectors are in the world, of length one, at right angles to each other. */
export interface PlacedAxis {
  readonly axis: string;
  readonly part: string;
  readonly anchorM: Vector;
  readonly direction: Vector;
  /** Where the part points at an angle of zero, within the plane in which it turns. */
  readonly zero: Vector;
  readonly lowDeg: number;
  readonly highDeg: number;
  readonly angleDeg: number;
  /** Radius at which its limits are drawn, metres. */
  readonly radiusM: number;
}

export const JOINTS: readonly string[] = PARTS.map(({ name }) => name);
export const PARENTS: readonly number[] = PARTS.map(({ parent }) => JOINTS.indexOf(parent ?? ""));
const AXES_OF: ReadonlyMap<string, readonly (typeof AXES)[number][]> = new Map(
  JOINTS.map((joint) => [joint, AXES.filter(({ part }) => part === joint)]),
);

/** The permitted angle nearest to the chosen one; in a cast, the angle at which it holds. */
export function angleOf(configuration: AvatarFile, angles: Angles, axis: string): number {
  const settings = configuration.axes[axis];
  if (settings === undefined) return 0;
  const wished = configuration.held_deg[axis] ?? angles.get(axis) ?? 0;
  return Math.min(Math.max(wished, settings.low_deg), settings.high_deg);
}

const turn = (direction: Vector, angleDeg: number): Quaternion => {
  const half = (angleDeg * Math.PI) / 360;
  return [Math.cos(half), ...times(direction, Math.sin(half))] as unknown as Quaternion;
};

/** The hips' place and the rotation of every part, as a stage reads a pose. */
export function poseValues(configuration: AvatarFile, angles: Angles, hipsM: Vector): Float32Array {
  const values = new Float32Array(numbersOf(JOINTS));
  values.set(hipsM);
  JOINTS.forEach((part, joint) => {
    const local = (AXES_OF.get(part) ?? []).reduce<Quaternion>(
      (before, { name, direction }) =>
        multiply(before, turn(direction, angleOf(configuration, angles, name))),
      [1, 0, 0, 0],
    );
    values.set(local, 3 + 4 * joint);
  });
  return values;
}

/** The axes of a body in its present pose, by name; `parts` have been placed in it. */
export function placedAxes(
  configuration: AvatarFile,
  angles: Angles,
  binding: BodyBinding,
  parts: Parts,
): ReadonlyMap<string, PlacedAxis> {
  const placed = new Map<string, PlacedAxis>();
  binding.parts.forEach((part, index) => {
    const axes = AXES_OF.get(part) ?? [];
    const bone = boneOf(binding, index);
    const parent = binding.parents[index] ?? -1;
    let frame = quaternionAt(parts.rotations, parent);
    const anchorM = vectorAt(parts.places, index);
    for (const { name, direction } of axes) {
      const settings = configuration.axes[name];
      if (settings === undefined) continue;
      const angleDeg = angleOf(configuration, angles, name);
      placed.set(name, {
        axis: name,
        part,
        anchorM,
        direction: rotate(frame, direction),
        zero: rotate(frame, zeroOf(direction, bone)),
        lowDeg: settings.low_deg,
        highDeg: settings.high_deg,
        angleDeg,
        radiusM: parts.scale * radiusOf(part, bone),
      });
      frame = multiply(frame, turn(direction, angleDeg));
    }
  });
  return placed;
}

/** From the part's joint to that of its first child, metres in the T-pose; zeros at an end. */
function boneOf({ parents, joints_m }: BodyBinding, part: number): Vector {
  const child = parents.indexOf(part);
  const [from = [], to = []] = [joints_m[part], joints_m[child]];
  if (child < 0) return [0, 0, 0];
  return [0, 1, 2].map((axis) => (to[axis] ?? 0) - (from[axis] ?? 0)) as unknown as Vector;
}

/** A share of the bone this small lies along the axis: the axis twists the part. */
const TWISTS = 0.5;
const CANDIDATES: readonly Vector[] = [
  [0, 0, -1],
  [0, 1, 0],
  [1, 0, 0],
];

/** The direction of the bone across the axis, or where it twists, ahead or up. */
function zeroOf(direction: Vector, bone: Vector): Vector {
  const along = length(bone);
  const across = perpendicular(bone, direction);
  if (along > 1e-6 && length(across) > TWISTS * along) return times(across, 1 / length(across));
  const other = CANDIDATES.find((one) => Math.abs(dot(one, direction)) < TWISTS) ?? [1, 0, 0];
  const free = perpendicular(other, direction);
  return times(free, 1 / length(free));
}

/** What of a vector is at right angles to a direction. */
function perpendicular(vector: Vector, direction: Vector): Vector {
  const along = dot(vector, direction);
  return [
    vector[0] - along * direction[0],
    vector[1] - along * direction[1],
    vector[2] - along * direction[2],
  ];
}

const isFinger = (part: string): boolean => /(Proximal|Intermediate|Distal)$/.test(part);

/** In proportion to the part, so that the arcs of neighbours do not cover each other. */
function radiusOf(part: string, bone: Vector): number {
  if (isFinger(part)) return 0.035;
  return Math.min(0.24, Math.max(0.12, 0.7 * length(bone)));
}

const vectorAt = (values: Float64Array, at: number): Vector => [
  values[3 * at] ?? 0,
  values[3 * at + 1] ?? 0,
  values[3 * at + 2] ?? 0,
];

const quaternionAt = (values: Float64Array, at: number): Quaternion =>
  at < 0
    ? [1, 0, 0, 0]
    : [
        values[4 * at] ?? 1,
        values[4 * at + 1] ?? 0,
        values[4 * at + 2] ?? 0,
        values[4 * at + 3] ?? 0,
      ];

/** The point at an angle on the circle of an axis, metres in the world. */
export function onArc(placed: PlacedAxis, angleDeg: number, radiusM = placed.radiusM): Vector {
  const { anchorM, direction, zero } = placed;
  const side = cross(direction, zero);
  const angle = (angleDeg * Math.PI) / 180;
  const [c, s] = [radiusM * Math.cos(angle), radiusM * Math.sin(angle)];
  return [
    anchorM[0] + c * zero[0] + s * side[0],
    anchorM[1] + c * zero[1] + s * side[1],
    anchorM[2] + c * zero[2] + s * side[2],
  ];
}

/** The angle in degrees, from -180 to 180, of a point in the plane of an axis. */
export function angleAt(placed: PlacedAxis, point: Vector): number {
  const from: Vector = [
    point[0] - placed.anchorM[0],
    point[1] - placed.anchorM[1],
    point[2] - placed.anchorM[2],
  ];
  const side = cross(placed.direction, placed.zero);
  return (Math.atan2(dot(from, side), dot(from, placed.zero)) * 180) / Math.PI;
}
