/** The remote body of a physics avatar: the server's `app/simulated_people/avatars.PhysicsBody`. */
import { FINGER_PARTS, JOINTS } from "@shared/avatar/anatomy.generated";
import type { Mujoco } from "@shared/avatar/mujoco";
import { Follower } from "@shared/avatar/physics/follower";
import {
  asConfigured,
  limitsInForce,
  ordered,
  type RunningSettings,
  worldLimbs,
} from "@shared/avatar/physics/settings";
import { type Health, PhysicsAvatar } from "@shared/avatar/physics/simulation";
import { TargetAngles } from "@shared/avatar/physics/targetAngles";
import { SurfaceTouches } from "@shared/avatar/physics/touches";
import type { AvatarOrder } from "../telemetry/wire/fromServer";
import type { RemoteBody } from "./remoteBody";
import type { AvatarAnswer } from "./setup";

const RELEASE_MARGIN_M = 0.005;
/** A longer gap between two frames is not simulated. */
const GAP_S = 0.1;
const FIRST_INTERVAL_S = 1 / 90;
/** Greatest speed of the motors' targets while the body catches up after a gap. */
const CATCH_UP_RAD_S = 4;
const HIPS_VALUES = 7;
const NONE = new Uint8Array(0);

export class FollowedBody implements RemoteBody {
  readonly pose = new Float64Array(3 + 4 * JOINTS.length);
  readonly fingers: Float64Array | null;
  skippedGaps = 0;
  readonly avatar: PhysicsAvatar;
  private readonly follower: Follower;
  private readonly configured: RunningSettings;
  private readonly hips = new Float64Array(HIPS_VALUES);
  private readonly rotations = new Float64Array(4 * JOINTS.length);
  private readonly given: Float64Array | null;
  private touches: SurfaceTouches | null = null;
  private hasBegun = false;
  private lastS = 0;
  private intervalS = FIRST_INTERVAL_S;
  /** The avatar's clock is the frames' minus this. */
  private offsetS = 0;

  /** `hipsScale`: the height of its hips when standing, as a share of the participant's. */
  constructor(
    mujoco: Mujoco,
    answer: AvatarAnswer,
    private readonly hipsScale: number,
    withFingers: boolean,
    private readonly parts: readonly string[],
  ) {
    const { configuration } = answer;
    this.avatar = new PhysicsAvatar(mujoco, answer.mjcf);
    this.avatar.boxes.show([]);
    const present = new Set(this.avatar.table.bodies.keys());
    const angles = new TargetAngles(limitsInForce(configuration), present);
    this.follower = new Follower(
      this.avatar,
      angles,
      configuration.target_space,
      worldLimbs(configuration),
    );
    this.configured = asConfigured(configuration);
    this.fingers = withFingers ? new Float64Array(4 * FINGER_PARTS.length) : null;
    this.given = withFingers ? new Float64Array(4 * FINGER_PARTS.length) : null;
  }

  get hasMoved(): boolean {
    return this.hasBegun;
  }

  get health(): Health {
    return this.avatar.health;
  }

  get touched(): Uint8Array {
    return this.touches?.touched ?? NONE;
  }

  get near(): Uint8Array {
    return this.touches?.near ?? NONE;
  }

  putOn(): void {
    if (!this.hasBegun) return;
    this.avatar.rewind();
    this.hasBegun = false;
  }

  setLatency(latencyS: number): void {
    this.follower.setDelay(latencyS);
  }

  showSurfaces(keys: readonly string[]): void {
    const { avatar } = this;
    avatar.boxes.show(keys);
    this.touches =
      keys.length === 0
        ? null
        : new SurfaceTouches(
            avatar.views,
            avatar.table,
            avatar.boxes,
            avatar.contacts,
            keys,
            RELEASE_MARGIN_M,
            this.parts,
          );
  }

  change(order: AvatarOrder): Readonly<Record<string, number>> {
    this.avatar.switches.apply(ordered(this.configured, order));
    return this.avatar.switches.heldRad;
  }

  frame(timeS: number, own: Float64Array, fingers: Float64Array | null): void {
    const { hips, rotations } = this;
    hips.set(own.subarray(0, HIPS_VALUES));
    hips[1] = this.hipsScale * (own[1] as number);
    rotations.set(own.subarray(3));
    const known = this.knownFingers(fingers);
    if (!this.hasBegun) {
      this.hasBegun = true;
      this.offsetS = timeS;
      this.intervalS = FIRST_INTERVAL_S;
      this.follower.start(hips, rotations, known);
    } else this.skipGap(timeS);
    this.lastS = timeS;
    this.follower.frame(timeS - this.offsetS, hips, rotations, known);
    this.avatar.writePose(this.pose);
    if (this.fingers !== null) this.avatar.writeFingers(this.fingers);
    this.touches?.read();
  }

  dispose(): void {
    this.avatar.dispose();
  }

  /** Leave a gap in the frames out of the simulated time, and move to the next pose gently. */
  private skipGap(timeS: number): void {
    const elapsedS = timeS - this.lastS;
    if (elapsedS <= GAP_S) {
      this.intervalS = elapsedS;
      return;
    }
    this.skippedGaps += 1;
    this.offsetS += elapsedS - this.intervalS;
    this.avatar.catchUp(this.hips, CATCH_UP_RAD_S);
  }

  /** The fingers, of which those that are not tracked stay as they were last. */
  private knownFingers(fingers: Float64Array | null): Float64Array | null {
    const { given } = this;
    if (given === null) return null;
    for (let at = 0; at < given.length; at++) {
      const value = fingers === null ? Number.NaN : (fingers[at] as number);
      if (Number.isFinite(value)) given[at] = value;
      else if (!this.hasBegun) given[at] = at % 4 === 0 ? 1 : 0;
    }
    return given;
  }
}
