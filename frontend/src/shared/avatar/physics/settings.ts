/**
 * An avatar's configuration as the server sends it, and the settings in force of one that runs: the
 * server's `app/science/avatar/configuration` and `app/simulated_people/avatars.ordered_settings`.
 */
import { AXES, COLLIDING, GROUPS, PARTS } from "../anatomy.generated";

export type ColliderKind = "simple" | "mesh" | "none";
export type TargetSpace = "local" | "world";

/** The part of the configuration's file (docs/avatar-configuration.md) that a running body needs. */
export interface ConfigurationFile {
  readonly gravity: boolean;
  readonly self_collision: boolean;
  readonly target_space: TargetSpace;
  readonly colliders: ColliderKind;
  readonly part_colliders: Readonly<Record<string, ColliderKind>>;
  /** The pairs of layers that differ from the standard matrix. */
  readonly layers?: readonly LayerChange[] | null;
  /** The groups that give way when pushed, and how. */
  readonly compliance?: Readonly<Record<string, ComplianceFile>> | null;
  readonly locked_groups: readonly string[];
  readonly held_deg: Readonly<Record<string, number>>;
  readonly axes: Readonly<Record<string, AxisFile>>;
}

export interface ComplianceFile {
  readonly stiffness_percent: number;
  readonly targets: "joint" | "world";
}

export interface LayerChange {
  readonly layers: readonly [string, string];
  readonly collide: boolean;
}

export interface AxisFile {
  readonly kp_nm_per_rad: number;
  readonly kd_nm_s_per_rad: number;
  readonly max_torque_nm: number;
  readonly low_deg: number;
  readonly high_deg: number;
}

export interface AxisLimits {
  readonly lowRad: number;
  readonly highRad: number;
}

export interface Motor {
  readonly kp: number;
  readonly kd: number;
  readonly maxTorqueNm: number;
}

/** All settings of a running body that can change without building its model again. */
export interface RunningSettings {
  readonly gravity: boolean;
  readonly selfCollision: boolean;
  readonly colliders: ReadonlyMap<string, ColliderKind>;
  /** The pairs of collision layers that collide, as `layerPair` names them. */
  readonly layers: ReadonlySet<string>;
  /** Held axis -> its angle; null for its angle when the cast is put on. */
  readonly heldRad: ReadonlyMap<string, number | null>;
  readonly motors: ReadonlyMap<string, Motor>;
}

/** What a running body should differ in from its configuration; null leaves a setting as it is. */
export interface ChangeOrder {
  readonly gravity: boolean | null;
  readonly self_collision: boolean | null;
  readonly colliders: Readonly<Record<string, ColliderKind>>;
  readonly layers: readonly LayerChange[];
  readonly held_rad: Readonly<Record<string, number | null>>;
  readonly motors: Readonly<
    Record<
      string,
      {
        readonly kp_nm_per_rad: number;
        readonly kd_nm_s_per_rad: number;
        readonly max_torque_nm: number;
      }
    >
  >;
}

const LIMBS = ["left_arm", "right_arm", "left_leg", "right_leg"] as const;
const RADIANS = Math.PI / 180;

/** The name of a pair of layers, whichever comes first. */
export const layerPair = (a: string, b: string): string => (a < b ? `${a} ${b}` : `${b} ${a}`);

export const DEFAULT_LAYERS: ReadonlySet<string> = new Set(
  COLLIDING.map(([a, b]) => layerPair(a, b)),
);

/** The limits of every axis with the locked groups applied: the server's `in_force`. */
export function limitsInForce(file: ConfigurationFile): ReadonlyMap<string, AxisLimits> {
  const locked = axesOfGroups(file.locked_groups);
  return new Map(
    Object.entries(file.axes).map(([name, axis]) => {
      const lowRad = axis.low_deg * RADIANS;
      const highRad = axis.high_deg * RADIANS;
      if (!locked.has(name)) return [name, { lowRad, highRad }];
      const heldRad = Math.min(Math.max((file.held_deg[name] ?? 0) * RADIANS, lowRad), highRad);
      return [name, { lowRad: heldRad, highRad: heldRad }];
    }),
  );
}

/** The settings of a body to which nothing has been changed. */
export function asConfigured(file: ConfigurationFile): RunningSettings {
  const locked = axesOfGroups(file.locked_groups);
  const free = Object.entries(file.axes).filter(
    ([name, axis]) => !locked.has(name) && axis.low_deg !== axis.high_deg,
  );
  const shares = stiffnessShares(file);
  return {
    gravity: file.gravity,
    selfCollision: file.self_collision,
    colliders: new Map(
      PARTS.map(({ name }) => [name, file.part_colliders[name] ?? file.colliders]),
    ),
    layers: changedLayers(DEFAULT_LAYERS, file.layers ?? []),
    heldRad: new Map(),
    motors: new Map(free.map(([name, axis]) => [name, softened(axis, shares.get(name) ?? 1)])),
  };
}

/** The limbs whose parts return to their own direction: the server's `compliance.world_limbs`. */
export function worldLimbs(file: ConfigurationFile): readonly string[] {
  return LIMBS.filter((limb) => file.compliance?.[limb]?.targets === "world");
}

/** The share of the configured stiffness of each axis in a group that is less stiff. */
function stiffnessShares(file: ConfigurationFile): ReadonlyMap<string, number> {
  return new Map(
    Object.entries(file.compliance ?? {}).flatMap(([group, { stiffness_percent }]) =>
      [...axesOfGroups([group])].map((axis): [string, number] => [axis, stiffness_percent / 100]),
    ),
  );
}

/** A motor with a share of its stiffness, and its damping ratio: the server's `softened`. */
function softened(axis: AxisFile, share: number): Motor {
  return {
    kp: share * axis.kp_nm_per_rad,
    kd: Math.sqrt(share) * axis.kd_nm_s_per_rad,
    maxTorqueNm: axis.max_torque_nm,
  };
}

/** What an order asks for, with the settings of the configuration otherwise. */
export function ordered(configured: RunningSettings, order: ChangeOrder): RunningSettings {
  const motors = new Map(configured.motors);
  for (const [axis, motor] of Object.entries(order.motors)) {
    if (!motors.has(axis)) continue;
    motors.set(axis, {
      kp: motor.kp_nm_per_rad,
      kd: motor.kd_nm_s_per_rad,
      maxTorqueNm: motor.max_torque_nm,
    });
  }
  return {
    gravity: order.gravity ?? configured.gravity,
    selfCollision: order.self_collision ?? configured.selfCollision,
    colliders: new Map([...configured.colliders, ...Object.entries(order.colliders)]),
    layers: changedLayers(configured.layers, order.layers),
    heldRad: new Map(Object.entries(order.held_rad)),
    motors,
  };
}

function changedLayers(
  before: ReadonlySet<string>,
  changes: readonly LayerChange[],
): ReadonlySet<string> {
  const layers = new Set(before);
  for (const { layers: pair, collide } of changes) {
    if (collide) layers.add(layerPair(...pair));
    else layers.delete(layerPair(...pair));
  }
  return layers;
}

/** The axes of body groups: `all`, `trunk`, `left_arm`, ..., and every part by its own name. */
function axesOfGroups(groups: readonly string[]): ReadonlySet<string> {
  const parts = new Set(groups.flatMap((group) => GROUPS[group] ?? [group]));
  return new Set(AXES.filter(({ part }) => parts.has(part)).map(({ name }) => name));
}
