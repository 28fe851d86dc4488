/** The box of a model from `POST /api/avatars/model`: it hovers out of the way until it is dropped. */

import type { Contacts } from "@shared/avatar/physics/contacts";
import { SimulationError } from "@shared/avatar/physics/modelTable";
import type { Views } from "@shared/avatar/physics/views";
import type { Vector } from "./commands";

export const BOX = "box";
const SCENE_BIT = 1;
/** By how much a box is raised at a time until nothing is where it begins, and how often at most. */
const RAISE_M = 0.05;
const MOST_RAISES = 60;

export class LooseBox {
  readonly body: number;
  private readonly geom: number;
  private readonly qposAt: number;
  private readonly qvelAt: number;

  /** Throws SimulationError if the model has no box. */
  constructor(
    private readonly views: Views,
    private readonly contacts: Contacts,
  ) {
    const { mujoco, model } = views;
    const { mjOBJ_BODY, mjOBJ_GEOM, mjOBJ_JOINT } = mujoco.mjtObj;
    const row = (kind: { value: number }) => mujoco.mj_name2id(model, kind.value, BOX);
    this.body = row(mjOBJ_BODY);
    this.geom = row(mjOBJ_GEOM);
    const joint = row(mjOBJ_JOINT);
    if (this.body < 0 || this.geom < 0 || joint < 0) {
      throw new SimulationError("The model has no box to drop: ask for one with the model.");
    }
    this.qposAt = (model.jnt_qposadr as Int32Array)[joint] as number;
    this.qvelAt = (model.jnt_dofadr as Int32Array)[joint] as number;
    this.park();
  }

  /** Make it weightless and touch nothing. */
  park(): void {
    this.setWeight(1, 0);
  }

  /**
   * Let it fall from a place, upright and at rest, or from as far above as nothing is in its way:
   * a box that began inside the body would be shot out of it.
   */
  drop(centerM: Vector): void {
    this.setWeight(0, SCENE_BIT);
    const { qpos, qvel } = this.views;
    qpos.set([...centerM, 1, 0, 0, 0], this.qposAt);
    qvel.fill(0, this.qvelAt, this.qvelAt + 6);
    for (let raises = 0; raises < MOST_RAISES && this.overlaps(); raises++) {
      qpos[this.qposAt + 1] = (qpos[this.qposAt + 1] as number) + RAISE_M;
    }
  }

  private overlaps(): boolean {
    const { mujoco, model, data } = this.views;
    mujoco.mj_kinematics(model, data);
    mujoco.mj_collision(model, data);
    this.views.renewed();
    this.contacts.read();
    for (let one = 0; one < this.contacts.count; one++) {
      const isOurs =
        this.contacts.geom(one, 0) === this.geom || this.contacts.geom(one, 1) === this.geom;
      if (isOurs && this.contacts.distanceM(one) < 0) return true;
    }
    return false;
  }

  private setWeight(gravcomp: number, mask: number): void {
    const views = this.views.renewed();
    const { geomContype, geomConaffinity, bodyContype, bodyConaffinity, bodyGravcomp } = views;
    bodyGravcomp[this.body] = gravcomp;
    geomContype[this.geom] = mask;
    geomConaffinity[this.geom] = mask;
    bodyContype[this.body] = mask;
    bodyConaffinity[this.body] = mask;
  }
}
