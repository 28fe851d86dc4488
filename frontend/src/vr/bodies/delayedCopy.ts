/**
 * The remote body of a study with a delayed copy: the participant's own movement, delayed in every
 * joint but the hips. The server's `app/simulated_people/avatars.DelayedCopy`.
 */
import { FINGER_PARTS, JOINTS } from "@shared/avatar/anatomy.generated";
import { DelayBuffer } from "@shared/avatar/physics/delayBuffer";
import { SimulationError } from "@shared/avatar/physics/modelTable";
import type { Health } from "@shared/avatar/physics/simulation";
import { CapsuleContacts } from "../tasks/contacts";
import type { SegmentsM } from "./armLengths";
import { Capsules } from "./capsules";
import type { RemoteBody } from "./remoteBody";
import type { SurfaceBox } from "./setup";

const JOINT_VALUES = 4 * JOINTS.length;
const HEALTHY: Health = {
  restored: 0,
  resets: 0,
  ignoredInputs: 0,
  limitedTargets: 0,
  teleports: 0,
};

export class DelayedCopy implements RemoteBody {
  readonly pose = new Float64Array(3 + JOINT_VALUES);
  readonly fingers: Float64Array | null;
  readonly skippedGaps = 0;
  readonly health = HEALTHY;
  hasMoved = false;
  private readonly buffer: DelayBuffer;
  private readonly given: Float64Array;
  private readonly capsules: Capsules;
  private contacts: CapsuleContacts;

  constructor(
    statureM: number,
    withFingers: boolean,
    private readonly surfaces: readonly SurfaceBox[],
    segmentsM?: SegmentsM,
  ) {
    this.fingers = withFingers ? new Float64Array(4 * FINGER_PARTS.length) : null;
    this.given = new Float64Array(JOINT_VALUES + (this.fingers?.length ?? 0));
    this.buffer = new DelayBuffer(this.given.length);
    this.capsules = new Capsules(statureM, withFingers, segmentsM);
    this.contacts = this.contactsWith([]);
  }

  get touched(): Uint8Array {
    return this.contacts.touched;
  }

  get near(): Uint8Array {
    return this.contacts.near;
  }

  putOn(): void {
    this.hasMoved = false;
  }

  setLatency(latencyS: number): void {
    this.buffer.setDelay(latencyS);
  }

  showSurfaces(keys: readonly string[]): void {
    const shown = keys.map((key) => {
      const found = this.surfaces.find((surface) => surface.key === key);
      if (found === undefined) throw new SimulationError(`There is no surface ${key}.`);
      return found;
    });
    this.contacts = this.contactsWith(shown);
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
    if (this.touched.length === 0) return;
    this.capsules.place(pose, this.fingers);
    this.contacts.find(this.capsules.axesM, this.capsules.radiiM);
  }

  dispose(): void {
    this.contacts = this.contactsWith([]);
  }

  private contactsWith(shown: readonly SurfaceBox[]): CapsuleContacts {
    return new CapsuleContacts(shown, this.capsules.radiiM.length);
  }
}
