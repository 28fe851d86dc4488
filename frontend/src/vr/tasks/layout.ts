/**
 * The objects of a task, boxes, target and start square, as axis-aligned surfaces: the server's
 * `app/science/tasks/layout.py`, operation by operation.
 *
 * Each box has a *panel* to touch and *sides* to avoid. Hand boxes open towards the participant (+z)
 * and have their panel at the far end; foot boxes open at the top and have their panel on the floor.
 * World frame: +x right, +y up, the participant faces -z, origin on the floor at the centre of the
 * start square; metres. The server has checked that what a study says can be built.
 */
import type { Vector } from "@shared/rotations";

export type Limb = "hand" | "foot";
/** The participant's left (-x) or right (+x). */
export type Laterality = "left" | "right";
export type SurfaceKind = "panel" | "side" | "target" | "start";
/** A wall of a box, as seen by the participant; the rim bars around a hand box's opening are one. */
export type Side = "left" | "right" | "top" | "bottom" | "front_rim" | "front" | "back";
/** The direction of the first order; `by_hand`: right-handed people go from right to left. */
export type Direction = "by_hand" | "left_to_right" | "right_to_left";

/** A box by the space inside its walls; `number` is its position, 1..n from left to right. */
export interface BoxSpec {
  readonly number: number;
  readonly centerM: Vector;
  readonly innerSizeM: Vector;
}

/** A solid block: the hand's target cube, the foot's target bar or the start square. */
export interface BlockSpec {
  readonly centerM: Vector;
  readonly sizeM: Vector;
}

export interface LayoutSpec {
  readonly limb: Limb;
  readonly boxes: readonly BoxSpec[];
  readonly target: BlockSpec;
  readonly startSquare: BlockSpec | null;
  readonly wallThicknessM: number;
  readonly panelThicknessM: number;
  readonly sides: readonly Side[];
  /** The foot that counts in a foot task; null: either. */
  readonly countingFoot: Laterality | null;
  readonly direction: Direction;
  /** Whether the order is reversed after each completion. */
  readonly reverseAfterTask: boolean;
}

/** One axis-aligned block that a body part can touch. */
export interface Surface {
  /** "hand/2/panel", "hand/2/left", "hand/2/front_rim/top", "hand/target", "foot/start". */
  readonly key: string;
  readonly kind: SurfaceKind;
  /** The number of its box; null for target and start square. */
  readonly box: number | null;
  /** For kind `side` only. */
  readonly side: Side | null;
  readonly centerM: Vector;
  readonly halfSizeM: Vector;
  /** What turns red and is timed as one: the key, or "hand/2/front_rim" for its bars. */
  readonly unit: string;
}

export class TaskLayout {
  readonly limb: Limb;
  readonly byKey: ReadonlyMap<string, Surface>;
  readonly boxCount: number;
  readonly reverseAfterTask: boolean;
  readonly countingFoot: Laterality | null;
  readonly direction: Direction;
  /** The target that completes a task. */
  readonly targetKey: string;
  /** The start square; null if there is no walk back (hand tasks). */
  readonly startKey: string | null;

  constructor(
    spec: LayoutSpec,
    /** Box by box (panel, sides), then target, then start square. */
    readonly surfaces: readonly Surface[],
  ) {
    this.limb = spec.limb;
    this.reverseAfterTask = spec.reverseAfterTask;
    this.countingFoot = spec.countingFoot;
    this.direction = spec.direction;
    this.byKey = new Map(surfaces.map((surface) => [surface.key, surface]));
    this.boxCount = surfaces.filter(({ kind }) => kind === "panel").length;
    this.targetKey = `${spec.limb}/target`;
    this.startKey = this.byKey.has(`${spec.limb}/start`) ? `${spec.limb}/start` : null;
  }

  panelKey(box: number): string {
    return `${this.limb}/${box}/panel`;
  }
}

type Wall = readonly [Side, 0 | 1 | 2, 1 | -1];
/** The walls of a limb's boxes, as side, world axis and sign, and their axis of depth. */
const FRAMES: Readonly<Record<Limb, { readonly walls: readonly Wall[]; readonly depth: 1 | 2 }>> = {
  hand: {
    walls: [
      ["left", 0, -1],
      ["right", 0, 1],
      ["top", 1, 1],
      ["bottom", 1, -1],
    ],
    depth: 2,
  },
  foot: {
    walls: [
      ["left", 0, -1],
      ["right", 0, 1],
      ["front", 2, 1],
      ["back", 2, -1],
    ],
    depth: 1,
  },
};

/** The surfaces of a task; walls and panel lie outside the cavity and do not overlap. */
export function buildLayout(spec: LayoutSpec): TaskLayout {
  const surfaces = spec.boxes.flatMap((box) => boxSurfaces(spec, box));
  surfaces.push(block(`${spec.limb}/target`, "target", spec.target));
  if (spec.startSquare !== null) {
    surfaces.push(block(`${spec.limb}/start`, "start", spec.startSquare));
  }
  return new TaskLayout(spec, surfaces);
}

function block(key: string, kind: SurfaceKind, { centerM, sizeM }: BlockSpec): Surface {
  const [x, y, z] = sizeM;
  return { key, kind, box: null, side: null, centerM, halfSizeM: [x / 2, y / 2, z / 2], unit: key };
}

function boxSurfaces(spec: LayoutSpec, box: BoxSpec): Surface[] {
  const { limb, wallThicknessM, panelThicknessM, sides } = spec;
  const { walls: all, depth } = FRAMES[limb];
  const name = `${limb}/${box.number}`;
  const low = mapped(box.centerM, box.innerSizeM, (c, s) => c - s / 2);
  const high = mapped(box.centerM, box.innerSizeM, (c, s) => c + s / 2);
  const walls = all.filter(([side]) => sides.includes(side));
  const back = low[depth] - panelThicknessM;
  const panel = surface(
    { key: `${name}/panel`, kind: "panel", box: box.number, side: null, unit: `${name}/panel` },
    withValue(low, depth, back),
    withValue(high, depth, low[depth]),
  );
  const rimM = sides.includes("front_rim") ? wallThicknessM : 0;
  const edge = high[depth] - rimM;
  const around = walls.flatMap((wall) => {
    const [side] = wall;
    const [wallLow, wallHigh] = wallCorners(wall, walls, low, high, wallThicknessM);
    const key = `${name}/${side}`;
    const one = surface(
      { key, kind: "side", box: box.number, side, unit: key },
      withValue(wallLow, depth, back),
      withValue(wallHigh, depth, edge),
    );
    if (rimM === 0) return [one];
    const rim = `${name}/front_rim`;
    const bar = surface(
      { key: `${rim}/${side}`, kind: "side", box: box.number, side: "front_rim", unit: rim },
      withValue(wallLow, depth, edge),
      wallHigh,
    );
    return [one, bar];
  });
  return [panel, ...around];
}

/** The corners of a wall; left and right walls also cover the ends of the others. */
function wallCorners(
  [, axis, sign]: Wall,
  walls: readonly Wall[],
  low: Vector,
  high: Vector,
  wallM: number,
): readonly [Vector, Vector] {
  let wallLow = withValue(low, axis, sign < 0 ? low[axis] - wallM : high[axis]);
  let wallHigh = withValue(high, axis, sign < 0 ? low[axis] : high[axis] + wallM);
  if (axis !== 0) return [wallLow, wallHigh];
  for (const [, across, direction] of walls) {
    if (across === 0) continue;
    if (direction < 0) wallLow = withValue(wallLow, across, wallLow[across] - wallM);
    else wallHigh = withValue(wallHigh, across, wallHigh[across] + wallM);
  }
  return [wallLow, wallHigh];
}

function surface(
  words: Pick<Surface, "key" | "kind" | "box" | "side" | "unit">,
  low: Vector,
  high: Vector,
): Surface {
  return {
    ...words,
    centerM: mapped(low, high, (a, b) => (a + b) / 2),
    halfSizeM: mapped(low, high, (a, b) => (b - a) / 2),
  };
}

const mapped = (a: Vector, b: Vector, value: (a: number, b: number) => number): Vector => [
  value(a[0], b[0]),
  value(a[1], b[1]),
  value(a[2], b[2]),
];

function withValue([x, y, z]: Vector, axis: 0 | 1 | 2, value: number): Vector {
  return [axis === 0 ? value : x, axis === 1 ? value : y, axis === 2 ? value : z];
}
