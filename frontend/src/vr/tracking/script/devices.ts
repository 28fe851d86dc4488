/**
 * The devices that a scripted person wears: where each is against the joint below it.
 *
 * Calibration has to find these offsets; its tests know them. All are in the joint's frame, in which
 * the T-pose has the world's axes.
 */
import type { Place } from "@shared/avatar/hips";
import { fromAxes, type Quaternion, type Vector } from "@shared/rotations";
import { AT_ORIGIN, composed, turned } from "../places";
import { INDEX, type Joint } from "../skeleton";
import type { GoalPart } from "../tracked";
import type { ScriptedPerson } from "./person";
import { type Random, seeded } from "./random";

/** joint_from_device of each part. */
export type WornOffsets = Readonly<Record<GoalPart, Place>>;

export interface WornOptions {
  readonly offsets?: WornOffsets;
  /** The two shins' devices, or the two hands', were exchanged. */
  readonly swapped?: "shins" | "hands" | null;
  /** Standard deviation of each device's position per axis, and of its tilt. */
  readonly noiseM?: number;
  readonly noiseRad?: number;
  readonly seed?: number;
}

const JOINT_OF: Readonly<Record<GoalPart, Joint>> = {
  Hips: "Hips",
  Head: "Head",
  LeftHand: "LeftHand",
  RightHand: "RightHand",
  LeftLowerLeg: "LeftLowerLeg",
  RightLowerLeg: "RightLowerLeg",
};
const UP: Vector = [0, 1, 0];
const OTHER: Readonly<Record<string, GoalPart>> = {
  LeftHand: "RightHand",
  RightHand: "LeftHand",
  LeftLowerLeg: "RightLowerLeg",
  RightLowerLeg: "LeftLowerLeg",
};

/**
 * Controllers held in fists, trackers in front of the shins, one at the back of the waist; the eyes
 * at .936 of the stature (Drillis and Contini 1966) and 9 cm in front of the head's joint.
 *
 * A grip's -z leads along the rod that a hand holds, towards the thumb, and its x to the right where
 * palms face each other (WebXR, `gripSpace`): the palms of the T-pose face down.
 */
export function usualOffsets(statureM: number): WornOffsets {
  const forwards: Vector = [0, 0, 1];
  const grip = (sign: number): Place => ({
    positionM: [sign * 0.07, -0.03, -0.01],
    rotation: fromAxes([0, sign, 0], [-sign, 0, 0], forwards),
  });
  const shin = (sign: number): Place => ({
    positionM: [sign * 0.012, -0.09 * statureM, -0.055],
    rotation: turned(UP, sign * 0.3),
  });
  return {
    Hips: { positionM: [0.02, 0.03, 0.12], rotation: turned(UP, Math.PI - 0.2) },
    Head: { positionM: [0, 0.061 * statureM, -0.09], rotation: [1, 0, 0, 0] },
    LeftHand: grip(-1),
    RightHand: grip(1),
    LeftLowerLeg: shin(-1),
    RightLowerLeg: shin(1),
  };
}

/** Offsets of nothing: devices in the joints themselves. */
export const NO_OFFSETS: WornOffsets = {
  Hips: AT_ORIGIN,
  Head: AT_ORIGIN,
  LeftHand: AT_ORIGIN,
  RightHand: AT_ORIGIN,
  LeftLowerLeg: AT_ORIGIN,
  RightLowerLeg: AT_ORIGIN,
};

/** Where the devices of a person are. */
export class WornDevices {
  readonly offsets: WornOffsets;
  private readonly random: Random;

  constructor(
    private readonly person: ScriptedPerson,
    private readonly options: WornOptions = {},
  ) {
    this.offsets = options.offsets ?? usualOffsets(person.skeleton.statureM);
    this.random = seeded(options.seed ?? 1);
  }

  /** The pose of the device at a part; `Head` is that of the eyes. */
  place(part: GoalPart): Place {
    const joint = INDEX[JOINT_OF[this.wearerOf(part)]];
    const { positionsM, rotations } = this.person.joints;
    const place = composed(
      { positionM: positionsM[joint] as Vector, rotation: rotations[joint] as Quaternion },
      this.offsets[part],
    );
    const { noiseM = 0, noiseRad = 0 } = this.options;
    if (noiseM === 0 && noiseRad === 0) return place;
    const drawn = (size: number): Vector => [
      size * this.random.normal(),
      size * this.random.normal(),
      size * this.random.normal(),
    ];
    const [x, y, z] = drawn(noiseRad);
    return composed(place, {
      positionM: drawn(noiseM),
      rotation: [Math.sqrt(Math.max(0, 1 - (x * x + y * y + z * z) / 4)), x / 2, y / 2, z / 2],
    });
  }

  /** The part that wears the device that belongs to `part`. */
  private wearerOf(part: GoalPart): GoalPart {
    const { swapped = null } = this.options;
    const isSwapped = swapped === "hands" ? part.endsWith("Hand") : part.endsWith("LowerLeg");
    return swapped !== null && isSwapped ? (OTHER[part] ?? part) : part;
  }
}
