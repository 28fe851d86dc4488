/**
 * From WebXR's 25 joints of a hand to the hand's 15 finger rotations in the streams.
 *
 * WebXR (Hand Input, section "Joints"): the -z of a joint leads along its bone towards the tip, its y
 * out of the back of the hand or the nail, its x to the right. The streams (docs/protocol.md,
 * section 6): parent-from-part relative to the T-pose, in which palms face down, fingers lie flat
 * and parallel, and thumbs point 45 degrees forward; the axes of every part are then the world's.
 *
 * So in the T-pose the joint of every finger has the frame B of the hand's own bones, and that of the
 * thumb a frame T: its bone aslant, its nail forwards. With parent_from_joint as WebXR says, the rotation in
 * the streams is P parent_from_joint C^-1, with P and C the T-pose's frames of parent and joint.
 * Rotations only: bones may be of any length. Metacarpals of the four fingers belong to the hand.
 */
import { fromAxes, multiply, type Quaternion, type Vector } from "@shared/rotations";
import { FINGER_VALUES, type HandSide } from "../frameBuffer";
import { conjugate } from "../places";

/** WebXR's joints of the 15 parts, in the streams' order: thumb to little finger, root to tip. */
export const FINGER_JOINTS = [
  "thumb-metacarpal",
  "thumb-phalanx-proximal",
  "thumb-phalanx-distal",
  "index-finger-phalanx-proximal",
  "index-finger-phalanx-intermediate",
  "index-finger-phalanx-distal",
  "middle-finger-phalanx-proximal",
  "middle-finger-phalanx-intermediate",
  "middle-finger-phalanx-distal",
  "ring-finger-phalanx-proximal",
  "ring-finger-phalanx-intermediate",
  "ring-finger-phalanx-distal",
  "pinky-finger-phalanx-proximal",
  "pinky-finger-phalanx-intermediate",
  "pinky-finger-phalanx-distal",
] as const satisfies readonly XRHandJoint[];

const PARTS_PER_FINGER = 3;
const HALF = Math.SQRT1_2;

/** The frame of a WebXR joint whose bone leads along `bone` and whose y is `back`. */
function jointFrame(bone: Vector, back: Vector): Quaternion {
  const [bx, by, bz] = bone;
  const z: Vector = [-bx, -by, -bz];
  const x: Vector = [
    back[1] * z[2] - back[2] * z[1],
    back[2] * z[0] - back[0] * z[2],
    back[0] * z[1] - back[1] * z[0],
  ];
  return fromAxes(x, back, z);
}

/** part_from_joint in the T-pose: of the hand and its four fingers, and of the thumb. */
const T_POSE: Readonly<
  Record<HandSide, { readonly hand: Quaternion; readonly thumb: Quaternion }>
> = {
  left: {
    hand: jointFrame([-1, 0, 0], [0, 1, 0]),
    thumb: jointFrame([-HALF, 0, -HALF], [HALF, 0, -HALF]),
  },
  right: {
    hand: jointFrame([1, 0, 0], [0, 1, 0]),
    thumb: jointFrame([HALF, 0, -HALF], [-HALF, 0, -HALF]),
  },
};

/** part_from_joint in the T-pose of the wrist (null) or of a finger part by its place, 0 to 14. */
export const tPoseFrame = (side: HandSide, part: number | null): Quaternion =>
  part !== null && part < PARTS_PER_FINGER ? T_POSE[side].thumb : T_POSE[side].hand;

/** world_from_hand with the T-pose's axes, of world_from_wrist as WebXR says. */
export const handRotation = (side: HandSide, worldFromWrist: Quaternion): Quaternion =>
  multiply(worldFromWrist, conjugate(T_POSE[side].hand));

/**
 * Write the 15 rotations (60 values) of a hand into `into`.
 *
 * `worldFromJoint(joint)` gives the rotation of the wrist (null) and of each part by its place in
 * `FINGER_JOINTS`, in any one frame. Each quaternion is written with w >= 0.
 */
export function writeFingers(
  side: HandSide,
  worldFromJoint: (part: number | null) => Quaternion,
  into: Float64Array,
): void {
  if (into.length < FINGER_VALUES) throw new RangeError(`A hand has ${FINGER_VALUES} values.`);
  const wrist = worldFromJoint(null);
  let above = wrist;
  let aboveFrame = T_POSE[side].hand;
  for (let part = 0; part < FINGER_JOINTS.length; part++) {
    if (part % PARTS_PER_FINGER === 0) {
      above = wrist;
      aboveFrame = T_POSE[side].hand;
    }
    const joint = worldFromJoint(part);
    const frame = tPoseFrame(side, part);
    const [w, x, y, z] = multiply(
      aboveFrame,
      multiply(multiply(conjugate(above), joint), conjugate(frame)),
    );
    const sign = w < 0 ? -1 : 1;
    into[4 * part] = sign * w;
    into[4 * part + 1] = sign * x;
    into[4 * part + 2] = sign * y;
    into[4 * part + 3] = sign * z;
    above = joint;
    aboveFrame = frame;
  }
}
