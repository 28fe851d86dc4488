/**
 * A participant's skeleton, and where its joints are in a pose: the server's
 * `app/science/skeleton`, whose fractions of the stature and their sources these are.
 *
 * Rest pose: the T-pose, every local rotation the identity, world axes x right, y up, -z forward. A
 * pose is what the streams carry: root position x, y, z, then 22 local rotations w, x, y, z.
 */
import { JOINTS, JOINT_PARENTS as PARENTS } from "@shared/avatar/anatomy.generated";
import { multiply, plus, type Quaternion, rotate, times, type Vector } from "@shared/rotations";

export { JOINTS, PARENTS };
export type Joint = (typeof JOINTS)[number];

export const POSE_VALUES = 3 + 4 * JOINTS.length;
export const INDEX = Object.fromEntries(JOINTS.map((name, index) => [name, index])) as Readonly<
  Record<Joint, number>
>;

// Positions in the T-pose as fractions of the stature; arms from the shoulder joint on, apart.
const CENTRE: Readonly<Record<string, Vector>> = {
  Hips: [0, 0.545, 0],
  Spine: [0, 0.585, 0],
  Chest: [0, 0.655, 0],
  UpperChest: [0, 0.725, 0],
  Neck: [0, 0.835, 0],
  Head: [0, 0.875, 0],
};
const RIGHT: Readonly<Record<string, Vector>> = {
  Shoulder: [0.02, 0.81, 0],
  UpperArm: [0.129, 0.818, 0],
  UpperLeg: [0.05, 0.53, 0],
  LowerLeg: [0.05, 0.285, 0],
  Foot: [0.05, 0.039, 0],
  Toes: [0.05, 0.014, -0.072],
};
const SHOULDER = 0.129;
export const UPPER_ARM = 0.186;
export const FOREARM = 0.146;
export const HAND = 0.108;
const LOWEST_M = 0.5;
const HIGHEST_M = 2.6;

export interface Skeleton {
  readonly statureM: number;
  /** From finger tip to finger tip in the T-pose. */
  readonly spanM: number;
  /** Each joint in its parent's frame; the hips' are above the floor. */
  readonly offsetsM: readonly Vector[];
  readonly upperArmM: number;
  readonly forearmM: number;
  /** From the wrist to the tip of the middle finger. */
  readonly handM: number;
  readonly thighM: number;
  readonly shankM: number;
  readonly ankleHeightM: number;
  readonly standingHipsM: number;
}

/** The span of the product's skeleton, whose arms are fractions of the stature. */
export const usualSpanM = (statureM: number): number =>
  2 * (SHOULDER + UPPER_ARM + FOREARM + HAND) * statureM;

/** The upper arm and forearm of a body with these lengths, as multiples of the usual ones. */
export const armStretchOf = (armM: number, statureM: number): number =>
  armM / ((UPPER_ARM + FOREARM) * statureM);

/**
 * The skeleton of a person of this stature; another span makes upper arms and forearms longer or
 * shorter. Hands are of the usual length: of all bones of the arm it varies least with the span.
 *
 * Throws RangeError for a stature outside 0.5 to 2.6 m, or a span that leaves no arms.
 */
export function skeletonOf(statureM: number, spanM = usualSpanM(statureM)): Skeleton {
  if (!(statureM >= LOWEST_M && statureM <= HIGHEST_M)) {
    throw new RangeError(
      `A stature of ${statureM} m is outside ${LOWEST_M} to ${HIGHEST_M} m: give metres.`,
    );
  }
  const stretch = armStretchOf(spanM / 2 - (SHOULDER + HAND) * statureM, statureM);
  if (!(stretch > 0.3 && stretch < 3)) {
    throw new RangeError(`A span of ${spanM} m does not fit a stature of ${statureM} m.`);
  }
  const places = JOINTS.map((name) => times(restOf(name, stretch), statureM));
  const lengthM = (fraction: number) => fraction * stretch * statureM;
  return {
    statureM,
    spanM,
    offsetsM: places.map((place, joint) => {
      const parent = places[PARENTS[joint] as number];
      return parent === undefined ? place : plus(place, times(parent, -1));
    }),
    upperArmM: lengthM(UPPER_ARM),
    forearmM: lengthM(FOREARM),
    handM: HAND * statureM,
    thighM: 0.245 * statureM,
    shankM: 0.246 * statureM,
    ankleHeightM: 0.039 * statureM,
    standingHipsM: 0.545 * statureM,
  };
}

/** Where a joint is in the T-pose of somebody 1 m tall; with `armStretch` the arms are longer. */
export function restOf(name: Joint, armStretch = 1): Vector {
  const centre = CENTRE[name];
  if (centre !== undefined) return centre;
  const part = name.replace(/^(Left|Right)/, "");
  const sign = name.startsWith("Left") ? -1 : 1;
  const shoulder = RIGHT.UpperArm as Vector;
  const along = { LowerArm: UPPER_ARM, Hand: UPPER_ARM + FOREARM }[part];
  const [x, y, z] =
    along === undefined ? (RIGHT[part] as Vector) : plus(shoulder, [along * armStretch, 0, 0]);
  return [sign * x, y, z];
}

/** Where every joint of a body is: positions and world_from_joint, by `INDEX`. */
export interface JointPlaces {
  readonly positionsM: Vector[];
  readonly rotations: Quaternion[];
}

export const jointPlaces = (): JointPlaces => ({
  positionsM: JOINTS.map((): Vector => [0, 0, 0]),
  rotations: JOINTS.map((): Quaternion => [1, 0, 0, 0]),
});

/** Place the joints for a root position and local rotations. */
export function placeJoints(
  { offsetsM }: Skeleton,
  rootM: Vector,
  local: readonly Quaternion[],
  into: JointPlaces,
): void {
  const { positionsM, rotations } = into;
  positionsM[0] = rootM;
  rotations[0] = local[0] as Quaternion;
  for (let joint = 1; joint < JOINTS.length; joint++) {
    const parent = PARENTS[joint] as number;
    const above = rotations[parent] as Quaternion;
    positionsM[joint] = plus(
      positionsM[parent] as Vector,
      rotate(above, offsetsM[joint] as Vector),
    );
    rotations[joint] = multiply(above, local[joint] as Quaternion);
  }
}
