/**
 * Joints from devices by usual offsets: for whoever was not calibrated.
 *
 * A device sits where people usually hold or wear it: eyes in front of the head's joint, a grip in
 * the fist, a tracker in front of the shin. Offsets scale with the stature where the body does.
 */
import type { Goals } from "@shared/avatar/goals";
import { composed, inverted } from "../tracking/places";
import { usualOffsets, type WornOffsets } from "../tracking/script/devices";
import type { GoalPart, TrackedFrame } from "../tracking/tracked";
import type { Calibrator } from "./ports";

export class UsualOffsets implements Calibrator {
  readonly statureM = null;
  #offsets: WornOffsets = inverse(usualOffsets(1.72));
  #of = 1.72;

  /** Use the offsets of somebody of this stature. */
  scaleTo(statureM: number): void {
    if (statureM === this.#of) return;
    this.#of = statureM;
    this.#offsets = inverse(usualOffsets(statureM));
  }

  goals(tracked: TrackedFrame): Goals {
    const { parts } = tracked;
    const at = (part: GoalPart) => {
      const { device, place: own } = parts[part];
      // These are joints already.
      if (device === "joint" || device === "hand") return own;
      const place = part === "Head" ? tracked.eyes : own;
      return place === null ? null : composed(place, this.#offsets[part]);
    };
    return {
      Hips: at("Hips"),
      Head: at("Head"),
      LeftHand: at("LeftHand"),
      RightHand: at("RightHand"),
      LeftLowerLeg: at("LeftLowerLeg"),
      RightLowerLeg: at("RightLowerLeg"),
    };
  }
}

/** device_from_joint of every part. */
function inverse(offsets: WornOffsets): WornOffsets {
  return {
    Hips: inverted(offsets.Hips),
    Head: inverted(offsets.Head),
    LeftHand: inverted(offsets.LeftHand),
    RightHand: inverted(offsets.RightHand),
    LeftLowerLeg: inverted(offsets.LeftLowerLeg),
    RightLowerLeg: inverted(offsets.RightLowerLeg),
  };
}
