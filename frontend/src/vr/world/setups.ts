/**
 * The boxes, targets and the start square of a study's tasks, as a task wants them seen. This module
 * imports three.js.
 *
 * A box has its number twice: on its panel, and where it is read without looking into the box: on a
 * plate above the opening of a hand box, on the floor in front of a foot box.
 */
import type { Colour, Limb, Surface } from "../tasks";
import type { Palette } from "./appearance";
import { type BlockPlace, Blocks } from "./blocks";
import type { Mirror } from "./mirror";
import { makeSigns, NO_SIGN, signOfCue, signOfNumber } from "./signs";

/** What has to be known of a task's layout to draw it. */
export interface Setup {
  readonly surfaces: readonly Surface[];
}

/** What a task wants seen: `currentGoal`, `surfaceColours` and `displayedNumbers` of its state. */
export interface TaskShown {
  readonly limb: Limb;
  readonly goal: string | null;
  readonly colours: ReadonlyMap<string, Colour>;
  readonly numbers: ReadonlyMap<number, number>;
}

/** One block in the scene: a surface, or the plate with a box's number. */
interface Drawn {
  readonly limb: Limb;
  readonly surface: Surface;
  readonly place: BlockPlace;
  readonly isPlate: boolean;
}

export class Setups {
  readonly #blocks: Blocks;
  readonly #signs = makeSigns();
  readonly #drawn: readonly Drawn[];
  readonly #palette: Palette;
  #visible: readonly Limb[] = [];

  constructor(layouts: ReadonlyMap<Limb, Setup>, palette: Palette, mirror: Mirror | null) {
    this.#palette = palette;
    this.#drawn = [...layouts].flatMap(([limb, { surfaces }]) =>
      surfaces.flatMap((surface) => {
        const block = { limb, surface, place: surface, isPlate: false };
        const plate = surface.kind === "panel" ? plateOf(limb, surface, surfaces) : null;
        return plate === null ? [block] : [block, { limb, surface, place: plate, isPlate: true }];
      }),
    );
    this.#blocks = new Blocks(this.#drawn.length, this.#signs, mirror);
    this.show([], null);
  }

  get mesh() {
    return this.#blocks.mesh;
  }

  /** Show the setups of these limbs; one whose task is not running looks as before its start. */
  show(visible: readonly Limb[], task: TaskShown | null): void {
    const isChanged = visible.join() !== this.#visible.join();
    for (let at = 0; at < this.#drawn.length; at++) {
      const one = this.#drawn[at];
      if (one === undefined) continue;
      if (isChanged) this.#blocks.place(at, visible.includes(one.limb) ? one.place : null);
      this.#paint(at, one, task?.limb === one.limb ? task : null);
    }
    if (isChanged) this.#visible = [...visible];
    this.mesh.visible = visible.length > 0;
  }

  dispose(): void {
    this.#blocks.dispose();
    this.#signs.dispose();
  }

  #paint(at: number, { surface, isPlate }: Drawn, task: TaskShown | null): void {
    const { colours, cues } = this.#palette;
    const { kind, key, box } = surface;
    const colour = task?.colours.get(key);
    const number = box === null ? 0 : (task?.numbers.get(box) ?? box);
    if (isPlate) {
      const isNext = task?.goal === key;
      const plate = colour === "green" ? colours.panel_done : isNext ? NEXT_PLATE : PLATE;
      this.#blocks.paint(at, plate, signOfNumber(number));
    } else if (kind === "panel") {
      const isDone = colour === "green";
      const cue = isDone ? signOfCue(cues.panel_done) : NO_SIGN;
      const sign = cue === NO_SIGN ? signOfNumber(number) : cue;
      this.#blocks.paint(at, isDone ? colours.panel_done : colours.panel, sign);
    } else if (kind === "side") {
      const isRed = colour === "red";
      const sign = isRed ? signOfCue(cues.side_touched) : NO_SIGN;
      this.#blocks.paint(at, isRed ? colours.side_touched : colours.side, sign);
    } else if (kind === "target") {
      this.#blocks.paint(at, colours.target, signOfCue(cues.target));
    } else this.#blocks.paint(at, colours.start_square, NO_SIGN);
  }
}

const PLATE = "#c9cbcd";
/** Of the box that comes next. */
const NEXT_PLATE = "#ffffff";

/** Metres. */
const PLATE_M = { hand: 0.055, foot: 0.1, thick: 0.004, apart: 0.012 } as const;
/** Turned up to eyes above it. */
const PLATE_TILT_RAD = -0.6;

/** Where a box's number plate is; null for a box that has no room for one. */
function plateOf(limb: Limb, panel: Surface, surfaces: readonly Surface[]): BlockPlace | null {
  const own = surfaces.filter(({ box }) => box === panel.box);
  const end = (axis: 0 | 1 | 2) =>
    Math.max(...own.map(({ centerM, halfSizeM }) => centerM[axis] + halfSizeM[axis]));
  const [x] = panel.centerM;
  if (limb === "foot") {
    const half = PLATE_M.foot / 2;
    const z = end(2) + PLATE_M.apart + half;
    return { centerM: [x, PLATE_M.thick / 2, z], halfSizeM: [half, PLATE_M.thick / 2, half] };
  }
  const half = Math.min(PLATE_M.hand / 2, panel.halfSizeM[0]);
  // Its lower edge lies on the upper wall, at the opening.
  const y = end(1) + half * Math.cos(PLATE_TILT_RAD) + 0.002;
  const z = end(2) + half * Math.sin(PLATE_TILT_RAD);
  return {
    centerM: [x, y, z],
    halfSizeM: [half, half, PLATE_M.thick / 2],
    tiltRad: PLATE_TILT_RAD,
  };
}
