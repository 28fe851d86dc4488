/** What keeps a frame from being the pose that a step asks for, most important first. */
import { length, minus, rotate, type Vector } from "@shared/rotations";
import { headingOf } from "../tracking/places";
import type { TrackedFrame } from "../tracking/tracked";
import {
  bodyPlace,
  HANDS,
  isPalmDown,
  rightwardsM,
  SHINS,
  shoulderM,
  sideOf,
  statureOf,
  UNEVEN_M,
} from "./fitting";
import type { HeldPose } from "./heldPose";
import type { CalibrationProblem } from "./steps";

type Problems = readonly CalibrationProblem[];
const NONE: Problems = [];
const RADIANS = Math.PI / 180;

const MOST_PITCH = Math.sin(15 * RADIANS);
const MOST_TURN_RAD = 20 * RADIANS;
/** Nobody who stands is shorter or taller; children of school age are between them. */
const LEAST_STATURE_M = 0.9;
const MOST_STATURE_M = 2.4;
const MOST_OFF_SQUARE_M = 0.25;
/** Heights as shares of that of the eyes. */
const HANGING_BELOW = 0.68;
const OUT_FROM = 0.78;
const OUT_TO = 0.97;
const LEAST_APART = 0.5;
/** Devices of hands that hang, and of shins, are at least so far to their own side. */
const CROSSED_M = -0.12;
const FEET_APART_M = 0.36;
/** In the T-pose a device is nearer to its shoulder than while the arm hung: the elbow is bent. */
const SHORTENED_M = 0.05;
const BENT_TO = 0.92;
const UPRIGHT_FROM = 0.975;
/** How far in front of the eyes both hands are when they reach, of the height of the eyes. */
const REACHES = 0.15;
const FORWARD: Vector = [0, 0, -1];
const OTHER = { LeftHand: "RightHand", RightHand: "LeftHand" } as const;

/** The eyes of a frame whose problems are asked for; nothing else can be said without them. */
function standing({ eyes }: TrackedFrame): Problems {
  if (eyes === null) return [{ kind: "lost", part: "Head" }];
  const isLevel = Math.abs(rotate(eyes.rotation, FORWARD)[1]) <= MOST_PITCH;
  return isLevel ? NONE : [{ kind: "looking" }];
}

/** On the square: `isMoving` if the square comes to whoever stands still and looks ahead. */
export function squareProblems(frame: TrackedFrame, isMoving: boolean): Problems {
  const { eyes } = frame;
  const problems = standing(frame);
  if (isMoving || eyes === null) return problems;
  const [x, , z] = bodyPlace({ eyes, parts: new Map() }).positionM;
  const distanceM = Math.hypot(x, z);
  if (distanceM > MOST_OFF_SQUARE_M) {
    const isSideways = Math.abs(x) > Math.abs(z);
    const towards = isSideways ? (x > 0 ? "left" : "right") : z > 0 ? "forward" : "back";
    return [{ kind: "off_square", towards, distanceM }];
  }
  const heading = headingOf(eyes);
  if (Math.abs(heading) <= MOST_TURN_RAD) return problems;
  return [{ kind: "turned", towards: heading > 0 ? "right" : "left" }];
}

/** The N-pose: upright, arms hanging. Hands that are not seen hang where cameras do not look. */
export function nPoseProblems(frame: TrackedFrame, leastStatureM: number | null): Problems {
  const { eyes, parts } = frame;
  const problems = [...standing(frame)];
  if (eyes === null) return problems;
  const statureM = statureOf(eyes);
  if (statureM < LEAST_STATURE_M || statureM > MOST_STATURE_M)
    problems.push({ kind: "implausible", valueM: statureM });
  const highestM = HANGING_BELOW * eyes.positionM[1];
  const hands = HANDS.map((hand) => parts[hand].place);
  if (hands.some((place) => place !== null && place.positionM[1] > highestM))
    problems.push({ kind: "arms_not_down" });
  if (areCrossed(frame)) problems.push({ kind: "swapped_hands" });
  if (leastStatureM !== null && statureM < leastStatureM) problems.push({ kind: "bent_knees" });
  const [left, right] = SHINS.map((shin) => parts[shin].place);
  if (left != null && right != null && Math.abs(rightwardsM(eyes, left, right)) > FEET_APART_M)
    problems.push({ kind: "feet_apart" });
  return problems;
}

/** The T-pose: both arms level and straight, to the sides, palms down, as tall as in the N-pose. */
export function tPoseProblems(frame: TrackedFrame, n: HeldPose): Problems {
  const { eyes, parts } = frame;
  const problems = [...standing(frame)];
  if (eyes === null) return problems;
  for (const part of HANDS) {
    if (parts[part].place === null) problems.push({ kind: "lost", part });
  }
  const left = parts.LeftHand.place;
  const right = parts.RightHand.place;
  if (left === null || right === null) return problems;
  const heights = [left, right].map(({ positionM }) => positionM[1] / eyes.positionM[1]);
  const isApart = length(minus(right.positionM, left.positionM)) > LEAST_APART * eyes.positionM[1];
  if (heights.some((height) => height > OUT_TO)) problems.push({ kind: "arm_too_high" });
  else if (!isApart || heights.some((height) => height < OUT_FROM))
    problems.push({ kind: "arms_not_level" });
  if (problems.length > 0) return problems;
  const crossed = areCrossed(frame);
  if (crossed) problems.push({ kind: "swapped_hands" });
  const statureM = statureOf(n.eyes);
  if (statureOf(eyes) < statureM - UNEVEN_M) problems.push({ kind: "bent_knees" });
  if (hasBentElbow(frame, n, statureM)) problems.push({ kind: "bent_elbows" });
  const isTurned = HANDS.some((part) => {
    const { place, device } = parts[part];
    const side = crossed ? sideOf(OTHER[part]) : sideOf(part);
    return device === "controller" && place !== null && !isPalmDown(place.rotation, side);
  });
  if (isTurned) problems.push({ kind: "palms_not_down" });
  return problems;
}

/** How low the eyes are, as a share of their height. */
const heightShare = ({ eyes }: TrackedFrame, eyeHeightM: number): number =>
  eyes === null ? Number.NaN : eyes.positionM[1] / eyeHeightM;

export const isBent = (frame: TrackedFrame, eyeHeightM: number): boolean =>
  heightShare(frame, eyeHeightM) < BENT_TO;

export const isUpright = (frame: TrackedFrame, eyeHeightM: number): boolean =>
  heightShare(frame, eyeHeightM) > UPRIGHT_FROM && standing(frame).length === 0;

/** Whether both hands are stretched out to the front. */
export function isReaching({ eyes, parts }: TrackedFrame): boolean {
  if (eyes === null) return false;
  const heading = headingOf(eyes);
  const [dx, dz] = [-Math.sin(heading), -Math.cos(heading)];
  return HANDS.every((part) => {
    const place = parts[part].place;
    if (place === null) return false;
    const [x, , z] = minus(place.positionM, eyes.positionM);
    return x * dx + z * dz > REACHES * eyes.positionM[1];
  });
}

/** Whether controllers are in the other hands; bare hands cannot be exchanged. */
function areCrossed({ eyes, parts }: TrackedFrame): boolean {
  const { LeftHand: left, RightHand: right } = parts;
  if (eyes === null || left.place === null || right.place === null) return false;
  if (left.device === "hand" || right.device === "hand") return false;
  return rightwardsM(eyes, left.place, right.place) < CROSSED_M;
}

/** Whether a device is nearer to its shoulder than it was in the N-pose, in which it hangs below. */
function hasBentElbow({ eyes, parts }: TrackedFrame, n: HeldPose, statureM: number): boolean {
  if (eyes === null) return false;
  const body = bodyPlace({ eyes, parts: new Map() }, statureM);
  return HANDS.some((part) => {
    const hanging = n.parts.get(part);
    const { place, device } = parts[part];
    if (hanging === undefined || place === null || device !== hanging.device) return false;
    const shouldersM = [-1, 1].map((side) => shoulderM(body, statureM, side as 1 | -1));
    const hangsM = (shouldersM[0] as Vector)[1] - hanging.place.positionM[1];
    // The nearer shoulder is the hand's own, whichever device is in it.
    const awaysM = shouldersM.map((shoulder) => length(minus(place.positionM, shoulder)));
    return Math.min(...awaysM) < hangsM - SHORTENED_M;
  });
}
