/**
 * A hand's joints from its finger rotations: forward kinematics of a generated hand.
 *
 * Lengths are those of the server's `app/science/avatar/body/fingers.py` (Buchholz, Armstrong and
 * Goldstein 1992). Emulated and scripted hands are made of it, and it is how the conversion of
 * tracked hands (`webxr/fingers.ts`) is tested.
 */
import type { Place } from "@shared/avatar/hips";
import { multiply, plus, type Quaternion, rotate, type Vector } from "@shared/rotations";
import { FINGER_VALUES, type HandSide } from "./frameBuffer";
import { turned } from "./places";
import { FINGER_JOINTS, tPoseFrame } from "./webxr/fingers";

const BREADTH = 0.44;
const SEGMENTS = {
  thumb: [0.251, 0.196, 0.158],
  "index-finger": [0.245, 0.143, 0.097],
  "middle-finger": [0.266, 0.17, 0.108],
  "ring-finger": [0.244, 0.165, 0.107],
  "pinky-finger": [0.204, 0.117, 0.093],
} as const;
/** From the wrist along the hand, and towards the thumb in breadths. */
const ROOTS = {
  thumb: [0.073, 0.196],
  "index-finger": [0.447, 0.251],
  "middle-finger": [0.446, 0],
  "ring-finger": [0.409, -0.206],
  "pinky-finger": [0.368, -0.402],
} as const;
type Finger = keyof typeof SEGMENTS;
const FINGERS = Object.keys(SEGMENTS) as readonly Finger[];

/** Bends in degrees: thumb across, lowered, middle, tip; each finger from knuckle to tip. */
type Bend = readonly [proximal: number, intermediate: number, distal: number];
export interface Gesture {
  readonly thumb: readonly [across: number, lowered: number, middle: number, tip: number];
  readonly fingers: readonly [index: Bend, middle: Bend, ring: Bend, little: Bend];
}

const RELAXED: Bend = [18, 28, 14];
const CLOSED: Bend = [85, 95, 65];
const STRAIGHT: Bend = [0, 2, 1];
const same = (bend: Bend): Gesture["fingers"] => [bend, bend, bend, bend];

/** Estimates, as in the server's `app/science/simulation/fingers.py`; the pinch brings tips together. */
export const GESTURES = {
  flat: { thumb: [0, 0, 0, 0], fingers: same([0, 0, 0]) },
  relaxed: { thumb: [10, 12, 10, 10], fingers: same(RELAXED) },
  fist: { thumb: [40, 35, 45, 50], fingers: same(CLOSED) },
  point: { thumb: [38, 30, 40, 40], fingers: [STRAIGHT, CLOSED, CLOSED, CLOSED] },
  pinch: { thumb: [30, 41, 25, 20], fingers: [[47, 52, 22], RELAXED, RELAXED, RELAXED] },
} as const satisfies Readonly<Record<string, Gesture>>;

const DEGREES = Math.PI / 180;

/** The 15 rotations (60 values) of a hand in a gesture. */
export function gestureRotations(side: HandSide, { thumb, fingers }: Gesture): Float64Array {
  const sign = side === "left" ? 1 : -1;
  const bend = (degrees: number) => turned([0, 0, 1], sign * degrees * DEGREES);
  const across = (degrees: number) => turned([0, 1, 0], sign * degrees * DEGREES);
  const [first, lowered, middle, tip] = thumb;
  const parts: readonly Quaternion[] = [
    multiply(across(first), bend(lowered)),
    across(middle),
    across(tip),
    ...fingers.flatMap((bends) => bends.map(bend)),
  ];
  const values = new Float64Array(FINGER_VALUES);
  for (const [part, rotation] of parts.entries()) values.set(rotation, 4 * part);
  return values;
}

/** Blend two hands, such as one gesture on its way to another; `share` from 0 to 1. */
export function blendedFingers(a: Float64Array, b: Float64Array, share: number): Float64Array {
  const values = new Float64Array(FINGER_VALUES);
  for (let part = 0; part < FINGER_JOINTS.length; part++) {
    let size = 0;
    for (let axis = 0; axis < 4; axis++) {
      const at = 4 * part + axis;
      values[at] = (1 - share) * (a[at] as number) + share * (b[at] as number);
      size += (values[at] as number) ** 2;
    }
    for (let axis = 0; axis < 4; axis++) {
      const at = 4 * part + axis;
      values[at] = (values[at] as number) / Math.sqrt(size);
    }
  }
  return values;
}

/**
 * WebXR's 25 joints of a hand: places in the frame of `hand`, which is that of the wrist's joint
 * with the T-pose's axes.
 */
export function handJoints(
  side: HandSide,
  hand: Place,
  rotations: Float64Array,
  handM: number,
): ReadonlyMap<XRHandJoint, Place> {
  const outwards = side === "left" ? -1 : 1;
  const palm = tPoseFrame(side, null);
  const places = new Map<XRHandJoint, Place>();
  const inXr = (rotation: Quaternion, part: number | null): Quaternion =>
    multiply(rotation, tPoseFrame(side, part));
  places.set("wrist", { positionM: hand.positionM, rotation: inXr(hand.rotation, null) });
  for (const [index, finger] of FINGERS.entries()) {
    const [along, towardsThumb] = ROOTS[finger];
    const root: Vector = [outwards * along * handM, 0, -towardsThumb * BREADTH * handM];
    const isThumb = finger === "thumb";
    const bone: Vector = isThumb ? [outwards * Math.SQRT1_2, 0, -Math.SQRT1_2] : [outwards, 0, 0];
    let rotation = hand.rotation;
    let positionM = plus(hand.positionM, rotate(rotation, root));
    if (!isThumb) {
      const [x, y, z] = root;
      const metacarpal: Vector = [0.15 * x, y, 0.6 * z];
      places.set(`${finger}-metacarpal`, {
        positionM: plus(hand.positionM, rotate(rotation, metacarpal)),
        rotation: multiply(rotation, palm),
      });
    }
    for (let segment = 0; segment < 3; segment++) {
      const part = 3 * index + segment;
      const at = 4 * part;
      rotation = multiply(rotation, [
        rotations[at] as number,
        rotations[at + 1] as number,
        rotations[at + 2] as number,
        rotations[at + 3] as number,
      ]);
      const name = FINGER_JOINTS[part] as XRHandJoint;
      places.set(name, { positionM, rotation: inXr(rotation, part) });
      const lengthM = (SEGMENTS[finger][segment] as number) * handM;
      positionM = plus(positionM, rotate(rotation, [bone[0] * lengthM, 0, bone[2] * lengthM]));
    }
    places.set(`${finger}-tip`, { positionM, rotation: inXr(rotation, 3 * index + 2) });
  }
  return places;
}
