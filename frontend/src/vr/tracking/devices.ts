/**
 * Which device can track what: for the advice before VR, for pre-flight and for the docs.
 *
 * A foot task needs measured shins. Legs that a headset makes up from the upper body look alive but
 * are not the participant's, so they never count.
 */
import type { SourceKind } from "./tracked";

/** How a way of tracking knows the legs: not at all, made up from the upper body, or measured. */
export type Legs = "none" | "inferred" | "tracked";

export interface TrackingWay {
  readonly source: SourceKind;
  readonly legs: Legs;
  /** What has to be bought, strapped on or granted besides the headset; null: nothing. */
  readonly needs: "motion_trackers" | "shin_controllers" | "lab_trackers" | null;
  /** Whether it has been seen to work on this device, or only follows from its documentation. */
  readonly isUntested: boolean;
}

export interface DeviceProfile {
  /** What the participant wears, as a make calls it. */
  readonly name: string;
  readonly ways: readonly TrackingWay[];
}

export type DeviceKey = "pico" | "quest" | "vision_pro" | "android_xr" | "other";

const way = (
  source: SourceKind,
  legs: Legs = "none",
  needs: TrackingWay["needs"] = null,
): TrackingWay => ({ source, legs, needs, isUntested: true });

const LAB = way("server_trackers", "tracked", "lab_trackers");

/** No headset was at hand: everything here follows from documentation and browsers' reports. */
export const DEVICE_PROFILES: Readonly<Record<DeviceKey, DeviceProfile>> = {
  pico: {
    name: "PICO 4 Ultra Enterprise",
    ways: [
      way("controllers"),
      way("hands"),
      way("body_tracking", "tracked", "motion_trackers"),
      LAB,
    ],
  },
  quest: {
    name: "Meta Quest 2, 3, 3S, Pro",
    ways: [
      way("controllers"),
      way("hands"),
      way("body_tracking", "inferred"),
      way("shin_controllers", "tracked", "shin_controllers"),
      LAB,
    ],
  },
  vision_pro: { name: "Apple Vision Pro", ways: [way("hands"), LAB] },
  android_xr: { name: "Android XR", ways: [way("controllers"), way("hands"), LAB] },
  other: { name: "OpenXR, SteamVR", ways: [way("controllers"), way("hands"), LAB] },
};

/**
 * The device that a user agent names. PICO's browser also calls itself OculusBrowser, so it is
 * tested first.
 */
export function deviceKeyOf(userAgent: string): DeviceKey {
  if (/\bPico/i.test(userAgent)) return "pico";
  if (/OculusBrowser|\bQuest\b/i.test(userAgent)) return "quest";
  if (/Android ?XR/i.test(userAgent)) return "android_xr";
  if (/Vision ?Pro|visionOS/i.test(userAgent)) return "vision_pro";
  return "other";
}

/**
 * How the browser's own body tracking knows the legs. Only PICO's come from trackers on the legs;
 * for an unknown device the cautious answer is that they are made up.
 */
export function legsOfBodyTracking(key: DeviceKey): Exclude<Legs, "none"> {
  const found = DEVICE_PROFILES[key].ways.find(({ source }) => source === "body_tracking");
  return found?.legs === "tracked" ? "tracked" : "inferred";
}

/** Ways of this device that a foot task can be done with. */
export const waysForFeet = (key: DeviceKey): readonly TrackingWay[] =>
  DEVICE_PROFILES[key].ways.filter(({ legs }) => legs === "tracked");
