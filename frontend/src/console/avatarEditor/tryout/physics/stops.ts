/**
 * Which directions of a push meet a stop: the joint that would give way most is at its limit, so
 * that what is seen is the stop, and nothing of the joint's stiffness.
 */
import { DIRECTIONS, type Direction } from "../pulling";
import type { Vector } from "./commands";
import { COLUMNS, type TriedBody } from "./triedBody";

export interface Stop {
  readonly axis: string;
  readonly end: "low" | "high";
}

/** For a part, what stands in the way of a push in each direction; null where it gives way. */
export interface Stops {
  readonly part: string;
  readonly by: Readonly<Record<Direction, Stop | null>>;
}

/** Nearer to its limit than this an axis has no room, radians. */
const ROOM_RAD = Math.PI / 180;
/** A force with a shorter lever turns an axis hardly at all, metres. */
const LEVER_M = 0.01;

/** Null for a part that the body lacks, or that has no hinge of its own. */
export function stopsOf({ avatar: { table, views } }: TriedBody, part: string): Stops | null {
  const body = table.bodies.get(part);
  if (body === undefined) return null;
  const rows = table.names.flatMap((axis, row) => (partOf(axis) === part ? [row] : []));
  if (rows.length === 0) return null;
  const { xipos, xanchor, xaxis, qpos, jntRange } = views.renewed();
  const at = (from: Float64Array, row: number): Vector => [
    from[3 * row] as number,
    from[3 * row + 1] as number,
    from[3 * row + 2] as number,
  ];
  const middle = at(xipos, body);
  const stopIn = (force: Vector): Stop | null => {
    let most = LEVER_M;
    let found: Stop | null = null;
    for (const row of rows) {
      const joint = table.joints[row] as number;
      const anchor = at(xanchor, joint);
      const arm: Vector = [middle[0] - anchor[0], middle[1] - anchor[1], middle[2] - anchor[2]];
      const lever = dot(at(xaxis, joint), cross(arm, force));
      if (Math.abs(lever) <= most) continue;
      most = Math.abs(lever);
      const angle = qpos[table.angles[row] as number] as number;
      const end = lever > 0 ? "high" : "low";
      const limit = jntRange[2 * joint + (lever > 0 ? 1 : 0)] as number;
      const room = lever > 0 ? limit - angle : angle - limit;
      found = room < ROOM_RAD ? { axis: table.names[row] as string, end } : null;
    }
    return found;
  };
  const by = Object.fromEntries(
    Object.entries(DIRECTIONS).map(([direction, force]) => [direction, stopIn(force)]),
  ) as Record<Direction, Stop | null>;
  return { part, by };
}

const partOf = (axis: string): string => (COLUMNS.has(axis) ? axis.slice(0, -1) : "");

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
