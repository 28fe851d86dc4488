/** The local rotations of a body whose axes have given angles: the server's `joint_rotations`. */
import { AXES, FINGER_PARTS, JOINTS } from "@shared/avatar/anatomy.generated";
import { multiplyRows } from "@shared/avatar/physics/numbers";

const FINGERS_AT = 4 * JOINTS.length;
/** Numbers of the rotations of 22 joints, then 30 finger parts. */
export const TURN_VALUES = FINGERS_AT + 4 * FINGER_PARTS.length;

const ROWS = new Map<string, number>(
  [...JOINTS, ...FINGER_PARTS].map((part, row) => [part, 4 * row]),
);
const HINGES = AXES.map(({ part, direction }) => ({ at: ROWS.get(part) as number, direction }));
const turn = new Float64Array(4);

/** Write the rotations: each part's is the product of its axes' in their order; others are none. */
export function writeTurns(anglesRad: ArrayLike<number>, into: Float64Array): void {
  into.fill(0);
  for (let at = 0; at < TURN_VALUES; at += 4) into[at] = 1;
  for (let axis = 0; axis < HINGES.length; axis++) {
    const angle = anglesRad[axis] as number;
    if (angle === 0) continue;
    const { at, direction } = HINGES[axis] as (typeof HINGES)[number];
    turn[0] = Math.cos(angle / 2);
    for (let i = 0; i < 3; i++) turn[i + 1] = Math.sin(angle / 2) * (direction[i] as number);
    multiplyRows(into, at, turn, 0, into, at);
  }
}
