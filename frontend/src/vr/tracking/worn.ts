/**
 * Where people usually hold or wear devices: each against the joint below it.
 *
 * Calibration measures the person's own offsets; these are its start, what is used without one, and
 * what a scripted person wears. All are in the joint's frame, in which the T-pose has the world's
 * axes.
 */
import type { Place } from "@shared/avatar/hips";
import { fromAxes, type Vector } from "@shared/rotations";
import { turned } from "./places";
import type { GoalPart } from "./tracked";

/** joint_from_device of each part; the head's device is the eyes. */
export type WornOffsets = Readonly<Record<GoalPart, Place>>;

/** Height of the eyes as a share of the stature: Drillis and Contini 1966, in Winter 2009, fig. 4.1. */
export const EYES_AT = 0.936;
/** How far the eyes are in front of the head's joint, the skull's on the spine; our estimate. */
export const EYES_AHEAD_M = 0.09;
/** The grip of a controller in the right hand's frame: outwards, down, ahead; our estimate. */
export const GRIP_IN_HAND_M: Vector = [0.07, -0.03, -0.01];

const HEAD_AT = 0.875;
const UP: Vector = [0, 1, 0];

/** The grip in the frame of a hand, which points along its arm: `side` is -1 left, 1 right. */
export const gripInHandM = (side: 1 | -1): Vector => [
  side * GRIP_IN_HAND_M[0],
  GRIP_IN_HAND_M[1],
  GRIP_IN_HAND_M[2],
];

/**
 * Controllers held in fists, trackers in front of the shins, one at the back of the waist; the eyes
 * of a head that looks straight ahead.
 *
 * A grip's -z leads along the rod that a hand holds, towards the thumb, and its x to the right where
 * palms face each other (WebXR, `gripSpace`): the palms of the T-pose face down.
 */
export function usualOffsets(statureM: number): WornOffsets {
  const forwards: Vector = [0, 0, 1];
  const grip = (side: 1 | -1): Place => ({
    positionM: gripInHandM(side),
    rotation: fromAxes([0, side, 0], [-side, 0, 0], forwards),
  });
  const shin = (side: 1 | -1): Place => ({
    positionM: [side * 0.012, -0.09 * statureM, -0.055],
    rotation: turned(UP, side * 0.3),
  });
  return {
    Hips: { positionM: [0.02, 0.03, 0.12], rotation: turned(UP, Math.PI - 0.2) },
    Head: {
      positionM: [0, (EYES_AT - HEAD_AT) * statureM, -EYES_AHEAD_M],
      rotation: [1, 0, 0, 0],
    },
    LeftHand: grip(-1),
    RightHand: grip(1),
    LeftLowerLeg: shin(-1),
    RightLowerLeg: shin(1),
  };
}
