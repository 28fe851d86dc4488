/**
 * Computes both bodies of a participant on one thread: in the page or in a worker.
 *
 * The local body is posed by inverse kinematics; the one that is worn follows it. All bodies of a
 * session are made at once, so that putting one on takes no time.
 */
import type { MjModel } from "@mujoco/mujoco";
import type { Goals } from "@shared/avatar/goals";
import { type Mujoco, modelFrom } from "@shared/avatar/mujoco";
import { SimulationError } from "@shared/avatar/physics/modelTable";
import type { AvatarOrder } from "../telemetry/wire/fromServer";
import { DelayedCopy } from "./delayedCopy";
import { FollowedBody } from "./followedBody";
import { OwnBody, skeletonModel } from "./ownBody";
import { partsOf } from "./parts";
import type { RemoteBody } from "./remoteBody";
import type { AvatarAnswer, BodiesSetup } from "./setup";

/** Whoever wants to know what became of a change. */
export interface Asker {
  onHeld(heldRad: Readonly<Record<string, number>>): void;
  onProblem(problem: string): void;
}

export class BodiesEngine {
  readonly own: OwnBody;
  /** Time that parts of the last frame took, ms. */
  ikMs = 0;
  remoteMs = 0;
  worn: RemoteBody;
  private readonly ownModel: MjModel;
  private readonly remotes: ReadonlyMap<string | null, RemoteBody>;
  private latencyS = 0;
  private surfaces: readonly string[] = [];
  private order: AvatarOrder | null = null;
  private asker: Asker | null = null;
  private isOrderDue = false;

  constructor(mujoco: Mujoco, setup: BodiesSetup) {
    this.ownModel =
      setup.avatar === "physics"
        ? modelFrom(mujoco, setup.bodies[0].mjcf)
        : skeletonModel(mujoco, setup.statureM, setup.segmentsM);
    this.own = new OwnBody(mujoco, this.ownModel);
    this.remotes = remotesOf(mujoco, setup);
    this.worn = this.remotes.get(null) as RemoteBody;
  }

  get skippedGaps(): number {
    let total = 0;
    for (const remote of this.remotes.values()) total += remote.skippedGaps;
    return total;
  }

  wear(body: string | null): void {
    const next = this.remotes.get(body);
    if (next === undefined) {
      throw new SimulationError(`The body ${body} was not prepared before it is worn.`);
    }
    if (next === this.worn) return;
    next.putOn();
    next.setLatency(this.latencyS);
    next.showSurfaces(this.surfaces);
    this.worn = next;
    // Changes in force apply to this body, too, once it has taken the participant's pose.
    this.isOrderDue = this.order !== null;
  }

  setLatency(latencyS: number): void {
    this.latencyS = latencyS;
    this.worn.setLatency(latencyS);
  }

  showSurfaces(keys: readonly string[]): void {
    this.surfaces = keys;
    this.worn.showSurfaces(keys);
  }

  /**
   * Apply an order as soon as the body has taken the participant's pose; then tell the asker.
   *
   * Not a promise: a worker that waits for frames in `Atomics.wait` settles none.
   */
  change(order: AvatarOrder, asker: Asker): void {
    this.asker?.onProblem("A newer change has replaced this one.");
    this.asker = asker;
    this.order = order;
    this.isOrderDue = true;
    if (this.worn.hasMoved) this.applyOrder();
  }

  /** Compute one frame. */
  frame(timeS: number, goals: Goals, fingers: Float64Array | null): void {
    const begin = performance.now();
    this.own.follow(goals);
    const solved = performance.now();
    this.worn.frame(timeS, this.own.pose, fingers);
    this.ikMs = solved - begin;
    this.remoteMs = performance.now() - solved;
    if (this.isOrderDue) this.applyOrder();
  }

  dispose(): void {
    this.asker?.onProblem("The bodies were taken away before the change.");
    this.asker = null;
    for (const remote of this.remotes.values()) remote.dispose();
    this.own.dispose();
    this.ownModel.delete();
  }

  private applyOrder(): void {
    const { asker, order } = this;
    this.asker = null;
    this.isOrderDue = false;
    if (order === null) return;
    try {
      const heldRad = this.worn.change(order);
      asker?.onHeld(heldRad);
    } catch (error) {
      // Without an asker the order was reported before, with another body.
      if (!(error instanceof SimulationError)) throw error;
      asker?.onProblem(error.message);
    }
  }
}

function remotesOf(mujoco: Mujoco, setup: BodiesSetup): ReadonlyMap<string | null, RemoteBody> {
  if (setup.avatar === "delayed_copy") {
    const { statureM, withFingers, surfaces, segmentsM } = setup;
    return new Map([[null, new DelayedCopy(statureM, withFingers, surfaces, segmentsM)]]);
  }
  const [own] = setup.bodies;
  const parts = partsOf(setup);
  const made = (answer: AvatarAnswer) => {
    const scale = answer.standing_hips_m / own.standing_hips_m;
    return new FollowedBody(mujoco, answer, scale, setup.withFingers, parts);
  };
  return new Map(setup.bodies.map((answer) => [answer.body ?? null, made(answer)]));
}
