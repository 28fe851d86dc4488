/**
 * The emulated headset: a WebXR device in a browser without one, for tests only.
 *
 * iwer emulates viewer, controllers, hands and sessions. What it lacks is added here: body tracking
 * (`frame.body`, the draft of the Immersive Web Community Group), input sources that are only
 * tracked (`session.trackedSources`), a `reset` with its transform, hands in any pose, poses that
 * are lost, and a device that sleeps. All poses are given in the room's frame, which is that of the
 * device's first `local-floor` space: metres, quaternions w, x, y, z.
 *
 * Install it before three is imported.
 */
import type { Place } from "@shared/avatar/hips";
import {
  minus,
  multiply,
  normalised,
  type Quaternion,
  rotate,
  type Vector,
} from "@shared/rotations";
import {
  metaQuest3,
  P_DEVICE,
  P_SESSION,
  P_SPACE,
  XRDevice,
  type XRDeviceConfig,
  XRFrame,
  XRReferenceSpace,
  XRReferenceSpaceEvent,
  XRRigidTransform,
  XRSession,
  XRSpace,
} from "iwer";
import {
  AT_ORIGIN,
  composed,
  inverted,
  placeAt,
  rotationTo,
  writeMatrix,
} from "../tracking/places";
import { unit } from "../tracking/script/movements";

const FORWARDS: Vector = [0, 0, -1];

export type Side = "left" | "right";

export interface EmulatedOptions {
  readonly frameRateHz?: number;
  /** Distance of the eyes. */
  readonly ipdM?: number;
  /** The browser's name; that of a Quest 3 by default. */
  readonly userAgent?: string;
  readonly bodyTracking?: boolean;
  readonly trackedSources?: boolean;
  readonly handTracking?: boolean;
}

type Feature = XRDeviceConfig["supportedFeatures"][number];
type Button = "select" | "squeeze";

const BUTTON_IDS: Readonly<Record<Button, string>> = { select: "trigger", squeeze: "squeeze" };

export class EmulatedHeadset {
  readonly device: XRDevice;
  private readonly body = new Map<string, XRSpace>();
  private readonly tracked = new Map<Side, TrackedSource>();
  private readonly joints: Record<Side, ReadonlyMap<string, Place> | null> = {
    left: null,
    right: null,
  };
  private readonly lost = new Set<XRSpace>();
  private isBodySeen = false;
  private bounds: readonly DOMPointReadOnly[] | undefined;
  private readonly restored: (() => void)[] = [];

  constructor(options: EmulatedOptions = {}) {
    const { bodyTracking = false, trackedSources = false, handTracking = true } = options;
    const features = metaQuest3.supportedFeatures.filter(
      (feature) => handTracking || feature !== "hand-tracking",
    ) as string[];
    if (bodyTracking) features.push("body-tracking");
    if (trackedSources) features.push("tracked-sources");
    this.device = new XRDevice(
      {
        ...metaQuest3,
        internalNominalFrameRate: options.frameRateHz ?? 90,
        supportedFeatures: features as Feature[],
        userAgent: options.userAgent ?? metaQuest3.userAgent,
      },
      { stereoEnabled: true, ipd: options.ipdM ?? 0.063 },
    );
    this.device.installRuntime({ forceInstall: true });
    this.device.controlMode = "programmatic";
    this.installBody();
    this.installTrackedSources();
    this.installLoss();
    this.installOffsets();
    this.installBounds();
    for (const side of ["left", "right"] as const) this.installHand(side);
  }

  /** The session that is running, or null. */
  get session(): XRSession | null {
    return this.device.activeSession ?? null;
  }

  setEyes({ positionM, rotation }: Place): void {
    put(this.device.position, this.device.quaternion, positionM, rotation);
  }

  /** Place a controller by its grip; its ray starts there and follows from the device's model. */
  setController(side: Side, grip: Place): void {
    const controller = this.controller(side);
    const ray = composed(grip, this.rayFromGrip(side));
    put(controller.position, controller.quaternion, ray.positionM, ray.rotation);
  }

  /** The grip, turned until the controller's ray, which is tilted against it, meets a point. */
  aimed(side: Side, grip: Place, pointM: Vector): Place {
    let turned = grip;
    for (let again = 0; again < 3; again++) {
      const ray = composed(turned, this.rayFromGrip(side));
      const way = unit(minus(pointM, ray.positionM), FORWARDS);
      const by = rotationTo(rotate(ray.rotation, FORWARDS), way);
      turned = { ...turned, rotation: normalised(multiply(by, turned.rotation)) };
    }
    return turned;
  }

  /** grip_from_ray of a controller: where its ray starts, along -z. */
  rayFromGrip(side: Side): Place {
    const offset = this.controller(side).inputSource.gripSpace?.[P_SPACE].offsetMatrix;
    return offset === undefined ? AT_ORIGIN : inverted(placeAt(offset));
  }

  /** Press or release a button of a controller; for a tracked hand, `select` is the pinch. */
  press(side: Side, button: Button, isDown: boolean): void {
    const value = isDown ? 1 : 0;
    if (this.device.primaryInputMode === "hand") {
      if (button === "select") this.hand(side).updatePinchValue(value);
      return;
    }
    this.controller(side).updateButtonValue(BUTTON_IDS[button], value);
  }

  /** Put the controllers down and show the hands, or the other way round. */
  useHands(isHands: boolean): void {
    this.device.primaryInputMode = isHands ? "hand" : "controller";
  }

  /**
   * Place a hand by its joints: each of WebXR's 25 names in the room's frame. Joints that are left
   * out are lost. The ray starts at the wrist.
   */
  setHand(side: Side, joints: ReadonlyMap<string, Place>): void {
    const hand = this.hand(side);
    const wrist = joints.get("wrist") ?? AT_ORIGIN;
    put(hand.position, hand.quaternion, wrist.positionM, wrist.rotation);
    this.joints[side] = joints;
  }

  /** Place a hand, in the device's own shape, by its ray, which starts at the wrist. */
  setHandRay(side: Side, ray: Place): void {
    const hand = this.hand(side);
    put(hand.position, hand.quaternion, ray.positionM, ray.rotation);
    this.joints[side] = null;
  }

  /** Place a joint of the body by its name in the draft, or take it away. */
  setBodyJoint(name: string, place: Place | null): void {
    if (place === null) {
      this.body.delete(name);
      return;
    }
    this.isBodySeen = true;
    const space = this.body.get(name) ?? new XRSpace(this.world);
    writeMatrix(space[P_SPACE].offsetMatrix, place);
    this.body.set(name, space);
  }

  /** Whether the headset sees a body at all; `frame.body` is null otherwise. */
  showBody(isSeen: boolean): void {
    this.isBodySeen = isSeen;
  }

  /** Place a controller that is only tracked, such as one strapped to a shin; null removes it. */
  setTrackedSource(side: Side, place: Place | null): void {
    if (place === null) {
      this.tracked.delete(side);
      return;
    }
    const source = this.tracked.get(side) ?? trackedSource(side, this.world);
    writeMatrix(source.gripSpace[P_SPACE].offsetMatrix, place);
    this.tracked.set(side, source);
  }

  /** Lose the pose of something, or find it again. */
  setLost(
    what: "eyes" | `controller ${Side}` | `hand ${Side}` | `tracked ${Side}`,
    isLost: boolean,
  ): void {
    for (const space of this.spacesOf(what)) {
      if (isLost) this.lost.add(space);
      else this.lost.delete(space);
    }
  }

  /** Take a controller out of the session, as when its battery is empty. */
  setConnected(side: Side, isConnected: boolean): void {
    this.controller(side).connected = isConnected;
    this.hand(side).connected = isConnected;
  }

  /** What the session's `visibilityState` becomes with the next frame. */
  setVisibility(state: "visible" | "visible-blurred" | "hidden"): void {
    this.device.updateVisibilityState(
      state as unknown as Parameters<XRDevice["updateVisibilityState"]>[0],
    );
  }

  /**
   * The wearer recentres: the origin of every floor space moves to `origin` in the room's frame, and
   * each fires `reset` with the new origin in the old space.
   */
  recentre(origin: Place): void {
    for (const space of this.session?.[P_SESSION].referenceSpaces ?? []) {
      const matrix = space[P_SPACE].offsetMatrix;
      const moved = composed(inverted(placeAt(matrix)), origin);
      writeMatrix(matrix, origin);
      const [x, y, z] = moved.positionM;
      const [qw, qx, qy, qz] = moved.rotation;
      const transform = new XRRigidTransform(
        { x, y, z, w: 1 } as DOMPointReadOnly,
        { x: qx, y: qy, z: qz, w: qw } as DOMPointReadOnly,
      );
      space.dispatchEvent(new XRReferenceSpaceEvent("reset", { referenceSpace: space, transform }));
    }
  }

  /** The system ends the session: the headset was taken off for too long, or its button pressed. */
  async endSession(): Promise<void> {
    await this.session?.end();
  }

  /**
   * The space that the headset guards, by its corners on the floor of the room, metres; without a
   * call the browser tells nothing about it. Call it before the session begins.
   */
  setBounds(cornersM: readonly (readonly [x: number, z: number])[]): void {
    this.bounds = cornersM.map(([x, z]) => ({ x, y: 0, z, w: 1 }) as DOMPointReadOnly);
  }

  /** iwer's bounded spaces have no bounds. */
  private installBounds(): void {
    const read = () => this.bounds;
    Object.defineProperty(XRReferenceSpace.prototype, "boundsGeometry", {
      configurable: true,
      get: read,
    });
  }

  /** Give the page its own WebXR back. */
  uninstall(): void {
    for (const restore of this.restored) restore();
    this.device.uninstallRuntime();
  }

  private get world() {
    return this.device[P_DEVICE].globalSpace;
  }

  private controller(side: Side) {
    return known(this.device.controllers[side as keyof XRDevice["controllers"]], side);
  }

  private hand(side: Side) {
    return known(this.device.hands[side as keyof XRDevice["hands"]], side);
  }

  private spacesOf(what: string): readonly XRSpace[] {
    const [kind, name] = what.split(" ");
    const side = name as Side;
    if (kind === "eyes") return [this.device.viewerSpace];
    if (kind === "tracked") return [this.tracked.get(side)?.gripSpace ?? []].flat();
    const { inputSource } = kind === "hand" ? this.hand(side) : this.controller(side);
    const { targetRaySpace, gripSpace, hand } = inputSource;
    return [targetRaySpace, gripSpace ?? [], ...(hand?.values() ?? [])].flat();
  }

  /** `frame.body` of the draft: an iterable of names and spaces; null while no body is seen. */
  private installBody(): void {
    Object.defineProperty(XRFrame.prototype, "body", {
      configurable: true,
      get: () => (this.isBodySeen && this.isEnabled("body-tracking") ? this.body : null),
    });
  }

  private installTrackedSources(): void {
    Object.defineProperty(XRSession.prototype, "trackedSources", {
      configurable: true,
      get: () => (this.isEnabled("tracked-sources") ? [...this.tracked.values()] : []),
    });
  }

  private isEnabled(feature: string): boolean {
    const enabled: readonly string[] = this.session?.[P_SESSION].enabledFeatures ?? [];
    return enabled.includes(feature);
  }

  /** iwer always has a pose for everything; a real device answers null for what it has lost. */
  private installLoss(): void {
    const { getPose, getJointPose, getViewerPose, fillPoses } = XRFrame.prototype;
    const { lost } = this;
    const isLost = (space: XRSpace): boolean => lost.size > 0 && lost.has(space);
    const viewer = this.device.viewerSpace;
    this.restored.push(() => {
      Object.assign(XRFrame.prototype, { getPose, getJointPose, getViewerPose, fillPoses });
    });
    Object.assign(XRFrame.prototype, {
      getPose(this: XRFrame, ...given: Parameters<typeof getPose>) {
        return isLost(given[0]) ? null : getPose.apply(this, given);
      },
      getJointPose(this: XRFrame, ...given: Parameters<typeof getJointPose>) {
        return isLost(given[0]) ? null : getJointPose.apply(this, given);
      },
      getViewerPose(this: XRFrame, ...given: Parameters<typeof getViewerPose>) {
        return isLost(viewer) ? null : getViewerPose.apply(this, given);
      },
      fillPoses(this: XRFrame, ...given: Parameters<typeof fillPoses>) {
        return [...given[0]].some(isLost) ? false : fillPoses.apply(this, given);
      },
    });
  }

  /** iwer takes the offset for a matrix, where WebXR and every page give a rigid transform. */
  private installOffsets(): void {
    const { getOffsetReferenceSpace } = XRReferenceSpace.prototype;
    this.restored.push(() => {
      Object.assign(XRReferenceSpace.prototype, { getOffsetReferenceSpace });
    });
    Object.assign(XRReferenceSpace.prototype, {
      getOffsetReferenceSpace(this: XRReferenceSpace, offset: XRRigidTransform) {
        return getOffsetReferenceSpace.call(this, offset.matrix);
      },
    });
  }

  /** Let the hand's joints be where `setHand` says; until then, iwer's own poses are shown. */
  private installHand(side: Side): void {
    const hand = this.hand(side);
    const own = hand.updateHandPose.bind(hand);
    hand.updateHandPose = () => {
      const joints = this.joints[side];
      if (joints === null) {
        own();
        return;
      }
      // The joints' spaces hang on the ray's, which lies at the wrist.
      const world = inverted(placeAt(hand.inputSource.targetRaySpace[P_SPACE].offsetMatrix));
      for (const [name, space] of hand.inputSource.hand ?? []) {
        const place = joints.get(name);
        if (place === undefined) {
          this.lost.add(space);
          continue;
        }
        this.lost.delete(space);
        writeMatrix(space[P_SPACE].offsetMatrix, composed(world, place));
      }
    };
  }
}

interface TrackedSource {
  readonly handedness: Side;
  readonly targetRayMode: "tracked-pointer";
  readonly profiles: readonly string[];
  readonly targetRaySpace: XRSpace;
  readonly gripSpace: XRSpace;
}

function trackedSource(handedness: Side, world: XRSpace): TrackedSource {
  const gripSpace = new XRSpace(world);
  return {
    handedness,
    targetRayMode: "tracked-pointer",
    profiles: ["meta-quest-touch-pro"],
    targetRaySpace: gripSpace,
    gripSpace,
  };
}

function known<Input>(input: Input | undefined, side: Side): Input {
  if (input === undefined) throw new Error(`The emulated device has nothing on the ${side} side.`);
  return input;
}

function put(
  position: XRDevice["position"],
  quaternion: XRDevice["quaternion"],
  [x, y, z]: Vector,
  [qw, qx, qy, qz]: Quaternion,
): void {
  position.set(x, y, z);
  quaternion.set(qx, qy, qz, qw);
}
