/**
 * The panel of the headset's page: shows a content in the scene and lets it be pointed at.
 *
 * One panel is shown at a time. It stands where the wearer looked when it appeared, and moves there
 * again when it has been out of sight for a while or the wearer has walked away from it.
 */
import type { Vector } from "@shared/rotations";
import { Group } from "three";
import { headingOf } from "../tracking/places";
import type { TrackedFrame } from "../tracking/tracked";
import type { PanelContent } from "./content";
import { PanelLayoutError } from "./surface/layout";
import { type HandPointing, hitOf, Pointer, type Side } from "./surface/pointing";
import type { PanelScreen } from "./surface/screen";
import { PANEL_DISTANCE_M, PanelSurface } from "./surface/surface";
import type { Measure } from "./surface/wrap";

/** Outside of this angle beside the middle of the view, a panel cannot be read. */
const OUT_OF_SIGHT_RAD = (55 * Math.PI) / 180;
/** How far to the right a panel stands that leaves the mirror free. */
const BESIDE_RAD = (32 * Math.PI) / 180;
/** Half of a panel's width as it is seen, and a gap to the edge of a window. */
const HALF_PANEL_RAD = (24.5 * Math.PI) / 180;
const EDGE_RAD = (2 * Math.PI) / 180;
/** A flat picture stretches what lies farther from its middle until it can hardly be read. */
const STRETCHED_RAD = (42 * Math.PI) / 180;
const NEAR_M = 0.5;
const FAR_M = 2.6;
const AWAY_S = 1.5;
const LEAST_DISTANCE_M = 0.8;
const WALL_GAP_M = 0.15;

/**
 * How far to the right a panel stands. `halfViewRad`: from the middle of a window to its edge, in
 * which the whole panel has to be seen without turning a head; null in a headset.
 */
export function besideRad(halfViewRad: number | null): number {
  if (halfViewRad === null) return BESIDE_RAD;
  return Math.min(
    BESIDE_RAD,
    Math.max(0, Math.min(halfViewRad, STRETCHED_RAD) - HALF_PANEL_RAD - EDGE_RAD),
  );
}

export interface PanelsOptions {
  /** The plane of the wall with the mirror, behind which a panel must not stand. */
  readonly wallZM?: number;
  /** Said in place of what no panel can hold. */
  readonly tooLong?: string;
}

export class Panels {
  /** To be added to the scene once. */
  readonly object = new Group();
  readonly #surface: PanelSurface;
  readonly #pointer = new Pointer();
  readonly #wallZM: number;
  readonly #tooLong: string;
  #content: PanelContent | null = null;
  #isNew = false;
  #isPlaced = false;
  #isLow = false;
  #isBeside = false;
  #halfViewRad: number | null = null;
  #shownKey = "";
  #awaySinceS: number | null = null;
  /** Called when something was pressed: for a sound, or a pulse of the controller. */
  onPressed: ((side: Side | null) => void) | null = null;

  constructor({ wallZM = Number.NEGATIVE_INFINITY, tooLong = "" }: PanelsOptions = {}) {
    this.#wallZM = wallZM;
    this.#tooLong = tooLong;
    this.#surface = new PanelSurface();
    this.object.name = "panels";
    this.object.add(this.#surface.object, this.#surface.beam);
  }

  /** How wide a text is, for contents that divide themselves into pages. */
  get measure(): Measure {
    return this.#surface.measure;
  }

  get content(): PanelContent | null {
    return this.#content;
  }

  /** Show a content, or nothing. The same content again changes nothing. */
  show(content: PanelContent | null): void {
    if (content === this.#content) return;
    if (this.#content !== null) this.#content.onChange = null;
    // A panel that follows another one stays where it is.
    if (this.#content === null) this.#isPlaced = false;
    this.#content = content;
    this.#isNew = true;
    if (content !== null) {
      content.onChange = () => {
        this.#isNew = true;
      };
    }
  }

  /** The study is shown in a window, of which this is half the angle of view. */
  set halfViewRad(halfViewRad: number) {
    if (halfViewRad === this.#halfViewRad) return;
    this.#halfViewRad = halfViewRad;
    this.#isPlaced = false;
  }

  /** Let the panel stand in front of the wearer again, as the operator may ask for. */
  recentre(): void {
    this.#isPlaced = false;
  }

  /**
   * One frame: draw what has changed, follow the rays, take a press. `canPress`: false while the
   * hands mean something else.
   */
  update(frame: TrackedFrame, canPress = true): void {
    this.#draw(frame.timeS);
    if (this.#content === null) return;
    this.#place(frame);
    const pointed = this.#pointer.update(frame.timeS, {
      left: this.#pointing(frame, "left", canPress),
      right: this.#pointing(frame, "right", canPress),
    });
    const ray = pointed.side === null ? null : frame.hands[pointed.side].ray;
    const hit = ray === null ? null : hitOf(ray, this.#surface.board);
    this.#surface.point(this.#surface.targetAt(hit), hit, ray);
    if (pointed.pressed === null) return;
    this.onPressed?.(pointed.side);
    this.#content.press(pointed.pressed, frame.timeS * 1000);
  }

  #draw(nowS: number): void {
    if (!this.#isNew) return;
    this.#isNew = false;
    const screen = this.#content?.screen ?? null;
    try {
      this.#surface.show(screen);
    } catch (error) {
      if (!(error instanceof PanelLayoutError) || screen === null) throw error;
      // The loop must go on, and the way back or on must stay open.
      const { buttons = [] } = screen;
      this.#surface.show({ key: screen.key, problem: this.#tooLong, buttons });
    }
    if (screen !== null) this.#standAs(screen);
    if (screen !== null && screen.key !== this.#shownKey) this.#pointer.screenChanged(nowS);
    this.#shownKey = screen?.key ?? "";
  }

  /** Another place in the view: the panel goes there at once. */
  #standAs({ isLow = false, isBeside = false }: PanelScreen): void {
    if (isLow !== this.#isLow || isBeside !== this.#isBeside) this.#isPlaced = false;
    this.#isLow = isLow;
    this.#isBeside = isBeside;
  }

  #place({ eyes, timeS }: TrackedFrame): void {
    if (eyes === null) return;
    const heading = headingOf(eyes);
    if (!this.#isPlaced) {
      const towards = heading - (this.#isBeside ? besideRad(this.#halfViewRad) : 0);
      const distanceM = this.#distanceM(eyes.positionM, towards);
      this.#surface.place(eyes.positionM, towards, distanceM, this.#isLow);
      this.#isPlaced = true;
      this.#awaySinceS = null;
      return;
    }
    const [dx, dz] = fromTo(eyes.positionM, this.#surface.board.centreM);
    const distanceM = Math.hypot(dx, dz);
    const beside = Math.abs(wrapped(Math.atan2(-dx, -dz) - heading));
    const isAway = beside > OUT_OF_SIGHT_RAD || distanceM < NEAR_M || distanceM > FAR_M;
    if (!isAway) this.#awaySinceS = null;
    else if (this.#awaySinceS === null) this.#awaySinceS = timeS;
    else if (timeS - this.#awaySinceS > AWAY_S) this.#isPlaced = false;
  }

  /** As far as it should be, or as the wall allows. Sizes are angles: it looks the same. */
  #distanceM([, , z]: Vector, heading: number): number {
    const ahead = Math.cos(heading);
    if (ahead < 0.2) return PANEL_DISTANCE_M;
    const toWallM = (z - this.#wallZM) / ahead - WALL_GAP_M;
    return Math.min(PANEL_DISTANCE_M, Math.max(LEAST_DISTANCE_M, toWallM));
  }

  #pointing(frame: TrackedFrame, side: Side, canPress: boolean): HandPointing {
    const { ray, isSelecting } = frame.hands[side];
    const hit = ray === null || !canPress ? null : hitOf(ray, this.#surface.board);
    return { hit, target: this.#surface.targetAt(hit)?.target ?? null, isSelecting };
  }

  /** Where the targets are in the room, for tests that point at them. */
  get targetsM(): readonly { readonly target: string; readonly atM: Vector }[] {
    return this.#surface.targetsM;
  }

  dispose(): void {
    this.show(null);
    this.#surface.dispose();
  }
}

const fromTo = (from: Vector, to: Vector): readonly [number, number] => [
  to[0] - from[0],
  to[2] - from[2],
];

const wrapped = (angle: number): number => Math.atan2(Math.sin(angle), Math.cos(angle));
