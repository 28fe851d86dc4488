/**
 * Estimate the hips when no tracker reports them: from the triangle of head, knees and hips.
 *
 * The server's `app/science/avatar/ik/hips.py` explains the geometry; this is the same, operation
 * by
 * operation.
 */
import {
  cross,
  dot,
  fromAxes,
  length,
  minus,
  plus,
  type Quaternion,
  rotate,
  times,
  type Vector,
} from "../rotations";

const RIGHT: Vector = [1, 0, 0];
const UP: Vector = [0, 1, 0];
const BACK: Vector = [0, 0, 1];
const TINY = 1e-9;

/** Lengths of one body in the T-pose. */
export interface Trunk {
  readonly hipsToHeadM: number;
  /** How far the hip sockets are below the hips' joint. */
  readonly hipsToSocketsM: number;
  readonly halfBreadthM: number;
  readonly thighM: number;
}

/** The position of a part's joint in the world, and the rotation world_from_part. */
export interface Place {
  readonly positionM: Vector;
  readonly rotation: Quaternion;
}

/** Estimate the hips from the head and both shins, or from the head alone. */
export function estimatedHips(
  trunk: Trunk,
  head: Place,
  shins: readonly [Place, Place] | null,
): Place {
  const right = levelRight(head, shins ?? []);
  if (shins === null) {
    const positionM = minus(head.positionM, times(UP, trunk.hipsToHeadM));
    return { positionM, rotation: fromAxes(right, UP, cross(right, UP)) };
  }
  const positionM = triangle(trunk, head.positionM, shins, right);
  const up = unit(minus(head.positionM, positionM), UP);
  const back = unit(cross(right, up), BACK);
  return { positionM, rotation: fromAxes(cross(up, back), up, back) };
}

function levelRight(head: Place, shins: readonly Place[]): Vector {
  let [x, , z] = rotate(head.rotation, RIGHT);
  for (const shin of shins) {
    const more = rotate(shin.rotation, RIGHT);
    x += more[0];
    z += more[2];
  }
  return unit([x, 0, z], RIGHT);
}

function triangle(
  trunk: Trunk,
  headM: Vector,
  [left, right]: readonly [Place, Place],
  rightwards: Vector,
): Vector {
  const knees = times(plus(left.positionM, right.positionM), 0.5);
  const half = times(minus(right.positionM, left.positionM), 0.5);
  const sideways = minus(half, times(rightwards, trunk.halfBreadthM));
  const thighs = Math.sqrt(Math.max(trunk.thighM * trunk.thighM - dot(sideways, sideways), 0));
  const below = thighs + trunk.hipsToSocketsM;
  const above = trunk.hipsToHeadM;
  const line = minus(headM, knees);
  const distance = length(line);
  const up = unit(line, UP);
  if (distance >= above + below || distance < TINY) {
    return minus(headM, times(up, (distance * above) / (above + below)));
  }
  const down = (above * above - below * below + distance * distance) / (2 * distance);
  const behind = Math.sqrt(Math.max(above * above - down * down, 0));
  const back = unit(cross(rightwards, up), BACK);
  return plus(minus(headM, times(up, down)), times(back, behind));
}

function unit(v: Vector, otherwise: Vector): Vector {
  const size = length(v);
  return size > TINY ? times(v, 1 / size) : otherwise;
}
