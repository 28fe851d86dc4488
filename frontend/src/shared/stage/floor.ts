/** The extent of the floor and its division into squares, so that lengths can be read from it. */
import type { Block, Figure } from "./figure";
import { type Box, boxOf } from "./motion";
import type { Worn } from "./skin/worn";

export interface FloorPlan {
  readonly min: readonly [x: number, z: number];
  readonly max: readonly [x: number, z: number];
  /** Distance between two lines, metres: a power of ten. */
  readonly step: number;
  /** The bounding box of what moves on it, extended to the floor. */
  readonly box: Box;
}

const MAX_CELLS = 40;
const MARGIN_CELLS = 0.25;

export function floorPlan(figures: readonly Figure[], blocks: readonly Block[] = []): FloorPlan {
  const all = boxOfAll(figures, blocks);
  const box = figures.some(({ motion }) => motion.names.length > 2) ? all : atLeastOneMetre(all);
  const span = Math.max(...box.max.map((value, axis) => value - (box.min[axis] ?? 0)));
  const step = stepFor(span);
  const low = (value: number) => Math.floor(value / step - MARGIN_CELLS) * step;
  const high = (value: number) => Math.ceil(value / step + MARGIN_CELLS) * step;
  return {
    min: [low(box.min[0]), low(box.min[2])],
    max: [high(box.max[0]), high(box.max[2])],
    step,
    box,
  };
}

/** Whole metres for what fits into a room; multiples of ten for what does not. */
export function stepFor(span: number): number {
  if (!(span > 0)) return 1;
  if (span >= MAX_CELLS) return 10 ** Math.floor(Math.log10(span / 4));
  return span >= 1 ? 1 : 10 ** Math.max(-4, Math.floor(Math.log10(span)));
}

/**
 * Extend the box to at least a metre: one or two trackers at rest do not show how large things are.
 */
function atLeastOneMetre({ min, max }: Box): Box {
  const [[minX, maxX], [minZ, maxZ]] = ([0, 2] as const).map((axis) => {
    const more = Math.max(0, 1 - (max[axis] - min[axis])) / 2;
    return [min[axis] - more, max[axis] + more] as const;
  }) as [readonly [number, number], readonly [number, number]];
  return { min: [minX, min[1], minZ], max: [maxX, Math.max(max[1], 0.5), maxZ] };
}

const boxOfBlock = ({ center, halfSize }: Block): Box => ({
  min: [center[0] - halfSize[0], center[1] - halfSize[1], center[2] - halfSize[2]],
  max: [center[0] + halfSize[0], center[1] + halfSize[1], center[2] + halfSize[2]],
});

/** The box of a body's joints with room for its skin. */
function withSkin({ min, max }: Box, { model, statureM }: Worn): Box {
  const above = (model.aboveJointsM * statureM) / model.binding.stature_m;
  const around = SKIN_AROUND * statureM;
  return {
    min: [min[0] - around, min[1], min[2] - around],
    max: [max[0] + around, max[1] + above, max[2] + around],
  };
}

/** Half the depth of a trunk, in statures. */
const SKIN_AROUND = 0.08;

function boxOfAll(figures: readonly Figure[], blocks: readonly Block[]): Box {
  const boxes = figures.flatMap(({ motion, offset = [0, 0], worn }) => {
    const bare = boxOf(motion);
    if (bare === null) return [];
    const box = worn === undefined ? bare : withSkin(bare, worn);
    const moved = ([x, y, z]: Box["min"]): Box["min"] => [x + offset[0], y, z + offset[1]];
    return [{ min: moved(box.min), max: moved(box.max) }];
  });
  boxes.push(...blocks.map(boxOfBlock));
  if (boxes.length === 0) return { min: [-1, 0, -1], max: [1, 1.7, 1] };
  // Include the floor: a single tracker at rest has no size other than its height.
  boxes.push({ min: [Infinity, 0, Infinity], max: [-Infinity, 0, -Infinity] });
  const over = (pick: (...values: number[]) => number, side: "min" | "max"): Box["min"] => [
    pick(...boxes.map((box) => box[side][0])),
    pick(...boxes.map((box) => box[side][1])),
    pick(...boxes.map((box) => box[side][2])),
  ];
  return { min: over(Math.min, "min"), max: over(Math.max, "max") };
}
