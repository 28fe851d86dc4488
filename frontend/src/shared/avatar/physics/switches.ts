/**
 * Change a running avatar: gravity, collisions, latency, casts, gains, boxes. The server's
 * `app/science/avatar/simulation/switches.py`.
 */
import { LAYERS, PARTS } from "../anatomy.generated";
import { type ModelTable, SimulationError } from "./modelTable";
import { clamp } from "./numbers";
import {
  type ColliderKind,
  DEFAULT_LAYERS,
  layerPair,
  type Motor,
  type RunningSettings,
} from "./settings";
import type { Views } from "./views";

const GRAVITY = -9.81;
/** Speed at which a cast moves an axis to the angle at which it holds it. */
const CAST_SPEED_RAD_S = 1.5;
const ROUNDING_RAD = 1e-9;
const NO_TORQUE_NM = 1e-9;
const SCENE_BIT = 1;
const FLOOR = "floor";
const LAYER_OF = new Map<string, string>(PARTS.map(({ name, layer }) => [name, layer]));

export class Switches {
  /** The current limits of every hinge, low and high. */
  readonly rangesRad: Float64Array;
  readonly longestDelayS: number;
  private readonly limits: Float64Array;
  /** The delays of the configuration, by which some motors lag behind the others. */
  private readonly ownDelaysS: Float64Array;
  private readonly held = new Map<string, number>();
  private readonly goals = new Map<string, number>();
  private readonly kinds = new Map<string, ColliderKind>();
  private readonly geomsOf = new Map<string, readonly number[]>();
  private layers: ReadonlySet<string> = DEFAULT_LAYERS;
  private selfCollision: boolean;

  constructor(
    private readonly views: Views,
    private readonly table: ModelTable,
  ) {
    this.limits = new Float64Array(2 * table.names.length);
    table.joints.forEach((joint, row) => {
      this.limits.set(views.jntRange.subarray(2 * joint, 2 * joint + 2), 2 * row);
    });
    this.rangesRad = this.limits.slice();
    const bodyGeoms = [...table.partOfGeom.keys()].filter(
      (geom) => table.partOfGeom[geom] !== null,
    );
    this.selfCollision = bodyGeoms.some((geom) => (views.geomContype[geom] as number) > SCENE_BIT);
    for (const part of table.bodies.keys()) {
      this.geomsOf.set(
        part,
        bodyGeoms.filter((geom) => table.partOfGeom[geom] === part),
      );
      this.kinds.set(part, this.builtKind(part));
    }
    this.ownDelaysS = views.actuatorDelay.slice();
    const history: Int32Array = views.model.actuator_history;
    const spareS = table.motors.reduce((least, row) => {
      const samples = Math.max((history[2 * row] as number) - 1, 0);
      return Math.min(least, samples * views.timestepS - (this.ownDelaysS[row] as number));
    }, Infinity);
    this.longestDelayS = spareS === Infinity ? 0 : Math.max(Math.round(1e9 * spareS) / 1e9, 0);
  }

  /** The angle of each held axis: where it is held, or to where its cast moves it. */
  get heldRad(): Record<string, number> {
    return Object.fromEntries([...this.held, ...this.goals]);
  }

  /** Bring the model to these settings; those of parts and axes that it lacks have no effect. */
  apply(settings: RunningSettings): void {
    this.views.renewed();
    this.setGravity(settings.gravity);
    this.selfCollision = settings.selfCollision;
    this.layers = settings.layers;
    for (const part of this.table.bodies.keys()) {
      const kind = settings.colliders.get(part) ?? (this.kinds.get(part) as ColliderKind);
      this.kinds.set(part, kind === "mesh" && !this.hasPiece(part) ? "simple" : kind);
      this.setMasks(part);
    }
    for (const [row, name] of this.table.names.entries()) {
      const motor = settings.motors.get(name);
      if (motor !== undefined) this.setMotor(row, motor);
    }
    const hinges = [...settings.heldRad].filter(([name]) => this.table.names.includes(name));
    const stay = new Set(hinges.map(([name]) => name));
    for (const name of [...this.held.keys()]) {
      if (stay.has(name)) continue;
      this.held.delete(name);
      this.goals.delete(name);
    }
    for (const [name, angle] of hinges) {
      if (angle !== null) this.holdAt(name, angle);
      else if (!this.held.has(name)) this.hold(name);
    }
    this.setRanges();
  }

  /** Add this latency to all motors from now on; zero bypasses the buffer. */
  setDelay(delayS: number): void {
    if (!(delayS >= 0 && delayS <= this.longestDelayS)) {
      throw new SimulationError(
        `A delay of ${delayS} s is not possible: this model can add 0 to ${this.longestDelayS} s.`,
      );
    }
    this.views.renewed().actuatorDelay.set(this.ownDelaysS.map((ownS) => ownS + delayS));
  }

  /** Move casts that are not yet at their angle; called for every frame. */
  moveCasts(elapsedS: number): void {
    if (this.goals.size === 0) return;
    const wayRad = CAST_SPEED_RAD_S * elapsedS;
    for (const [name, goal] of this.goals) {
      const held = this.held.get(name) as number;
      const left = goal - held;
      if (Math.abs(left) <= wayRad) {
        this.held.set(name, goal);
        this.goals.delete(name);
      } else this.held.set(name, held + (left > 0 ? wayRad : -wayRad));
    }
    this.setRanges();
  }

  setGravity(isOn: boolean): void {
    const { gravity } = this.views.renewed();
    gravity.fill(0);
    gravity[1] = isOn ? GRAVITY : 0;
  }

  private setMotor(row: number, { kp, kd, maxTorqueNm }: Motor): void {
    const { actuatorBiasprm, actuatorForcerange } = this.views;
    const motor = this.table.motors[row] as number;
    const biasAt = motor * BIAS_VALUES;
    // The parameters of a `pid` actuator without an integral: 0, -kp, -kd.
    actuatorBiasprm[biasAt + 1] = -kp;
    actuatorBiasprm[biasAt + 2] = -kd;
    const torque = Math.max(maxTorqueNm, NO_TORQUE_NM);
    actuatorForcerange[2 * motor] = -torque;
    actuatorForcerange[2 * motor + 1] = torque;
  }

  /** Hold an axis where it is. */
  private hold(name: string): void {
    const row = this.table.names.indexOf(name);
    const angle = this.views.qpos[this.table.angles[row] as number] as number;
    // A body that is pushed against a limit is a little beyond it.
    this.held.set(name, clamp(angle, ...this.limitsOf(row)));
    this.goals.delete(name);
  }

  /** Hold an axis at an angle, to which `moveCasts` moves it. */
  private holdAt(name: string, angleRad: number): void {
    const [low, high] = this.limitsOf(this.table.names.indexOf(name));
    if (!(angleRad >= low - ROUNDING_RAD && angleRad <= high + ROUNDING_RAD)) {
      throw new SimulationError(
        `${name} cannot be held at ${angleRad} rad: give ${low} to ${high} rad.`,
      );
    }
    if (!this.held.has(name)) this.hold(name);
    this.goals.set(name, clamp(angleRad, low, high));
  }

  private limitsOf(row: number): [number, number] {
    return [this.limits[2 * row] as number, this.limits[2 * row + 1] as number];
  }

  private setRanges(): void {
    this.rangesRad.set(this.limits);
    for (const [name, angle] of this.held) {
      const row = this.table.names.indexOf(name);
      this.rangesRad[2 * row] = angle;
      this.rangesRad[2 * row + 1] = angle;
    }
    const { jntRange } = this.views;
    this.table.joints.forEach((joint, row) => {
      jntRange[2 * joint] = this.rangesRad[2 * row] as number;
      jntRange[2 * joint + 1] = this.rangesRad[2 * row + 1] as number;
    });
  }

  private shapesOf(part: string, kind: ColliderKind): readonly number[] {
    if (kind === "none") return [];
    const geoms = this.geomsOf.get(part) ?? [];
    return geoms.filter((geom) => this.table.isPiece[geom] === (kind === "mesh"));
  }

  private hasPiece = (part: string): boolean => this.shapesOf(part, "mesh").length > 0;

  /** The kind of collider of a part that the model was built with. */
  private builtKind(part: string): ColliderKind {
    const isSolid = (geom: number) => this.views.geomContype[geom] !== 0;
    const kinds: readonly ColliderKind[] = ["simple", "mesh"];
    return kinds.find((kind) => this.shapesOf(part, kind).some(isSolid)) ?? "none";
  }

  private setMasks(part: string): void {
    const kind = this.kinds.get(part) as ColliderKind;
    const { contype, conaffinity } =
      kind === "none"
        ? { contype: 0, conaffinity: 0 }
        : collisionBits(part, this.selfCollision, this.layers);
    const { geomContype, geomConaffinity, bodyContype, bodyConaffinity } = this.views;
    for (const geom of this.geomsOf.get(part) ?? []) {
      geomContype[geom] = 0;
      geomConaffinity[geom] = 0;
    }
    for (const geom of this.shapesOf(part, kind)) {
      geomContype[geom] = contype;
      geomConaffinity[geom] = conaffinity;
    }
    // MuJoCo compares the masks of bodies before those of their shapes.
    const body = this.table.bodies.get(part) as number;
    bodyContype[body] = contype;
    bodyConaffinity[body] = conaffinity;
  }
}

/** `mjNBIAS` of MuJoCo 3.14. */
const BIAS_VALUES = 10;

/** MuJoCo's two collision masks of a part's shapes: the server's `layers.collision_bits`. */
function collisionBits(part: string, selfCollision: boolean, layers: ReadonlySet<string>) {
  const own = LAYER_OF.get(part) as string;
  if (!selfCollision) return { contype: SCENE_BIT, conaffinity: 0 };
  const partners = LAYERS.filter((other) => layers.has(layerPair(own, other)));
  return {
    contype: SCENE_BIT | bitOf(own),
    conaffinity: partners.reduce((bits, other) => bits | bitOf(other), 0),
  };
}

const bitOf = (layer: string): number =>
  SCENE_BIT << (1 + (LAYERS as readonly string[]).indexOf(layer));

/** The boxes of one model's scene; all of them are shown at first. */
export class Boxes {
  readonly geoms: ReadonlyMap<string, number>;
  private readonly masks: ReadonlyMap<number, readonly [number, number]>;

  constructor(
    private readonly views: Views,
    table: ModelTable,
    private readonly soften: () => void,
  ) {
    this.geoms = new Map([...table.sceneGeoms].filter(([name]) => name !== FLOOR));
    const { geomContype, geomConaffinity } = views;
    this.masks = new Map(
      [...this.geoms.values()].map((geom) => [
        geom,
        [geomContype[geom] as number, geomConaffinity[geom] as number],
      ]),
    );
  }

  /** Whether a box can be touched while it is shown; a mark on the floor cannot. */
  isSolid(name: string): boolean {
    const masks = this.masks.get(this.geoms.get(name) ?? -1);
    return masks !== undefined && (masks[0] !== 0 || masks[1] !== 0);
  }

  /** Show only the named boxes. */
  show(names: readonly string[]): void {
    const unknown = names.find((name) => !this.geoms.has(name));
    if (unknown !== undefined) {
      const valid = [...this.geoms.keys()].join(", ") || "none";
      throw new SimulationError(`The scene has no ${unknown}: name one of ${valid}.`);
    }
    const { geomContype, geomConaffinity } = this.views.renewed();
    for (const [name, geom] of this.geoms) {
      const [contype, conaffinity] = names.includes(name)
        ? (this.masks.get(geom) as readonly [number, number])
        : [0, 0];
      geomContype[geom] = contype;
      geomConaffinity[geom] = conaffinity;
    }
    this.soften();
  }
}
