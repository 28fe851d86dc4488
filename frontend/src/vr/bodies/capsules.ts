/**
 * The capsules of a body that is not simulated: the server's `skeleton/kinematics.py` and
 * `simulation/finger_capsules.py`.
 */
import {
  FINGER_PARTS,
  JOINT_PARENTS,
  JOINTS,
  UNIT_SKELETON,
} from "@shared/avatar/anatomy.generated";
import { multiplyRows } from "@shared/avatar/physics/numbers";
import { type SegmentsM, unitSkeleton } from "./armLengths";

const JOINT_COUNT = JOINTS.length;
const SEGMENTS_PER_FINGER = 3;
const HANDS = ["LeftHand", "RightHand"].map((name) => (JOINTS as readonly string[]).indexOf(name));
const PARTS_PER_HAND = FINGER_PARTS.length / HANDS.length;
/** The palm ends at the knuckle of the middle finger, the third of five. */
const MIDDLE_PROXIMAL = 2 * SEGMENTS_PER_FINGER;

export class Capsules {
  /** Start and end of each part's axis in the world (6 values a part). */
  readonly axesM: Float64Array;
  readonly radiiM: Float64Array;
  private readonly places = new Float64Array(3 * JOINT_COUNT);
  private readonly turns = new Float64Array(4 * JOINT_COUNT);
  private readonly point = new Float64Array(3);
  private readonly fingerTurn = new Float64Array(4);
  private readonly offsets: Float64Array;
  private readonly starts: Float64Array;
  private readonly ends: Float64Array;
  private readonly fingerJoints: Float64Array;
  private readonly fingerEnds: Float64Array;

  constructor(statureM: number, withFingers: boolean, segmentsM?: SegmentsM) {
    const scaled = (values: readonly number[]) =>
      Float64Array.from(values, (one) => statureM * one);
    const { offsets, capsuleEnds } = unitSkeleton(statureM, segmentsM);
    this.offsets = scaled(offsets);
    this.starts = scaled(UNIT_SKELETON.capsuleStarts);
    this.ends = scaled(capsuleEnds);
    this.fingerJoints = scaled(UNIT_SKELETON.fingerJoints);
    this.fingerEnds = scaled(UNIT_SKELETON.fingerEnds);
    const radii = withFingers
      ? [...UNIT_SKELETON.radii, ...UNIT_SKELETON.fingerRadii]
      : UNIT_SKELETON.radii;
    this.radiiM = scaled(radii);
    this.axesM = new Float64Array(6 * radii.length);
  }

  /** Place the capsules for a pose (91) and, if it has any, its fingers (120). */
  place(pose: Float64Array, fingers: Float64Array | null): void {
    const { places, turns, axesM } = this;
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      const above = JOINT_PARENTS[joint] as number;
      if (above < 0) {
        for (let i = 0; i < 3; i++) places[i] = pose[i] as number;
        for (let i = 0; i < 4; i++) turns[i] = pose[3 + i] as number;
      } else {
        multiplyRows(turns, 4 * above, pose, 3 + 4 * joint, turns, 4 * joint);
        rotateRow(turns, 4 * above, this.offsets, 3 * joint, places, 3 * above, places, 3 * joint);
      }
      const at = 6 * joint;
      rotateRow(turns, 4 * joint, this.starts, 3 * joint, places, 3 * joint, axesM, at);
      rotateRow(turns, 4 * joint, this.ends, 3 * joint, places, 3 * joint, axesM, at + 3);
    }
    if (fingers !== null && axesM.length > 6 * JOINT_COUNT) this.placeFingers(fingers);
  }

  private placeFingers(fingers: Float64Array): void {
    const { places, turns, axesM, point, fingerTurn } = this;
    for (let hand = 0; hand < HANDS.length; hand++) {
      const joint = HANDS[hand] as number;
      const first = hand * PARTS_PER_HAND;
      const knuckle = 3 * (first + MIDDLE_PROXIMAL);
      rotateRow(
        turns,
        4 * joint,
        this.fingerJoints,
        knuckle,
        places,
        3 * joint,
        axesM,
        6 * joint + 3,
      );
      for (let part = first; part < first + PARTS_PER_HAND; part++) {
        if (part % SEGMENTS_PER_FINGER === 0) {
          for (let i = 0; i < 3; i++) point[i] = places[3 * joint + i] as number;
          for (let i = 0; i < 4; i++) fingerTurn[i] = turns[4 * joint + i] as number;
        }
        rotateRow(fingerTurn, 0, this.fingerJoints, 3 * part, point, 0, point, 0);
        multiplyRows(fingerTurn, 0, fingers, 4 * part, fingerTurn, 0);
        const at = 6 * (JOINT_COUNT + part);
        for (let i = 0; i < 3; i++) axesM[at + i] = point[i] as number;
        rotateRow(fingerTurn, 0, this.fingerEnds, 3 * part, point, 0, axesM, at + 3);
      }
    }
  }
}

/** Write origin + q v. */
function rotateRow(
  turns: Float64Array,
  q: number,
  vectors: Float64Array,
  v: number,
  origins: Float64Array,
  o: number,
  result: Float64Array,
  into: number,
): void {
  const w = turns[q] as number;
  const x = turns[q + 1] as number;
  const y = turns[q + 2] as number;
  const z = turns[q + 3] as number;
  const vx = vectors[v] as number;
  const vy = vectors[v + 1] as number;
  const vz = vectors[v + 2] as number;
  const cx = 2 * (y * vz - z * vy);
  const cy = 2 * (z * vx - x * vz);
  const cz = 2 * (x * vy - y * vx);
  result[into] = (origins[o] as number) + (vx + w * cx + y * cz - z * cy);
  result[into + 1] = (origins[o + 1] as number) + (vy + w * cy + z * cx - x * cz);
  result[into + 2] = (origins[o + 2] as number) + (vz + w * cz + x * cy - y * cx);
}
