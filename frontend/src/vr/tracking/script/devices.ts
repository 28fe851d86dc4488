/**
 * The devices that a scripted person wears. Calibration has to find where each is against the joint
 * below it; its tests know that.
 */
import type { Place } from "@shared/avatar/hips";
import type { Quaternion, Vector } from "@shared/rotations";
import { AT_ORIGIN, composed } from "../places";
import { INDEX, type Joint } from "../skeleton";
import type { GoalPart } from "../tracked";
import { usualOffsets, type WornOffsets } from "../worn";
import type { ScriptedPerson } from "./person";
import { type Random, seeded } from "./random";

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
const OTHER: Readonly<Record<string, GoalPart>> = {
  LeftHand: "RightHand",
  RightHand: "LeftHand",
  LeftLowerLeg: "RightLowerLeg",
  RightLowerLeg: "LeftLowerLeg",
};

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
    const wearer = this.wearerOf(part);
    const joint = INDEX[JOINT_OF[wearer]];
    const { positionsM, rotations } = this.person.joints;
    const place = composed(
      { positionM: positionsM[joint] as Vector, rotation: rotations[joint] as Quaternion },
      this.offsets[wearer],
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
