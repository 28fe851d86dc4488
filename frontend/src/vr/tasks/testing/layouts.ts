/** The layouts of the vectors: `tests/vectors/tasks/layouts.json`. */
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import {
  type BlockSpec,
  buildLayout,
  type Laterality,
  type LayoutSpec,
  type TaskLayout,
} from "../layout";

const FILE = resolve(import.meta.dirname, "../../../../../tests/vectors/tasks/layouts.json");

type Row = readonly [number, number, number];
interface Block {
  readonly center_m: Row;
  readonly size_m: Row;
}
export interface LayoutVector extends Pick<LayoutSpec, "limb" | "sides" | "direction"> {
  readonly boxes: readonly { number: number; center_m: Row; inner_size_m: Row }[];
  readonly target: Block;
  readonly start_square: Block | null;
  readonly wall_thickness_m: number;
  readonly panel_thickness_m: number;
  readonly counting_foot: Laterality | null;
  readonly reverse_after_task: boolean;
  readonly surfaces: readonly {
    readonly key: string;
    readonly kind: string;
    readonly box: number | null;
    readonly side: string | null;
    readonly center_m: Row;
    readonly half_size_m: Row;
  }[];
}

const stored: Readonly<Record<string, LayoutVector>> = JSON.parse(
  readFileSync(FILE, "utf8"),
).layouts;

/** The vectors as they stand in the file. */
export const layoutVectors = (): readonly (readonly [string, LayoutVector])[] =>
  Object.entries(stored);

/** Every layout by its name, built. */
export const readLayouts = (): ReadonlyMap<string, TaskLayout> =>
  new Map(layoutVectors().map(([name, vector]) => [name, built(vector)]));

const blockOf = ({ center_m, size_m }: Block): BlockSpec => ({ centerM: center_m, sizeM: size_m });

function built(vector: LayoutVector): TaskLayout {
  return buildLayout({
    limb: vector.limb,
    boxes: vector.boxes.map(({ number, center_m, inner_size_m }) => ({
      number,
      centerM: center_m,
      innerSizeM: inner_size_m,
    })),
    target: blockOf(vector.target),
    startSquare: vector.start_square && blockOf(vector.start_square),
    wallThicknessM: vector.wall_thickness_m,
    panelThicknessM: vector.panel_thickness_m,
    sides: vector.sides,
    countingFoot: vector.counting_foot,
    direction: vector.direction,
    reverseAfterTask: vector.reverse_after_task,
  });
}
