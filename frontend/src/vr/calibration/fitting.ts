/**
 * From two held poses, arms hanging (N) and arms out (T), to a calibration.
 *
 * - The stature is the height of the eyes, of a level head, by their usual share of it. The body then
 *   has its eyes where the person's are, whatever share that person has.
 * - In the T-pose everybody stands as the product's body does, which says where each joint is: below
 *   the eyes, at fractions of the stature, facing across the line of the hands. A device is worn
 *   where it was found against its joint. Everything is bound to this pose, never to the first
 *   frame, in which a hand may be turned in any way.
 * - An arm leads from its shoulder to the wrist behind the device. Upper arm and forearm are
 *   stretched to that length; hands keep their usual one, which the span needs twice. Thigh and
 *   shank cannot be told apart by what is worn, so they follow from the stature.
 *
 * Nothing depends on where the room's origin is or how the room is turned.
 */
import type { Place } from "@shared/avatar/hips";
import {
  dot,
  length,
  minus,
  multiply,
  type Quaternion,
  rotate,
  times,
  type Vector,
} from "@shared/rotations";
import { composed, headingOf, inverted, rotationTo, turned } from "../tracking/places";
import { armStretchOf, FOREARM, HAND, restOf, UPPER_ARM } from "../tracking/skeleton";
import type { GoalPart, SourceKind, TrackingDevice } from "../tracking/tracked";
import { EYES_AHEAD_M, EYES_AT, gripInHandM, usualOffsets } from "../tracking/worn";
import type { Calibration, Notice, Offsets } from "./calibration";
import type { HeldPart, HeldPose } from "./heldPose";

/** Who is calibrated, and with what. */
export interface Wearing {
  readonly source: SourceKind;
  /** Parts that the way of tracking measures. */
  readonly measures: ReadonlySet<GoalPart>;
  /** What the participant said, or what was matched; null if nothing is known. */
  readonly statedStatureM: number | null;
  /** The stature of the body that is worn already and stays; null before there is one. */
  readonly bodyStatureM: number | null;
}

/** The eyes were higher in the other pose: nobody stands taller than upright by chance. */
export const UNEVEN_M = 0.015;
/** People overstate their stature by about 2.5 cm (Pheasant 1996), and shoes add as much. */
export const BELOW_STATED_M = 0.06;
const ABOVE_STATED_M = 0.06;
/** A body's lengths may differ by so much from those usual for its stature, as on the server. */
const LEAST_STRETCH = 0.7;
const MOST_STRETCH = 1.3;
/** How far a palm may be turned from facing down for the hand's turn to be measured. */
const LEVEL_PALM = Math.cos((50 * Math.PI) / 180);
const EYES_ABOVE_HEAD = EYES_AT - restOf("Head")[1];
const UP: Vector = [0, 1, 0];
const IDENTITY: Quaternion = [1, 0, 0, 0];
export const SHINS = ["LeftLowerLeg", "RightLowerLeg"] as const;
export const HANDS = ["LeftHand", "RightHand"] as const;
type HandPart = (typeof HANDS)[number];

export const sideOf = (part: GoalPart): 1 | -1 => (part.startsWith("Left") ? -1 : 1);

/**
 * The stature of somebody who stands upright with these eyes.
 *
 * A head that is bent by the angle p carries its eyes `EYES_AHEAD_M` sin p below where they are when
 * it is level: reading a sign below the eyes would cost 2 cm of stature.
 */
export function statureOf({ positionM, rotation }: Place): number {
  const [, up] = rotate(rotation, UP);
  const [, ahead] = rotate(rotation, [0, 0, 1]);
  return (positionM[1] + EYES_AHEAD_M * ahead) / (EYES_AT - EYES_ABOVE_HEAD * (1 - up));
}

/** Where the head's joint is, of somebody of this stature. */
const headPlace = (eyes: Place, statureM: number): Place =>
  composed(eyes, inverted(usualOffsets(statureM).Head));

/** The part whose device tracks `part`, where the sides were exchanged. */
export function trackedBy(
  part: GoalPart,
  { swapsHands, swapsShins }: Pick<Calibration, "swapsHands" | "swapsShins">,
): GoalPart {
  if (part === "LeftHand" && swapsHands) return "RightHand";
  if (part === "RightHand" && swapsHands) return "LeftHand";
  if (part === "LeftLowerLeg" && swapsShins) return "RightLowerLeg";
  if (part === "RightLowerLeg" && swapsShins) return "LeftLowerLeg";
  return part;
}

/** How far the second device is to the right of the first, for somebody who looks as `eyes`. */
export function rightwardsM(eyes: Place, left: Place, right: Place): number {
  const rightwards = rotate(turned(UP, headingOf(eyes)), [1, 0, 0]);
  return dot(minus(right.positionM, left.positionM), rightwards);
}

/** Whether a controller is held with the palm down, the arm stretched to the side. */
export const isPalmDown = (rotation: Quaternion, side: 1 | -1): boolean =>
  // Its x axis leads out of the back of the right hand, and out of the palm of the left one.
  side * rotate(rotation, [1, 0, 0])[1] > LEVEL_PALM;

/** Where a shoulder is, of somebody of this stature who stands at `body`. */
export const shoulderM = (body: Place, statureM: number, side: 1 | -1): Vector =>
  composed(body, {
    positionM: times(restOf(side < 0 ? "LeftUpperArm" : "RightUpperArm"), statureM),
    rotation: IDENTITY,
  }).positionM;

/** Where the body stands: the floor below the head's joint, facing as the participant does. */
export function bodyPlace({ eyes, parts }: HeldPose, statureM = statureOf(eyes)): Place {
  const gaze = turned(UP, headingOf(eyes));
  const left = parts.get("LeftHand")?.place;
  const right = parts.get("RightHand")?.place;
  let rotation = gaze;
  if (left !== undefined && right !== undefined) {
    const [x, , z] = minus(right.positionM, left.positionM);
    // The line of the hands says better than the eyes where the body faces; sides may be swapped.
    const sign = dot([x, 0, z], rotate(gaze, [1, 0, 0])) < 0 ? -1 : 1;
    rotation = turned(UP, Math.atan2(-sign * z, sign * x));
  }
  const [x, , z] = headPlace(eyes, statureM).positionM;
  return { positionM: [x, 0, z], rotation };
}

/** Fit a calibration to the held poses; nothing has tested it yet. */
export function fitted(n: HeldPose, t: HeldPose, wearing: Wearing): Calibration {
  const { source, measures, statedStatureM, bodyStatureM } = wearing;
  const notices: Notice[] = [];
  const staturesM = [statureOf(n.eyes), statureOf(t.eyes)];
  const statureM = Math.max(...staturesM);
  if (statureM - Math.min(...staturesM) > UNEVEN_M) notices.push("bent_knees");
  if (statedStatureM !== null) {
    if (statureM < statedStatureM - BELOW_STATED_M) notices.push("below_stated_stature");
    if (statureM > statedStatureM + ABOVE_STATED_M) notices.push("above_stated_stature");
  }
  const swaps = { swapsHands: isSwapped(t, HANDS), swapsShins: isSwapped(n, SHINS) };
  if (swaps.swapsHands) notices.push("swapped_hands");
  if (swaps.swapsShins) notices.push("swapped_shins");
  const deviceAt = (part: GoalPart): HeldPart | null => t.parts.get(trackedBy(part, swaps)) ?? null;
  const body = bodyPlace(t, statureM);
  const arms = measuredArms(body, statureM, deviceAt);
  if (arms === null) notices.push("arms_not_measured");
  if (arms?.isLimited === true) notices.push("arms_limited");

  const offsets: { [Part in GoalPart]?: NonNullable<Offsets[Part]> } = {};
  const sources: { [Part in GoalPart]?: string } = {};
  const bind = (part: GoalPart, device: TrackingDevice, tracker: Place, goal: Place): void => {
    offsets[part] = { trackerFromGoal: stored(composed(inverted(tracker), goal)), device };
    sources[part] = device === "body" || device === "tracker" ? source : device;
  };
  const standing = (part: GoalPart): Place =>
    composed(body, {
      positionM: times(restOf(part), bodyStatureM ?? statureM),
      rotation: IDENTITY,
    });
  // Where the eyes look is known; only how far the head's joint is from them follows the stature.
  bind("Head", "headset", t.eyes, headPlace(t.eyes, statureM));
  for (const part of ["Hips", ...SHINS] as const) {
    const found = deviceAt(part);
    if (found !== null) bind(part, found.device, found.place, standing(part));
  }
  for (const part of HANDS) {
    const found = deviceAt(part);
    if (found === null || arms === null) continue;
    const { device, place } = found;
    const isTurned = device === "controller" && !isPalmDown(place.rotation, sideOf(part));
    if (isTurned && !notices.includes("palms_not_down")) notices.push("palms_not_down");
    const usual = composed(place, inverted(usualOffsets(statureM)[part]));
    // A tracked hand's wrist is the joint already.
    if (device === "hand") bind(part, device, place, place);
    else bind(part, device, place, isTurned ? usual : arms.wrists[part]);
  }
  if (offsets.Hips === undefined) notices.push("waist_inferred");
  if (!SHINS.every((shin) => measures.has(shin) && offsets[shin] !== undefined)) {
    notices.push("feet_not_tracked");
  }
  return {
    statureM,
    spanM: arms?.spanM ?? null,
    eyeHeightM: EYES_AT * statureM,
    segmentsM: arms?.segmentsM ?? {},
    offsets,
    ...swaps,
    residualsM: {},
    sources,
    notices,
  };
}

/** Whether the device of the left side is on the right one. */
function isSwapped(
  { eyes, parts }: HeldPose,
  [left, right]: readonly [GoalPart, GoalPart],
): boolean {
  const from = parts.get(left);
  const to = parts.get(right);
  if (from === undefined || to === undefined) return false;
  return rightwardsM(eyes, from.place, to.place) < 0;
}

interface Arms {
  readonly spanM: number;
  readonly segmentsM: Readonly<Record<string, number>>;
  readonly isLimited: boolean;
  readonly wrists: Readonly<Record<HandPart, Place>>;
}

/** The arms of the T-pose, from shoulders at their usual places; null if a hand was not seen. */
function measuredArms(
  body: Place,
  statureM: number,
  deviceAt: (part: GoalPart) => HeldPart | null,
): Arms | null {
  const left = deviceAt("LeftHand");
  const right = deviceAt("RightHand");
  if (left === null || right === null) return null;
  const arms = {
    LeftHand: measuredArm(body, statureM, -1, left),
    RightHand: measuredArm(body, statureM, 1, right),
  };
  const lengthM = (arms.LeftHand.lengthM + arms.RightHand.lengthM) / 2;
  const stretch = armStretchOf(lengthM, statureM);
  const given = Math.min(Math.max(stretch, LEAST_STRETCH), MOST_STRETCH);
  const [shoulder] = restOf("RightUpperArm");
  return {
    spanM: 2 * ((shoulder + HAND) * statureM + lengthM),
    segmentsM: {
      upper_arm: given * UPPER_ARM * statureM,
      forearm: given * FOREARM * statureM,
    },
    isLimited: given !== stretch,
    wrists: { LeftHand: arms.LeftHand.wrist, RightHand: arms.RightHand.wrist },
  };
}

/** The wrist of a stretched arm, and its distance from the shoulder. */
function measuredArm(
  body: Place,
  statureM: number,
  side: 1 | -1,
  { place, device }: HeldPart,
): { readonly wrist: Place; readonly lengthM: number } {
  const [out, down, ahead]: Vector = device === "controller" ? gripInHandM(side) : [0, 0, 0];
  const fromShoulder = minus(place.positionM, shoulderM(body, statureM, side));
  const awayM = length(fromShoulder);
  // In the frame of the stretched arm the device is at (length + out, down, ahead).
  const alongM = Math.sqrt(Math.max(awayM * awayM - down * down - ahead * ahead, 0));
  const lengthM = Math.max(alongM - Math.abs(out), 0);
  const level = rotate(body.rotation, [side * alongM, down, ahead]);
  const turn = rotationTo(times(level, 1 / awayM), times(fromShoulder, 1 / awayM));
  const rotation = multiply(turn, body.rotation);
  const positionM = minus(place.positionM, rotate(rotation, [out, down, ahead]));
  return { wrist: { positionM, rotation }, lengthM };
}

/** A place whose tuples can be stored. */
function stored({ positionM, rotation }: Place): {
  positionM: [number, number, number];
  rotation: [number, number, number, number];
} {
  return { positionM: [...positionM], rotation: [...rotation] };
}
