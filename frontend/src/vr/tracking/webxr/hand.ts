/** One hand in WebXR: a controller in it, or its 25 joints. */
import type { Quaternion, Vector } from "@shared/rotations";
import {
  FINGER_VALUES,
  type HandSide,
  type MutableHand,
  type MutablePart,
  set,
} from "../frameBuffer";
import { placeAt, placeOf } from "../places";
import { FINGER_JOINTS, handRotation, writeFingers } from "./fingers";
import { fistDetector, openness, pinchDetector, pinchGapM } from "./pinch";

/** Buttons of WebXR's standard gamepad (`xr-standard`). */
const TRIGGER = 0;
const GRIP = 1;
const PRESSED = 0.5;

/** In WebXR's hand input, but not in the types of it that we use. */
interface FillsPoses {
  fillPoses?(spaces: readonly XRSpace[], base: XRSpace, transforms: Float32Array): boolean;
}

export class HandReader {
  private readonly pinch = pinchDetector();
  private readonly fist = fistDetector();
  private readonly fingers = new Float64Array(FINGER_VALUES);
  private readonly lastWrist: { rotation: Quaternion } = { rotation: [1, 0, 0, 0] };
  private spaces: readonly XRJointSpace[] = [];
  private names: readonly XRHandJoint[] = [];
  private matrices = new Float32Array(0);
  private readonly positions = new Map<XRHandJoint, Vector>();
  private readonly rotations = new Map<XRHandJoint, Quaternion>();
  private handOfSpaces: XRHand | null = null;

  constructor(private readonly side: HandSide) {}

  /** Read a controller or a tracked hand; false if it has no pose in this frame. */
  read(
    source: XRInputSource,
    frame: XRFrame,
    space: XRReferenceSpace,
    timeS: number,
    part: MutablePart,
    into: MutableHand,
  ): boolean {
    const isSeen =
      source.hand === undefined || source.hand === null
        ? this.readController(source, frame, space, part, into)
        : this.readJoints(source.hand, part, into, frame, space, timeS);
    if (isSeen) into.ray = this.ray(source, frame, space);
    return isSeen;
  }

  /** The hand is not there: its gestures end. */
  release(): void {
    this.pinch.release();
    this.fist.release();
  }

  private readController(
    { gripSpace, gamepad }: XRInputSource,
    frame: XRFrame,
    space: XRReferenceSpace,
    part: MutablePart,
    into: MutableHand,
  ): boolean {
    const grip = gripSpace === undefined ? null : (frame.getPose(gripSpace, space) ?? null);
    if (grip === null) return false;
    set(part, placeOf(grip.transform), "controller");
    into.holdsController = true;
    into.isSelecting = (gamepad?.buttons[TRIGGER]?.value ?? 0) > PRESSED;
    into.isSqueezing = (gamepad?.buttons[GRIP]?.value ?? 0) > PRESSED;
    return true;
  }

  private readJoints(
    hand: XRHand,
    part: MutablePart,
    into: MutableHand,
    frame: XRFrame,
    space: XRReferenceSpace,
    timeS: number,
  ): boolean {
    this.locate(hand, frame, space);
    const wrist = this.positions.get("wrist");
    const rotation = this.rotations.get("wrist");
    if (wrist === undefined || rotation === undefined) {
      this.release();
      return false;
    }
    this.lastWrist.rotation = rotation;
    set(part, { positionM: wrist, rotation: handRotation(this.side, rotation) }, "hand");
    const position = (name: XRHandJoint): Vector | null => this.positions.get(name) ?? null;
    into.holdsController = false;
    into.isSelecting = this.pinch.at(timeS, pinchGapM(position));
    into.isSqueezing = this.fist.at(timeS, openness(position));
    into.fingers = this.readFingers();
    return true;
  }

  /** The fingers, or null if a joint of theirs has no pose: a hand is tracked whole or not at all. */
  private readFingers(): Float64Array | null {
    if (FINGER_JOINTS.some((name) => !this.rotations.has(name))) return null;
    writeFingers(this.side, this.rotationOf, this.fingers);
    return this.fingers;
  }

  private readonly rotationOf = (part: number | null): Quaternion =>
    this.rotations.get(part === null ? "wrist" : (FINGER_JOINTS[part] as XRHandJoint)) ??
    this.lastWrist.rotation;

  /** All joints at once where the browser can; else one by one, as some may be lost. */
  private locate(hand: XRHand, frame: XRFrame, space: XRReferenceSpace): void {
    if (hand !== this.handOfSpaces) {
      this.handOfSpaces = hand;
      this.names = [...hand.keys()];
      this.spaces = [...hand.values()];
      this.matrices = new Float32Array(16 * this.spaces.length);
    }
    this.positions.clear();
    this.rotations.clear();
    const { fillPoses } = frame as XRFrame & FillsPoses;
    if (fillPoses?.call(frame, this.spaces, space, this.matrices) === true) {
      for (const [index, name] of this.names.entries()) {
        const { positionM, rotation } = placeAt(this.matrices, 16 * index);
        this.positions.set(name, positionM);
        this.rotations.set(name, rotation);
      }
      return;
    }
    for (const [index, name] of this.names.entries()) {
      const pose = frame.getJointPose?.(this.spaces[index] as XRJointSpace, space) ?? null;
      if (pose === null) continue;
      const { positionM, rotation } = placeOf(pose.transform);
      this.positions.set(name, positionM);
      this.rotations.set(name, rotation);
    }
  }

  private ray({ targetRaySpace }: XRInputSource, frame: XRFrame, space: XRReferenceSpace) {
    const pose = frame.getPose(targetRaySpace, space) ?? null;
    if (pose === null) return null;
    const { matrix, position } = pose.transform;
    const originM: Vector = [position.x, position.y, position.z];
    // The ray leads along -z of its space.
    const direction: Vector = [-(matrix[8] ?? 0), -(matrix[9] ?? 0), -(matrix[10] ?? 1)];
    return { originM, direction };
  }
}
