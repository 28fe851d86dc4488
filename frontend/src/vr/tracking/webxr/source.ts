/**
 * What a headset in WebXR tracks: head, hands with or without controllers, and legs where the device
 * or something strapped to them knows these.
 *
 * The source follows what is there, frame by frame: people put controllers down and take them up
 * again. Its `kind` names the best of what is there: shins with controllers of their own (`tracked-sources`,
 * WebXR's way for controllers that are not held), then the browser's body tracking, then tracked
 * hands, then controllers. `allow` leaves ways out, such as the operator's choice. The lab's trackers
 * that the server brings go before the legs that the device itself knows.
 */
import type { Place } from "@shared/avatar/hips";
import { type DeviceKey, legsOfBodyTracking } from "../devices";
import {
  clear,
  type FrameBuffer,
  frameBuffer,
  HAND_SIDES,
  type HandSide,
  inferHips,
  set,
} from "../frameBuffer";
import { placeOf } from "../places";
import type { ServerTrackers } from "../server/trackers";
import type { GoalPart, GoalState, SourceKind, TrackedFrame, TrackingSource } from "../tracked";
import { BodyReader } from "./body";
import { HandReader } from "./hand";
import type { Room } from "./room";

export type XrWay = Extract<
  SourceKind,
  "controllers" | "hands" | "body_tracking" | "shin_controllers"
>;
export const XR_WAYS: readonly XrWay[] = [
  "controllers",
  "hands",
  "body_tracking",
  "shin_controllers",
];

const HAND_PARTS = { left: "LeftHand", right: "RightHand" } as const;
const SHIN_PARTS = { left: "LeftLowerLeg", right: "RightLowerLeg" } as const;
const UPPER: readonly GoalPart[] = ["Head", "LeftHand", "RightHand"];
const WITH_SHINS: ReadonlySet<GoalPart> = new Set<GoalPart>([
  ...UPPER,
  "LeftLowerLeg",
  "RightLowerLeg",
]);
const WITH_BODY: ReadonlySet<GoalPart> = new Set<GoalPart>([...WITH_SHINS, "Hips"]);
const WITHOUT_LEGS: ReadonlySet<GoalPart> = new Set(UPPER);

interface SessionWithTracked {
  readonly trackedSources?: Iterable<XRInputSource>;
}

export class XrSource implements TrackingSource {
  readonly knownBody = null;
  private readonly buffer: FrameBuffer = frameBuffer();
  private readonly readers: Readonly<Record<HandSide, HandReader>> = {
    left: new HandReader("left"),
    right: new HandReader("right"),
  };
  private readonly body = new BodyReader();
  private readonly bodyLegs: GoalState;
  private allowed: ReadonlySet<XrWay> = new Set(XR_WAYS);
  private seen: XrWay | "server_trackers" = "controllers";

  constructor(
    private readonly session: XRSession,
    private readonly room: Room,
    device: DeviceKey,
    private readonly lab: ServerTrackers | null = null,
  ) {
    this.bodyLegs = legsOfBodyTracking(device);
  }

  get kind(): XrWay | "server_trackers" {
    return this.seen;
  }

  /** Legs that are made up from the upper body are not measured. */
  get measures(): ReadonlySet<GoalPart> {
    if (this.seen === "server_trackers") {
      return this.buffer.parts.Hips.device === "tracker" ? WITH_BODY : WITH_SHINS;
    }
    if (this.seen === "shin_controllers") return WITH_SHINS;
    return this.seen === "body_tracking" && this.bodyLegs === "tracked" ? WITH_BODY : WITHOUT_LEGS;
  }

  /** Use only these ways from the next frame on; at least one of controllers and hands is needed. */
  allow(ways: Iterable<XrWay>): void {
    const allowed = new Set(ways);
    if (!allowed.has("controllers") && !allowed.has("hands")) {
      throw new RangeError("Allow controllers or hands: without them nothing tracks the hands.");
    }
    this.allowed = allowed;
  }

  read(timeS: number, frame: XRFrame | null): TrackedFrame {
    const { buffer } = this;
    clear(buffer, timeS);
    if (frame === null) return buffer;
    const viewer = frame.getViewerPose(this.room.space) ?? null;
    if (viewer !== null) {
      buffer.eyes = placeOf(viewer.transform);
      // An emulated position is guessed from the neck: the headset has lost its place.
      set(
        buffer.parts.Head,
        buffer.eyes,
        "headset",
        viewer.emulatedPosition ? "inferred" : "tracked",
      );
    }
    const hasHands = this.readHands(timeS, frame);
    this.seen = hasHands ? "hands" : "controllers";
    if (this.allowed.has("body_tracking") && this.readBody(frame)) this.seen = "body_tracking";
    if (this.allowed.has("shin_controllers") && this.readShins(frame))
      this.seen = "shin_controllers";
    if (this.lab?.read(buffer) === true) this.seen = "server_trackers";
    inferHips(buffer);
    return buffer;
  }

  dispose(): void {}

  /** Whether a hand without a controller was read. */
  private readHands(timeS: number, frame: XRFrame): boolean {
    const { parts, hands } = this.buffer;
    let hasHands = false;
    for (const side of HAND_SIDES) {
      const [part, hand] = [parts[HAND_PARTS[side]], hands[side]];
      let isSeen = false;
      for (const source of this.session.inputSources) {
        if (source.handedness !== side || source.targetRayMode !== "tracked-pointer") continue;
        const isHand = source.hand !== undefined && source.hand !== null;
        if (!this.allowed.has(isHand ? "hands" : "controllers")) continue;
        // Some devices list both: a controller that is held goes before the hand that holds it.
        if (isSeen && isHand) continue;
        const { space } = this.room;
        if (!this.readers[side].read(source, frame, space, timeS, part, hand)) continue;
        isSeen = true;
      }
      if (!isSeen) this.readers[side].release();
      else if (!hand.holdsController) hasHands = true;
    }
    return hasHands;
  }

  private readBody(frame: XRFrame): boolean {
    if (!this.body.read(frame, this.room.space)) return false;
    const { parts } = this.buffer;
    for (const part of ["LeftLowerLeg", "RightLowerLeg", "Hips"] as const) {
      const place = this.body.place(part);
      if (place !== null) set(parts[part], place, "body", this.bodyLegs);
    }
    // Held controllers and tracked hands know the hands better than the body does.
    for (const part of ["LeftHand", "RightHand"] as const) {
      const place = this.body.place(part);
      if (place !== null && parts[part].place === null) set(parts[part], place, "body", "inferred");
    }
    return parts.LeftLowerLeg.place !== null && parts.RightLowerLeg.place !== null;
  }

  /** Controllers that are only tracked, strapped to the shins: left and right as they are sold. */
  private readShins(frame: XRFrame): boolean {
    const sources = (this.session as unknown as SessionWithTracked).trackedSources ?? [];
    let found = 0;
    for (const { handedness, gripSpace, targetRaySpace } of sources) {
      if (handedness !== "left" && handedness !== "right") continue;
      const place = this.locate(gripSpace ?? targetRaySpace, frame);
      if (place === null) continue;
      set(this.buffer.parts[SHIN_PARTS[handedness]], place, "tracker");
      found++;
    }
    return found > 0;
  }

  private locate(space: XRSpace, frame: XRFrame): Place | null {
    const pose = frame.getPose(space, this.room.space) ?? null;
    return pose === null ? null : placeOf(pose.transform);
  }
}
