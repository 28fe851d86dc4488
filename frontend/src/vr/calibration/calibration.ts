/**
 * A calibration: how the devices that somebody wears lie against the joints below them, and the
 * person's measures. It is a value: reported, kept on the device, and used until the next one.
 */
import { GOAL_PARTS } from "@shared/avatar/goals";
import * as v from "valibot";
import type { ReportBody } from "../telemetry";

/** Words of the protocol for what was noticed; the console explains them to the operator. */
export const NOTICES = [
  /** The devices of the two sides were exchanged; each is used for the side it is on. */
  "swapped_hands",
  "swapped_shins",
  /** The knees were bent while the person should have stood upright. */
  "bent_knees",
  "bent_elbows",
  /** The hands' turn is not measured, because the palms did not face down. */
  "palms_not_down",
  /** The eyes are lower, or higher, than the stated stature says: stance, shoes or floor. */
  "below_stated_stature",
  "above_stated_stature",
  /** The arms are shorter or longer than a body of this stature can be given. */
  "arms_limited",
  /** A goal was further from the body than it should be, also when calibrated once more. */
  "goal_error",
  /** No waist tracker: the hips are inferred from head and shins. */
  "waist_inferred",
  /** The shins are not tracked: no foot task. */
  "feet_not_tracked",
  /** The hands were not seen in the T-pose: arms of the usual length, devices where usual. */
  "arms_not_measured",
  /** The person did not squat or reach: nothing tests the calibration. */
  "not_tested",
  /** Nothing was measured: devices sit where people usually wear them. */
  "usual_offsets",
  /** Nobody wears anything: a script, a capture or a page moves a body of known measures. */
  "nothing_worn",
] as const;
export type Notice = (typeof NOTICES)[number];

/** Why somebody is calibrated: at first, by order, or after the origin had moved. */
export type Cause = "first" | "order" | "error" | "reset";

const Metres3 = v.tuple([v.number(), v.number(), v.number()]);
const PlaceSchema = v.object({
  positionM: Metres3,
  rotation: v.tuple([v.number(), v.number(), v.number(), v.number()]),
});
const Part = v.picklist(GOAL_PARTS);
const Device = v.picklist(["headset", "controller", "hand", "body", "tracker", "joint"]);

const CalibrationSchema = v.object({
  statureM: v.number(),
  /** From finger tip to finger tip; null if the arms were not measured. */
  spanM: v.nullable(v.number()),
  eyeHeightM: v.nullable(v.number()),
  /** Measured lengths, by the names of the avatar's configuration; the others are usual ones. */
  segmentsM: v.record(v.string(), v.number()),
  /** For each part, the joint in the frame of the device that tracks it; the head's: the eyes. */
  offsets: v.record(Part, v.object({ trackerFromGoal: PlaceSchema, device: Device })),
  /** Whether each side is tracked by the device of the other side. */
  swapsHands: v.boolean(),
  swapsShins: v.boolean(),
  /** How far each goal was off in the poses that test the calibration. */
  residualsM: v.record(Part, v.number()),
  /** What tracked each part. */
  sources: v.record(Part, v.string()),
  notices: v.array(v.picklist(NOTICES)),
});
export type Calibration = Readonly<v.InferOutput<typeof CalibrationSchema>>;
export type Offsets = Calibration["offsets"];

/** What a body is made for: its stature and the lengths that differ from the usual ones. */
export interface Measures {
  readonly statureM: number;
  readonly segmentsM: Readonly<Record<string, number>>;
}

/** What is said of somebody who was not measured, and why. */
export function unmeasured(
  statureM: number,
  spanM: number | null,
  notice: "usual_offsets" | "nothing_worn",
): Calibration {
  return {
    statureM,
    spanM,
    eyeHeightM: null,
    segmentsM: {},
    offsets: {},
    swapsHands: false,
    swapsShins: false,
    residualsM: {},
    sources: {},
    notices: [notice],
  };
}

export const isMeasured = ({ notices }: Calibration): boolean =>
  !notices.includes("usual_offsets") && !notices.includes("nothing_worn");

export const calibrationText = (calibration: Calibration): string => JSON.stringify(calibration);

/** The calibration in a stored text; null if it is none, such as one of another version. */
export function calibrationFrom(text: string): Calibration | null {
  try {
    return v.parse(CalibrationSchema, JSON.parse(text));
  } catch {
    return null;
  }
}

/** The report of a completed calibration; `revision` is that of the order it answers, or null. */
export function calibrationReport(
  calibration: Calibration,
  timeS: number,
  cause: Cause,
  revision: number | null,
): ReportBody {
  const { offsets, segmentsM } = calibration;
  const named = Object.entries(offsets).map(([part, { trackerFromGoal }]) => {
    const { positionM, rotation } = trackerFromGoal;
    return [part, { position_m: [...positionM], rotation: [...rotation] }];
  });
  return {
    kind: "calibration",
    t_s: timeS,
    revision,
    cause,
    stature_m: calibration.statureM,
    span_m: calibration.spanM,
    eye_height_m: calibration.eyeHeightM,
    ...(Object.keys(segmentsM).length > 0 && { segments_m: { ...segmentsM } }),
    tracker_from_goal: Object.fromEntries(named),
    residuals_m: { ...calibration.residualsM },
    sources: { ...calibration.sources },
    notices: [...calibration.notices],
  };
}
