/**
 * What the participant sees: a plain room with a mirror, bodies, and the boxes of the tasks.
 *
 * The session builds one `World` from the study's tasks and appearance, puts bodies into it as they
 * are loaded, and calls `show` once a frame with everything that is to be seen; then it renders
 * `scene` with its own renderer and camera. The world decides nothing about the study.
 *
 * An eye's pass takes at most 20 draw calls and never changes the render target. What is reflected
 * stands behind the glass (`mirror.ts`). This module imports three.js.
 */
import type { Place } from "@shared/avatar/hips";
import type { ArmsM } from "@shared/stage/skin/arms";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { type Camera, Color, Group, Scene, type WebGLRenderer } from "three";
import type { Limb } from "../tasks";
import type { Road } from "../telemetry";
import type { Palette } from "./appearance";
import { Board, boardWords } from "./board";
import { type Body3d, type Look, PlainBody, SkinnedBody, type Wearable } from "./bodies3d";
import {
  areaOf,
  type BoundaryProblem,
  boundaryLine,
  boundaryProblem,
  type FloorPoint,
  sizeOf,
  wayAcrossM,
} from "./boundary";
import { Companion } from "./companion";
import { Curtain, PANELS_ORDER } from "./curtain";
import { type Device, Devices } from "./devices";
import { makeLights } from "./lights";
import { type Mirror, mirrorBehind } from "./mirror";
import { makeRoom } from "./room";
import { type Setup, Setups, type TaskShown } from "./setups";
import { Shadows } from "./shadows";
import { tPose } from "./skeleton";
import { Sounds } from "./sounds";
import { Street, type StreetShown } from "./street";

export interface WorldOptions {
  /** The layouts of the study's tasks. */
  readonly layouts: ReadonlyMap<Limb, Setup>;
  readonly palette: Palette;
  /** Of the participant, for the words at the mirror. */
  readonly language: string;
  /** The road that participants cross, if the study has one. */
  readonly road?: Road | undefined;
  /** False leaves out what stands behind the glass, for comparisons with other mirrors. */
  readonly hasDouble?: boolean;
}

/** Both bodies' values in one frame, as in `bodies/bodies.ts`. */
export interface BodyValues {
  readonly local: ArrayLike<number>;
  readonly remote: ArrayLike<number>;
  readonly localFingers: ArrayLike<number> | null;
  readonly remoteFingers: ArrayLike<number> | null;
}

/** What exists for the participant now. */
export interface Visible {
  /** The body that shows what the tracking says; translucent beside the remote one. */
  readonly local: boolean;
  /** The body that the participant acts with. */
  readonly remote: boolean;
  /** The transparent figure in T-pose on the start square, to step into. */
  readonly figure: boolean;
  /** Controllers, hands and trackers, before there is a body. */
  readonly devices: boolean;
  /** The boxes of these limbs; in free movement those of both. */
  readonly setups: readonly Limb[];
}

/** Everything about one frame. The world keeps no reference to it. */
export interface WorldFrame {
  readonly timeS: number;
  /** The participant's eyes; null while the headset has lost its place. */
  readonly eyes: Place | null;
  readonly bodies: BodyValues | null;
  readonly visible: Visible;
  readonly devices: readonly Device[];
  /** The running task; null outside of tasks, when boxes look as before the start. */
  readonly task: TaskShown | null;
  /** Shown at the mirror; null: not shown. */
  readonly remainingS: number | null;
  readonly completed: number | null;
  /** The street instead of the room; null: the room. */
  readonly street?: StreetShown | null;
  /** The pose of the other person in the room; null: not shown. */
  readonly companion?: ArrayLike<number> | null;
  /** Bodies stay as they are; the view never does. */
  readonly isFrozen: boolean;
  /** Hide the room within 200 ms, or show it again. Panels stay visible. */
  readonly isCurtainDrawn: boolean;
  /** Hide it in this frame already: what is seen changes from one frame to the next. */
  readonly isCurtainAtOnce?: boolean;
}

export class World {
  readonly scene = new Scene();
  /**
   * For the surfaces of panels: not reflected, and in front of the curtain if their materials are
   * `transparent` (three.js draws others earlier).
   */
  readonly panels = new Group();
  readonly mirror: Mirror;
  readonly sounds = new Sounds();
  /** The other person in the room, nobody at first. */
  readonly companion: Companion;
  readonly #reflecting: Mirror | null;
  readonly #setups: Setups;
  readonly #board: Board;
  readonly #shadows: Shadows;
  readonly #devices: Devices;
  readonly #street: Street | null;
  readonly #curtain = new Curtain();
  readonly #area;
  readonly #line;
  readonly #room;
  readonly #models = new Map<string | null, Wearable>();
  /** By name of the body: kept, so that putting one on again takes no time. */
  readonly #wardrobe = new Map<string | null, Map<Slot, Body3d>>();
  #isSeenFromWithin = true;
  #worn: string | null = null;
  #statureM = 1.7;
  #armStretch = 1;
  #greenBefore = 0;
  #completedBefore: number | null = null;
  #wasFrozen = false;

  constructor({ layouts, palette, language, road, hasDouble = true }: WorldOptions) {
    this.#street = road === undefined ? null : new Street(road, palette.colours.start_square);
    if (this.#street !== null) this.scene.add(this.#street.group);
    this.#area = areaOf(layouts.values(), road === undefined ? 0 : wayAcrossM(road));
    const nearest = [...layouts.values()].flatMap(({ surfaces }) =>
      surfaces.map(({ centerM, halfSizeM }) => centerM[2] - halfSizeM[2]),
    );
    this.mirror = mirrorBehind(Math.min(0, ...nearest));
    this.#reflecting = hasDouble ? this.mirror : null;
    this.#room = makeRoom(this.mirror, hasDouble);
    this.#setups = new Setups(layouts, palette, this.#reflecting);
    this.#board = new Board(this.mirror, boardWords(language));
    this.#shadows = new Shadows(this.#reflecting);
    this.companion = new Companion(this.#reflecting);
    this.#devices = new Devices(this.#reflecting);
    this.#line = boundaryLine(this.#area);
    this.#line.visible = false;
    this.panels.renderOrder = PANELS_ORDER;
    this.scene.background = ROOM;
    this.scene.add(makeLights(), this.#room, this.#setups.mesh, this.#shadows.mesh);
    this.scene.add(
      this.#board.mesh,
      this.#devices.group,
      this.companion.group,
      this.#line,
      this.#curtain.mesh,
      this.panels,
    );
  }

  /**
   * Keep a body's model under its name (null: the configuration's), to be worn later. `armsM`: the
   * arms that it has where they are not its own.
   */
  addBody(name: string | null, model: BodyModel, armsM: ArmsM = {}): void {
    this.#models.set(name, { model, armsM });
    this.#clear(name);
  }

  /**
   * Let both bodies and the figure be this body, at the participant's stature. Until its model has
   * been added, a plain one of capsules is shown, whose arms are `armStretch` times as long as is
   * usual for the stature.
   */
  wear(name: string | null, statureM: number, armStretch = 1): void {
    const hasOtherLengths = statureM !== this.#statureM || armStretch !== this.#armStretch;
    if (name === this.#worn && !hasOtherLengths) return;
    for (const body of this.#bodies.values()) body.group.visible = false;
    if (hasOtherLengths) for (const one of this.#wardrobe.keys()) this.#clear(one);
    this.#worn = name;
    this.#statureM = statureM;
    this.#armStretch = armStretch;
  }

  /**
   * Compile everything that may be shown, including all bodies added so far, so that nothing
   * stutters when it appears for the first time.
   */
  async prepare(renderer: WebGLRenderer, camera: Camera): Promise<void> {
    const worn = this.#worn;
    for (const name of this.#models.keys()) {
      this.#worn = name;
      for (const slot of SLOTS) this.#body(slot);
    }
    this.#worn = worn;
    await renderer.compileAsync(this.scene, camera);
  }

  /**
   * Whether the room is seen through the body's own eyes, as usual, so that its head is seen in the
   * mirror only; false for a camera that looks at the body.
   */
  set isSeenFromWithin(isSeenFromWithin: boolean) {
    this.#isSeenFromWithin = isSeenFromWithin;
    for (const bodies of this.#wardrobe.values()) {
      for (const [slot, body] of bodies) {
        if (slot !== "figure") body.setSeenFromWithin(isSeenFromWithin);
      }
    }
  }

  /** The language of the words at the mirror. */
  speak(language: string): void {
    this.#board.speak(boardWords(language));
  }

  /** Check the guarded space, and show the line of what is needed if it does not suffice. */
  checkBoundary(bounds: readonly FloorPoint[] | null): BoundaryProblem {
    const problem = boundaryProblem(bounds, this.#area);
    this.#line.visible = problem !== null;
    return problem;
  }

  /** The guarded space and the one that is needed, width by depth, metres. */
  sizesOf(bounds: readonly FloorPoint[] | null) {
    const { minX, maxX, minZ, maxZ } = this.#area;
    return { haveM: sizeOf(bounds), needM: [maxX - minX, maxZ - minZ] as const };
  }

  /** Hide the line again, once somebody has decided to go on. */
  hideBoundary(): void {
    this.#line.visible = false;
  }

  show(frame: WorldFrame): void {
    const { visible, task } = frame;
    const street = this.#street === null ? null : (frame.street ?? null);
    this.#street?.show(street);
    if (this.#reflecting !== null) this.#reflecting.isThere = street === null;
    this.scene.background = street === null ? ROOM : SKY;
    this.#showBodies(frame);
    this.#devices.show(visible.devices ? frame.devices : NO_DEVICES);
    this.#setups.show(visible.setups, task);
    this.#board.show(frame.remainingS, frame.completed);
    this.#board.mesh.visible = street === null && frame.remainingS !== null;
    const beyond =
      frame.eyes === null || street !== null ? 0 : this.#nearness(frame.eyes.positionM[2]);
    const isAtOnce = frame.isCurtainAtOnce ?? false;
    this.#curtain.show(frame.timeS, frame.isCurtainDrawn || isAtOnce, beyond, isAtOnce);
    this.#hideCovered(street !== null);
    this.#sound(frame);
    this.#wasFrozen = frame.isFrozen;
  }

  dispose(): void {
    for (const name of this.#wardrobe.keys()) this.#clear(name);
    this.#setups.dispose();
    this.#street?.dispose();
    this.#board.dispose();
    this.#shadows.dispose();
    this.companion.dispose();
    this.#devices.dispose();
    this.#curtain.dispose();
    this.#line.geometry.dispose();
    this.#room.geometry.dispose();
    this.#room.material.map?.dispose();
    this.#room.material.dispose();
    this.sounds.dispose();
  }

  /** What is behind a curtain that has closed is not drawn. */
  #hideCovered(isOnStreet: boolean): void {
    const isOpen = this.#curtain.share < 1;
    this.#room.visible = isOpen && !isOnStreet;
    if (isOpen) return;
    if (this.#street !== null) this.#street.group.visible = false;
    for (const body of this.#bodies.values()) body.group.visible = false;
    this.companion.show(null);
    this.#shadows.show([]);
    this.#devices.show(NO_DEVICES);
    this.#setups.mesh.visible = false;
    this.#board.mesh.visible = false;
  }

  #showBodies({ bodies, visible, isFrozen, eyes, companion = null }: WorldFrame): void {
    const isBoth = visible.local && visible.remote;
    this.#pose("remote", visible.remote, bodies?.remote, bodies?.remoteFingers, isFrozen);
    this.#pose("local", visible.local && !isBoth, bodies?.local, bodies?.localFingers, isFrozen);
    this.#pose("beside", isBoth, bodies?.local, bodies?.localFingers, isFrozen);
    this.#showFigure(visible.figure, eyes);
    const standing = visible.remote ? "remote" : visible.local ? "local" : "figure";
    const other = this.companion.show(companion);
    this.#shadows.show([this.#bodies.get(standing) ?? null, other]);
  }

  #pose(
    slot: Slot,
    isVisible: boolean,
    pose: ArrayLike<number> | undefined,
    fingers: ArrayLike<number> | null | undefined,
    isFrozen: boolean,
  ): void {
    if (!isVisible || pose === undefined) {
      const hidden = this.#bodies.get(slot);
      if (hidden !== undefined) hidden.group.visible = false;
      return;
    }
    const body = this.#body(slot);
    if (isFrozen && body.group.visible) return;
    body.move(pose, fingers ?? null);
  }

  #showFigure(isVisible: boolean, eyes: Place | null): void {
    const known = this.#bodies.get("figure");
    if (!isVisible) {
      if (known !== undefined) known.group.visible = false;
      return;
    }
    const figure = this.#body("figure");
    if (!figure.group.visible) figure.move(tPose(figure.hipsHeightM), null);
    // Whoever has stepped into it sees out of it.
    const [x = 0, , z = 0] = eyes?.positionM ?? [9, 9, 9];
    figure.setSeenFromWithin(Math.hypot(x, z) < INSIDE_M);
  }

  #body(slot: Slot): Body3d {
    const known = this.#bodies.get(slot);
    if (known !== undefined) return known;
    const look: Look = slot === "remote" || slot === "local" ? "own" : "transparent";
    const worn = this.#models.get(this.#worn);
    const body =
      worn === undefined
        ? new PlainBody(this.#statureM, look, this.#reflecting, this.#armStretch)
        : new SkinnedBody(worn, this.#statureM, look, this.#reflecting);
    body.setSeenFromWithin(slot !== "figure" && this.#isSeenFromWithin);
    this.#bodies.set(slot, body);
    this.scene.add(body.group);
    return body;
  }

  /** The bodies that are made of the worn one. */
  get #bodies(): Map<Slot, Body3d> {
    let bodies = this.#wardrobe.get(this.#worn);
    if (bodies === undefined) {
      bodies = new Map();
      this.#wardrobe.set(this.#worn, bodies);
    }
    return bodies;
  }

  #clear(name: string | null): void {
    for (const body of this.#wardrobe.get(name)?.values() ?? []) {
      this.scene.remove(body.group);
      body.dispose();
    }
    this.#wardrobe.delete(name);
  }

  /** How far the eyes have come towards the glass, through which nobody may look at its back. */
  #nearness(eyesZM: number): number {
    const distance = eyesZM - this.mirror.planeZM;
    return Math.min(1, Math.max(0, 1 - (distance - GLASS_M) / GLASS_M));
  }

  #sound({ task, completed, isFrozen }: WorldFrame): void {
    let green = 0;
    for (const colour of task?.colours.values() ?? []) if (colour === "green") green++;
    const before = this.#completedBefore;
    if (before !== null && completed !== null && completed > before) this.sounds.play("complete");
    else if (task !== null && green > this.#greenBefore && this.#greenBefore > 0) {
      this.sounds.play("touch");
    }
    if (isFrozen && !this.#wasFrozen && task !== null) this.sounds.play("time_up");
    this.#greenBefore = green;
    this.#completedBefore = completed;
  }
}

/** `beside`: the local body while the remote one is there, too. */
type Slot = "local" | "remote" | "beside" | "figure";
const SLOTS: readonly Slot[] = ["local", "remote", "beside", "figure"];

const ROOM = new Color("#d8d7d2");
const SKY = new Color("#bcd2e4");
const NO_DEVICES: readonly Device[] = [];
/** Nearer to the figure's middle than this, one stands in it, metres. */
const INSIDE_M = 0.28;
/** The curtain begins to close at twice this distance from the glass, metres. */
const GLASS_M = 0.12;
