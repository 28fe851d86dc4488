/**
 * The remote body of a study with a delayed copy: the participant's own movement, delayed in every
 * joint but the hips. The server's `app/rehearsal/avatars.DelayedCopy`.
 */
import { FINGER_PARTS, JOINTS } from "@shared/avatar/anatomy.generated";
import { Capsules, segmentBoxDistanceM } from "./capsules";
import { DelayBuffer } from "./physics/delayBuffer";
import { SimulationError } from "./physics/modelTable";
import type { Health } from "./physics/simulation";
import type { RemoteBody } from "./remoteBody";
import type { SurfaceBox } from "./setup";

const JOINT_VALUES = 4 * JOINTS.length;
const RELEASE_MARGIN_M = 0.005;
const HEALTHY: Health = {
  restored: 0,
  resets: 0,
  ignoredInputs: 0,
  limitedTargets: 0,
  teleports: 0,
};

interface Box {
  readonly low: readonly number[];
  readonly high: readonly number[];
}

export class DelayedCopy implements RemoteBody {
  readonly pose = new Float64Array(3 + JOINT_VALUES);
  readonly fingers: Float64Array | null;
  readonly skippedGaps = 0;
  readonly health = HEALTHY;
  touched = new Uint8Array(0);
  near = new Uint8Array(0);
  hasMoved = false;
  private readonly buffer: DelayBuffer;
  private readonly given: Float64Array;
  private readonly capsules: Capsules;
  private shown: readonly Box[] = [];

  constructor(
    statureM: number,
    withFingers: boolean,
    private readonly surfaces: readonly SurfaceBox[],
  ) {
    this.fingers = withFingers ? new Float64Array(4 * FINGER_PARTS.length) : null;
    this.given = new Float64Array(JOINT_VALUES + (this.fingers?.length ?? 0));
    this.buffer = new DelayBuffer(this.given.length);
    this.capsules = new Capsules(statureM, withFingers);
  }

  putOn(): void {
    this.hasMoved = false;
  }

  setLatency(latencyS: number): void {
    this.buffer.setDelay(latencyS);
  }

  showSurfaces(keys: readonly string[]): void {
    this.shown = keys.map((key) => {
      const found = this.surfaces.find((surface) => surface.key === key);
      if (found === undefined) throw new SimulationError(`There is no surface ${key}.`);
      const { centerM, halfSizeM } = found;
      return {
        low: centerM.map((value, i) => value - (halfSizeM[i] as number)),
        high: centerM.map((value, i) => value + (halfSizeM[i] as number)),
      };
    });
    const size = keys.length * this.capsules.radiiM.length;
    this.touched = new Uint8Array(size);
    this.near = new Uint8Array(size);
  }

  change(): never {
    throw new SimulationError("A delayed copy has no motors and no colliders to change.");
  }

  frame(timeS: number, own: Float64Array, fingers: Float64Array | null): void {
    const { given, pose } = this;
    for (let i = 0; i < JOINT_VALUES; i++) given[i] = own[3 + i] as number;
    if (this.fingers !== null && fingers !== null) given.set(fingers, JOINT_VALUES);
    const delayed = this.buffer.push(timeS, given);
    for (let i = 0; i < 3; i++) pose[i] = own[i] as number;
    for (let i = 0; i < JOINT_VALUES; i++) pose[3 + i] = delayed[i] as number;
    if (this.fingers !== null) {
      for (let i = 0; i < this.fingers.length; i++) {
        this.fingers[i] = delayed[JOINT_VALUES + i] as number;
      }
    }
    this.hasMoved = true;
    if (this.shown.length > 0) this.readTouches();
  }

  dispose(): void {
    this.shown = [];
  }

  private readTouches(): void {
    const { capsules, touched, near, shown } = this;
    capsules.place(this.pose, this.fingers);
    const { axesM, radiiM } = capsules;
    for (let surface = 0; surface < shown.length; surface++) {
      const { low, high } = shown[surface] as Box;
      for (let part = 0; part < radiiM.length; part++) {
        const distanceM = segmentBoxDistanceM(axesM, 6 * part, low, high);
        const pair = surface * radiiM.length + part;
        const radiusM = radiiM[part] as number;
        // Comparisons with NaN, of a hand that is not tracked, are false.
        touched[pair] = distanceM <= radiusM ? 1 : 0;
        near[pair] = distanceM <= radiusM + RELEASE_MARGIN_M ? 1 : 0;
      }
    }
  }
}
