/**
 * What the participant's devices report in one frame, whichever devices they are.
 *
 * Every way of tracking (controllers, hands, body tracking, trackers of the lab, a script, a
 * capture, mouse and keyboard) is a `TrackingSource` and delivers the same `TrackedFrame`, before
 * calibration: poses of devices, in the room's frame, not of joints. World: +x right, +y up, the
 * participant faces -z, origin on the floor at the centre of the start square; metres, seconds,
 * quaternions w, x, y, z.
 */
import type { GOAL_PARTS } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import type { Vector } from "@shared/rotations";

export type GoalPart = (typeof GOAL_PARTS)[number];

/**
 * Whether a device measures the part (`tracked`), something else suggests where it is (`inferred`:
 * legs made up from the upper body, a waist from head and shins), or neither (`lost`).
 */
export type GoalState = "tracked" | "inferred" | "lost";

/**
 * What gives the pose of a part: it decides which calibrated offset leads from there to the joint.
 * A `hand` is the wrist of a tracked hand and a `joint` that of a body that the source moves itself,
 * both with the T-pose's axes: neither needs an offset.
 */
export type TrackingDevice = "headset" | "controller" | "hand" | "body" | "tracker" | "joint";

export interface TrackedPart {
  /**
   * The pose of the device at the part; null if it is lost, or if it is only known to inverse
   * kinematics (a waist that is inferred from head and shins).
   */
  readonly place: Place | null;
  readonly state: GoalState;
  /** Null without a place. */
  readonly device: TrackingDevice | null;
}

/** What a hand, or the controller in it, does besides being somewhere. */
export interface HandInput {
  /** Local rotations w, x, y, z of the hand's 15 finger parts (60); null without tracked fingers. */
  readonly fingers: Float64Array | null;
  /** Where it points. */
  readonly ray: { readonly originM: Vector; readonly direction: Vector } | null;
  /** Trigger or pinch. */
  readonly isSelecting: boolean;
  /** Grip button, or a fist. */
  readonly isSqueezing: boolean;
  readonly holdsController: boolean;
}

export interface TrackedFrame {
  /** The client's monotonic time of the frame: that of the session's callback. */
  readonly timeS: number;
  /** The eyes; null while the headset has lost its place. */
  readonly eyes: Place | null;
  readonly parts: Readonly<Record<GoalPart, TrackedPart>>;
  readonly hands: { readonly left: HandInput; readonly right: HandInput };
}

export type SourceKind =
  | "controllers"
  | "hands"
  | "body_tracking"
  | "shin_controllers"
  | "server_trackers"
  | "script"
  | "capture"
  | "desktop";

/** The measures of a body that is not measured, because a script, a capture or a page moves it. */
export interface KnownBody {
  readonly statureM: number;
  /** From finger tip to finger tip in the T-pose. */
  readonly spanM: number;
}

/** One way of tracking. It reads without allocating where it can: it is called every frame. */
export interface TrackingSource {
  readonly kind: SourceKind;
  /** Parts that this source can measure at all; feet need both shins. */
  readonly measures: ReadonlySet<GoalPart>;
  /**
   * Set if the source moves a body of its own: then its places are those of joints, in the world's
   * frame, and there is nothing to calibrate. Null for devices that somebody wears.
   */
  readonly knownBody: KnownBody | null;
  /** Read the devices; the frame is valid until the next call. `frame` is null without WebXR. */
  read(timeS: number, frame: XRFrame | null): TrackedFrame;
  dispose(): void;
}
