/**
 * Inverse kinematics by damped least squares: from tracked parts to the avatar's angles.
 *
 * The server's `app/science/avatar/ik/solver.py` has the equations. Vectors in
 * `tests/vectors/avatar`
 * check that both give the same angles for the same model and goals.
 */
import type { MjModel } from "@mujoco/mujoco";
import { length, minus, normalised, rotated, rotationBetween, type Vector } from "../rotations";
import { BoundedStep } from "./boundedStep";
import { Chain } from "./chain";
import { checkGoals, GOAL_PARTS, type Goals } from "./goals";
import { estimatedHips, type Place } from "./hips";
import { writeGram, writeTransposedTimes } from "./linear";
import type { Mujoco } from "./mujoco";

/** What was found for a frame; its arrays are used again for the next. */
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
const FAR_M = 0.5;
const FAR_RAD = Math.PI / 2;
/** Rows of the goals: the hips' own is not solved for. */
const HIPS = 0;
const LINES = 6;
const MOST_LINES = LINES * (GOAL_PARTS.length - 1);

/** The weighted equations of one step, in arrays that are made once. */
class System {
  readonly count: number;
  readonly jacobian: Float64Array;
  readonly error = new Float64Array(MOST_LINES);
  readonly damping: Float64Array;
  readonly hessian: Float64Array;
  readonly right: Float64Array;
  readonly rest: Float64Array;
  readonly low: Float64Array;
  readonly high: Float64Array;
  readonly bounded: BoundedStep;

  /** `extra`: six if the hips move, too, else none; their unknowns come first. */
  constructor(
    readonly extra: number,
    hinges: number,
  ) {
    const count = extra + hinges;
    this.count = count;
    this.jacobian = new Float64Array(MOST_LINES * count);
    this.damping = new Float64Array(count);
    this.hessian = new Float64Array(count * count);
    this.right = new Float64Array(count);
    this.rest = new Float64Array(count);
    this.low = new Float64Array(count).fill(-Infinity);
    this.high = new Float64Array(count).fill(Infinity);
    this.bounded = new BoundedStep(count);
  }
}

interface MutablePlace {
  positionM: Vector;
  rotation: Place["rotation"];
}

/** Follows one tracked body frame by frame; `delete()` frees MuJoCo's memory. */
export class InverseKinematics {
  private readonly chain: Chain;
  private readonly rest: Float64Array;
  private readonly weights: Weights;
  private readonly steps: number;
  private readonly angles: Float64Array;
  private readonly hips: MutablePlace = { positionM: [0, 0, 0], rotation: [1, 0, 0, 0] };
  private hasStarted = false;
  private readonly withHips: System;
  private readonly withoutHips: System;
  private readonly solution: Solution;
  /** The rows that have a goal in this frame, and how many they are. */
  private readonly rows = new Int32Array(GOAL_PARTS.length);
  private known = 0;
  private readonly off = new Float64Array(LINES);

  constructor(mujoco: Mujoco, model: MjModel, options: IkOptions = {}) {
    const { restRad = REST_POSE_RAD, weights = WEIGHTS, steps = 2 } = options;
    this.chain = new Chain(mujoco, model);
    this.weights = weights;
    this.steps = steps;
    this.rest = Float64Array.from(this.chain.hinges, ({ name, lowRad, highRad }) =>
      Math.min(Math.max(restRad[name] ?? 0, lowRad), highRad),
    );
    this.angles = Float64Array.from(this.rest);
    const { length: moving } = this.chain.moving;
    this.withHips = new System(ROOT_UNKNOWNS, moving);
    this.withoutHips = new System(0, moving);
    this.solution = {
      anglesRad: this.angles,
      hips: this.hips,
      positionErrorsM: new Float64Array(GOAL_PARTS.length),
      rotationErrorsRad: new Float64Array(GOAL_PARTS.length),
    };
  }

  get axisNames(): readonly string[] {
    return this.chain.hinges.map(({ name }) => name);
  }

  /** Forget the previous frame: start from the rest pose, with the hips at the origin. */
  reset(): void {
    this.angles.set(this.rest);
    this.hips.positionM = [0, 0, 0];
    this.hips.rotation = [1, 0, 0, 0];
    this.hasStarted = false;
  }

  /**
   * Solve for the pose of the next frame; the solution is valid until the next call. It allocates a
   * few vectors for the hips and nothing else, since it runs in every frame.
   */
  solve(given: Goals): Solution {
    checkGoals(given);
    const estimate = this.setHips(given);
    this.known = 0;
    for (let row = HIPS + 1; row < GOAL_PARTS.length; row++) {
      if (goalOf(given, row) !== null) this.rows[this.known++] = row;
    }
    const system = estimate === null ? this.withoutHips : this.withHips;
    for (let step = 0; step < (this.known > 0 ? this.steps : 0); step++) {
      this.step(given, estimate, system);
    }
    this.chain.place(this.hips.positionM, this.hips.rotation, this.angles);
    this.noteErrors(given);
    return this.solution;
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
      const [x, y, z] = waist.positionM;
      this.hips.positionM = [x, y, z];
      this.hips.rotation = normalised(waist.rotation);
      this.hasStarted = true;
      return null;
    }
    if (head === null) return null;
    const shins = left !== null && right !== null ? ([left, right] as const) : null;
    const estimate = estimatedHips(this.chain.trunk, head, shins);
    if (!this.hasStarted || this.isFarFrom(estimate)) {
      this.hips.positionM = estimate.positionM;
      this.hips.rotation = estimate.rotation;
    }
    this.hasStarted = true;
    return estimate;
  }

  /** Whether the body was moved elsewhere: further than any error of the estimate. */
  private isFarFrom({ positionM, rotation }: Place): boolean {
    const turn = rotationBetween(this.hips.rotation, rotation);
    return length(minus(positionM, this.hips.positionM)) > FAR_M || length(turn) > FAR_RAD;
  }

  private noteErrors(goals: Goals): void {
    const { positionErrorsM, rotationErrorsRad } = this.solution;
    const { off } = this;
    for (let row = HIPS; row < GOAL_PARTS.length; row++) {
      const goal = goalOf(goals, row);
      if (goal !== null) this.chain.writeError(row, goal, off, 0);
      positionErrorsM[row] = goal === null ? Number.NaN : lengthAt(off, 0);
      rotationErrorsRad[row] = goal === null ? Number.NaN : lengthAt(off, 3);
    }
  }

  private step(goals: Goals, estimate: Place | null, system: System): void {
    const { moving, moves, lowsRad, highsRad } = this.chain;
    const { count, extra, jacobian, error, damping, hessian, right, rest, low, high } = system;
    this.chain.place(this.hips.positionM, this.hips.rotation, this.angles);
    this.write(goals, system);
    if (estimate !== null) {
      rest.set(minus(estimate.positionM, this.hips.positionM));
      rest.set(rotationBetween(this.hips.rotation, estimate.rotation), 3);
    }
    for (let column = 0; column < moving.length; column++) {
      const index = moving[column] as number;
      const angle = this.angles[index] as number;
      let isNeeded = false;
      for (let at = 0; at < this.known; at++) {
        isNeeded ||= moves[this.rows[at] as number]?.[column] === true;
      }
      rest[extra + column] = isNeeded ? (this.rest[index] as number) - angle : 0;
      low[extra + column] = (lowsRad[index] as number) - angle;
      high[extra + column] = (highsRad[index] as number) - angle;
    }
    const pull = this.weights.rest ** 2;
    const lines = LINES * this.known;
    writeGram(jacobian, lines, count, hessian);
    writeTransposedTimes(jacobian, error, lines, count, right);
    for (let i = 0; i < count; i++) {
      const diagonal = i * count + i;
      hessian[diagonal] = (hessian[diagonal] as number) + (pull + (damping[i] as number));
      right[i] = (right[i] as number) + pull * (rest[i] as number);
    }
    this.apply(system.bounded.solve(hessian, right, low, high), extra);
  }

  private apply(step: Float64Array, extra: number): void {
    const { moving, lowsRad, highsRad } = this.chain;
    for (let column = 0; column < moving.length; column++) {
      const index = moving[column] as number;
      const angle = (this.angles[index] as number) + (step[extra + column] as number);
      const low = lowsRad[index] as number;
      const high = highsRad[index] as number;
      this.angles[index] = Math.min(Math.max(angle, low), high);
    }
    if (extra === 0) return;
    const [x, y, z] = this.hips.positionM;
    const at = (i: number) => step[i] as number;
    this.hips.positionM = [x + at(0), y + at(1), z + at(2)];
    this.hips.rotation = rotated(this.hips.rotation, [at(3), at(4), at(5)]);
  }

  /** Write the weighted equations of all goals. */
  private write(goals: Goals, { count, extra, jacobian, error, damping }: System): void {
    const { moves } = this.chain;
    jacobian.fill(0, 0, LINES * this.known * count);
    damping.fill(CALM);
    for (let index = 0; index < this.known; index++) {
      const row = this.rows[index] as number;
      const start = LINES * index * count;
      this.chain.writeError(row, goalOf(goals, row) as Place, error, LINES * index);
      this.chain.writeJacobian(row, jacobian, start + extra, count);
      if (extra > 0) this.chain.writeRigid(row, this.hips.positionM, jacobian, start, count);
      let squared = 0;
      for (let line = 0; line < LINES; line++) {
        const weight = line < 3 ? this.weights.position : this.weights.rotation;
        const weighted = weight * (error[LINES * index + line] as number);
        error[LINES * index + line] = weighted;
        squared += weighted * weighted;
        for (let at = start + line * count; at < start + (line + 1) * count; at++) {
          jacobian[at] = (jacobian[at] as number) * weight;
        }
      }
      squared *= DAMPING;
      const moved = moves[row];
      for (let i = 0; i < count; i++) {
        if (i < extra || moved?.[i - extra]) damping[i] = (damping[i] as number) + squared;
      }
    }
  }
}

const goalOf = (goals: Goals, row: number): Place | null =>
  goals[GOAL_PARTS[row] as (typeof GOAL_PARTS)[number]];

const lengthAt = (values: Float64Array, at: number): number => {
  const [x, y, z] = [values[at] as number, values[at + 1] as number, values[at + 2] as number];
  return Math.sqrt(x * x + y * y + z * z);
};
