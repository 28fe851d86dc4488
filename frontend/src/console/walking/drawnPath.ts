/**
 * A path that is being drawn, with its undo history; points are metres, rounded to the centimetre.
 */
import type { Point } from "@shared/api/walking";

export interface DrawnPath {
  readonly points: readonly Point[];
  readonly before: readonly (readonly Point[])[];
}

export type PathChange =
  | { readonly do: "add"; readonly point: Point }
  | { readonly do: "move"; readonly at: number; readonly point: Point }
  | { readonly do: "remove"; readonly at: number }
  | { readonly do: "set"; readonly points: readonly Point[] }
  | { readonly do: "undo" };

export const NO_PATH: DrawnPath = { points: [], before: [] };
const MAX_UNDO_STEPS = 100;
const MAX_POINTS = 200;

export function changedPath(path: DrawnPath, change: PathChange): DrawnPath {
  if (change.do === "undo") {
    const points = path.before.at(-1);
    return points === undefined ? path : { points, before: path.before.slice(0, -1) };
  }
  const points = pointsAfter(path.points, change);
  if (same(points, path.points)) return path;
  return { points, before: [...path.before, path.points].slice(-MAX_UNDO_STEPS) };
}

function pointsAfter(
  points: readonly Point[],
  change: Exclude<PathChange, { readonly do: "undo" }>,
): readonly Point[] {
  switch (change.do) {
    case "add":
      return points.length < MAX_POINTS ? [...points, rounded(change.point)] : points;
    case "move":
      return points.map((point, at) => (at === change.at ? rounded(change.point) : point));
    case "remove":
      return points.filter((_, at) => at !== change.at);
    case "set":
      return change.points.map(rounded);
  }
}

const cm = (value: number): number => Math.round(value * 100) / 100;
const rounded = ([x, y]: Point): Point => [cm(x), cm(y)];
const same = (a: readonly Point[], b: readonly Point[]): boolean =>
  a.length === b.length && a.every((point, at) => isSame(point, b[at]));
const isSame = (a: Point, b: Point | undefined): boolean =>
  b !== undefined && a[0] === b[0] && a[1] === b[1];

/** Whether two lines of points begin at the same point and end at the same one, to the centimetre. */
export function hasEndsOf(line: readonly Point[], points: readonly Point[]): boolean {
  const ends = (all: readonly Point[]) =>
    [all.at(0), all.at(-1)].flatMap((end) => (end ? [rounded(end)] : []));
  return points.length > 1 && line.length > 1 && same(ends(line), ends(points));
}

/** Whether the path can be queried: at least two points, no two consecutive ones the same. */
export const isCompletePath = (points: readonly Point[]): boolean =>
  points.length > 1 && points.every((point, at) => !isSame(point, points[at + 1]));
