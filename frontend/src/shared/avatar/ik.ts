/**
 * Inverse kinematics by damped least squares: from tracked parts to the avatar's angles.
 *
 * The server's `app/science/avatar/ik/solver.py` has the equations. Vectors in
 * `tests/vectors/avatar`
 * check that both give the same angles for the same model and goals.
 */
import type { MjModel } from "@mujoco/mujoco";
import {
  length,
  minus,
  normalised,
  plus,
  rotated,
  rotationBetween,
  type Vector,
} from "../rotations";
import { boundedStep } from "./boundedStep";
import { Chain, vectorAt } from "./chain";
import { type Goals, rowsOf } from "./goals";
import { estimatedHips, type Place } from "./hips";
import { gram, transposedTimes } from "./linear";
import type { Mujoco } from "./mujoco";

export interface Solution {
  /** The angle of every hinge, in the model's order; see `axisNames`. */
  readonly anglesRad: Float64Array;
  readonly hips: Place;
  /** In the order of `GOAL_PARTS`; NaN if a part is not tracked. */
  readonly positionErrorsM: Float64Array;
  readonly rotationErrorsRad: Float64Array;
}

export interface IkOptions {
  /** Preferred angle of each axis; axes without one rest at zero. */
  readonly restRad?: Readonly<Record<string, number>>;
  readonly weights?: Weights;
  /** Gauss-Newton steps per frame. */
  readonly steps?: number;
}

/** Weights per metre, per radian, and per radian from the rest pose. */
interface Weights {
  readonly position: number;
  readonly rotation: number;
  readonly rest: number;
}

const RADIANS = Math.PI / 180;
/** A straight limb cannot be shortened by a small rotation, so knees and elbows rest bent. */
export const REST_POSE_RAD: Readonly<Record<string, number>> = {
  LeftLowerLegX: 25 * RADIANS,
  LeftLowerArmY: 30 * RADIANS,
  RightLowerLegX: 25 * RADIANS,
  RightLowerArmY: 30 * RADIANS,
};
const WEIGHTS: Weights = { position: 10, rotation: 1, rest: 0.1 };
const CALM = 0.1;
const DAMPING = 0.5;
const ROOT_UNKNOWNS = 6;
const ORIGIN: Place = { positionM: [0, 0, 0], rotation: [1, 0, 0, 0] };
const FAR_M = 0.5;
const FAR_RAD = Math.PI / 2;

/** The weighted equations of one step. */
interface System {
  readonly jacobian: Float64Array;
  readonly error: Float64Array;
  readonly damping: Float64Array;
}

/** Follows one tracked body frame by frame; `delete()` frees MuJoCo's memory. */
export class InverseKinematics {
  private readonly chain: Chain;
  private readonly rest: Float64Array;
  private readonly weights: Weights;
  private readonly steps: number;
  private angles: Float64Array;
  private hips: Place = ORIGIN;
  private hasStarted = false;

  constructor(mujoco: Mujoco, model: MjModel, options: IkOptions = {}) {
    const { restRad = REST_POSE_RAD, weights = WEIGHTS, steps = 2 } = options;
    this.chain = new Chain(mujoco, model);
    this.weights = weights;
    this.steps = steps;
    this.rest = Float64Array.from(this.chain.hinges, ({ name, lowRad, highRad }) =>
      Math.min(Math.max(restRad[name] ?? 0, lowRad), highRad),
    );
    this.angles = Float64Array.from(this.rest);
  }

  get axisNames(): readonly string[] {
    return this.chain.hinges.map(({ name }) => name);
  }

  /** Forget the previous frame: start from the rest pose, with the hips at the origin. */
  reset(): void {
    this.angles = Float64Array.from(this.rest);
    this.hips = ORIGIN;
    this.hasStarted = false;
  }

  /** Solve for the pose of the next frame. */
  solve(given: Goals): Solution {
    const goals = rowsOf(given);
    const estimate = this.setHips(given);
    const rows = [...goals.keys()].filter((row) => row > 0 && goals[row] !== null);
    for (let step = 0; step < (rows.length > 0 ? this.steps : 0); step++) {
      this.step(goals, rows, estimate);
    }
    this.chain.place(this.hips.positionM, this.hips.rotation, this.angles);
    const errors = goals.map((goal, row) => (goal === null ? null : this.error(row, goal)));
    const sizes = (which: 0 | 1) =>
      Float64Array.from(errors, (error) => (error === null ? Number.NaN : length(error[which])));
    return {
      anglesRad: Float64Array.from(this.angles),
      hips: this.hips,
      positionErrorsM: sizes(0),
      rotationErrorsRad: sizes(1),
    };
  }

  delete(): void {
    this.chain.delete();
  }

  /**
   * Set the hips from the waist tracker; without one, return their estimated place, if possible.
   */
  private setHips(goals: Goals): Place | null {
    const { Hips: waist, Head: head, LeftLowerLeg: left, RightLowerLeg: right } = goals;
    if (waist !== null) {
      this.hips = { positionM: waist.positionM, rotation: normalised(waist.rotation) };
      this.hasStarted = true;
      return null;
    }
    if (head === null) return null;
    const shins = left !== null && right !== null ? ([left, right] as const) : null;
    const estimate = estimatedHips(this.chain.trunk, head, shins);
    if (!this.hasStarted || this.isFarFrom(estimate)) this.hips = estimate;
    this.hasStarted = true;
    return estimate;
  }

  /** Whether the body was moved elsewhere: further than any error of the estimate. */
  private isFarFrom({ positionM, rotation }: Place): boolean {
    const turn = rotationBetween(this.hips.rotation, rotation);
    return length(minus(positionM, this.hips.positionM)) > FAR_M || length(turn) > FAR_RAD;
  }

  private error(row: number, goal: Place): readonly [Vector, Vector] {
    return [
      minus(goal.positionM, this.chain.positionM(row)),
      rotationBetween(this.chain.rotation(row), goal.rotation),
    ];
  }

  private step(
    goals: readonly (Place | null)[],
    rows: readonly number[],
    estimate: Place | null,
  ): void {
    const { moving, moves, hinges } = this.chain;
    this.chain.place(this.hips.positionM, this.hips.rotation, this.angles);
    this.chain.prepareJacobians();
    const extra = estimate === null ? 0 : ROOT_UNKNOWNS;
    const count = moving.length + extra;
    const { jacobian, error, damping } = this.system(goals, rows, extra);
    const rest = new Float64Array(count);
    const low = new Float64Array(count).fill(-Infinity);
    const high = new Float64Array(count).fill(Infinity);
    if (estimate !== null) {
      rest.set(minus(estimate.positionM, this.hips.positionM));
      rest.set(rotationBetween(this.hips.rotation, estimate.rotation), 3);
    }
    moving.forEach((index, column) => {
      const angle = this.angles[index] as number;
      const hinge = hinges[index];
      const needed = rows.some((row) => moves[row]?.[column]);
      rest[extra + column] = needed ? (this.rest[index] as number) - angle : 0;
      low[extra + column] = (hinge?.lowRad ?? 0) - angle;
      high[extra + column] = (hinge?.highRad ?? 0) - angle;
    });
    const pull = this.weights.rest ** 2;
    const hessian = gram(jacobian, count);
    const right = transposedTimes(jacobian, error, count);
    for (let i = 0; i < count; i++) {
      const diagonal = i * count + i;
      hessian[diagonal] = (hessian[diagonal] as number) + (pull + (damping[i] as number));
      right[i] = (right[i] as number) + pull * (rest[i] as number);
    }
    this.apply(boundedStep(hessian, right, low, high), extra);
  }

  private apply(step: Float64Array, extra: number): void {
    const { moving, hinges } = this.chain;
    moving.forEach((index, column) => {
      const angle = (this.angles[index] as number) + (step[extra + column] as number);
      const { lowRad = 0, highRad = 0 } = hinges[index] ?? {};
      this.angles[index] = Math.min(Math.max(angle, lowRad), highRad);
    });
    if (extra === 0) return;
    const { positionM, rotation } = this.hips;
    this.hips = {
      positionM: plus(positionM, vectorAt(step, 0)),
      rotation: rotated(rotation, vectorAt(step, 3)),
    };
  }

  private system(goals: readonly (Place | null)[], rows: readonly number[], extra: number): System {
    const { moving, moves } = this.chain;
    const count = extra + moving.length;
    const jacobian = new Float64Array(6 * rows.length * count);
    const error = new Float64Array(6 * rows.length);
    const damping = new Float64Array(count).fill(CALM);
    rows.forEach((row, index) => {
      const start = 6 * index * count;
      const [off, turn] = this.error(row, goals[row] as Place);
      this.chain.writeJacobian(row, jacobian, start + extra, count);
      if (extra > 0)
        writeRigid(minus(this.chain.positionM(row), this.hips.positionM), jacobian, start, count);
      let squared = 0;
      for (let line = 0; line < 6; line++) {
        const weight = line < 3 ? this.weights.position : this.weights.rotation;
        const weighted = weight * ((line < 3 ? off[line] : turn[line - 3]) as number);
        error[6 * index + line] = weighted;
        squared += weighted * weighted;
        for (let at = start + line * count; at < start + (line + 1) * count; at++) {
          jacobian[at] = (jacobian[at] as number) * weight;
        }
      }
      squared *= DAMPING;
      for (let i = 0; i < count; i++) {
        if (i < extra || moves[row]?.[i - extra]) damping[i] = (damping[i] as number) + squared;
      }
    });
    return { jacobian, error, damping };
  }
}

/** Write how a point at `arm` from the hips moves with them. */
function writeRigid(arm: Vector, into: Float64Array, start: number, width: number): void {
  const [x, y, z] = arm;
  const crossed = [
    [0, z, -y],
    [-z, 0, x],
    [y, -x, 0],
  ];
  for (let row = 0; row < 3; row++) {
    into[start + row * width + row] = 1;
    into[start + (row + 3) * width + row + 3] = 1;
    into.set(crossed[row] as number[], start + row * width + 3);
  }
}
