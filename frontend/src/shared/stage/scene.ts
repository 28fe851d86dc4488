/**
 * Figures on a floor with a scale and a movable camera: the room is as large as what moves in it.
 * This module imports three.js: import it lazily.
 */
import { Color, PerspectiveCamera, type Sprite, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Seconds } from "../units";
import {
  type Block,
  type CameraMode,
  type CameraSide,
  type Figure,
  facingOf,
  middleOf,
  type StagePalette,
} from "./figure";
import { type FloorPlan, floorPlan } from "./floor";
import { disposeLabel, label3d } from "./floor3d";
import { NO_MARKS } from "./marks";
import { BodyMarks3d } from "./marks3d";
import type { Placing } from "./placing";
import { bodyOf, Space3d, type StageBody } from "./space3d";
import { alongFloor, directionOf, fitting, lookThroughEyes } from "./views";

/** What else is in the scene with the figures. */
export interface Surroundings {
  readonly blocks?: readonly Block[];
  /** Figures of other stages: the room is made large enough for them too, so that both compare. */
  readonly comparedFigures?: readonly Figure[];
}

/** Vertical fields of view, degrees. */
const USUAL_DEG = 28;
const WIDE_DEG = 75;

export class Stage3d extends Space3d {
  readonly #controls: OrbitControls;
  #plan: FloorPlan | null = null;
  #ground = "";
  #firstSide: CameraSide = "corner";
  #mode: CameraMode = "orbit";
  #time = 0 as Seconds;
  #followed: Vector3 | null = null;
  #labels: readonly Sprite[] = [];
  #marks: readonly { readonly body: StageBody; readonly marks: BodyMarks3d }[] = [];

  /** Throws if the browser has no WebGL. */
  constructor(canvas: HTMLCanvasElement) {
    // The buffer is kept after drawing, so that a picture of it can be saved.
    super(new PerspectiveCamera(USUAL_DEG, 1, 0.02, 500), { canvas, preserveDrawingBuffer: true });
    this.#controls = new OrbitControls(this.camera, canvas);
    this.#controls.enableDamping = false;
    this.#controls.maxPolarAngle = 0.495 * Math.PI;
    this.#controls.addEventListener("change", () => this.requestPicture());
  }

  /** Set from where the camera looks at a new floor; set it before the figures. */
  setFirstSide(from: CameraSide): void {
    this.#firstSide = from;
  }

  /** Put figures on the stage; the camera stays where it is while the floor is the same. */
  setFigures(
    figures: readonly Figure[],
    palette: StagePalette,
    { blocks = [], comparedFigures = [] }: Surroundings = {},
  ): void {
    this.standBodies(figures.map((figure) => bodyOf(figure, palette)));
    this.#standMarks();
    this.#standLabels(figures, palette);
    this.standBlocks(blocks, palette);
    const plan = floorPlan([...figures, ...comparedFigures], blocks);
    const isElsewhere = JSON.stringify(plan) !== JSON.stringify(this.#plan);
    if (isElsewhere || palette.ground !== this.#ground) {
      this.layFloor(plan, palette);
      this.scene.background = new Color(palette.ground);
      this.#plan = plan;
      this.#ground = palette.ground;
    }
    if (isElsewhere) this.placeCamera(this.#firstSide);
    else this.show(this.#time);
  }

  /** Metres between two lines of the floor. */
  get step(): number {
    return this.#plan?.step ?? 1;
  }

  show(time: Seconds): void {
    this.#time = time;
    const frames = this.bodies.map((body) => {
      const isInside = this.#mode === "eyes";
      body.headless = isInside;
      // The ghost of the one who sees would block the view.
      body.group.visible = !(isInside && body.figure.tone === "ghost");
      return body.show(time);
    });
    for (const { body, marks } of this.#marks) {
      marks.marks = body.figure.marks?.(time) ?? NO_MARKS;
      marks.show(body.placing.placed);
    }
    this.#moveCamera();
    this.renderer.domElement.dataset.frame = String(frames[0] ?? 0);
    this.requestPicture();
  }

  #standLabels(figures: readonly Figure[], palette: StagePalette): void {
    this.#clearLabels();
    this.#labels = figures.flatMap(({ label, offset = [0, 0] }) => {
      if (label === undefined) return [];
      const words = label3d(label.text, palette);
      words.position.set(offset[0], label.heightM, offset[1]);
      return words;
    });
    for (const words of this.#labels) this.scene.add(words);
  }

  #clearLabels(): void {
    for (const words of this.#labels) {
      this.scene.remove(words);
      disposeLabel(words);
    }
    this.#labels = [];
  }

  #standMarks(): void {
    for (const { marks } of this.#marks) {
      this.scene.remove(marks.group);
      marks.dispose();
    }
    this.#marks = this.bodies
      .filter(({ figure }) => figure.marks !== undefined)
      .map((body) => {
        const { names, parents } = body.figure.motion;
        return { body, marks: new BodyMarks3d(names, parents) };
      });
    for (const { marks } of this.#marks) this.scene.add(marks.group);
  }

  setMode(mode: CameraMode): void {
    const wasInside = this.#mode === "eyes" && mode !== "eyes";
    this.#mode = mode;
    this.#followed = null;
    this.#controls.enabled = mode !== "eyes";
    this.camera.fov = mode === "eyes" ? WIDE_DEG : USUAL_DEG;
    this.camera.updateProjectionMatrix();
    if (wasInside) this.placeCamera(this.#firstSide);
    else this.show(this.#time);
  }

  /** Place the camera so that the whole movement is in view, seen from a side of the body. */
  placeCamera(from: CameraSide): void {
    const plan = this.#plan;
    if (plan === null) return;
    for (const body of this.bodies) body.show(this.#time);
    const away = directionOf(from, this.#facing());
    const view = fitting(plan, away, this.camera);
    this.camera.near = Math.max(0.01, view.distance / 200);
    this.camera.far = view.distance * 20;
    this.camera.updateProjectionMatrix();
    this.#controls.target.copy(view.middle);
    this.camera.position.copy(view.middle).addScaledVector(away, view.distance);
    this.#followed = null;
    this.#controls.update();
    this.renderer.domElement.dataset.side = from;
    this.show(this.#time);
  }

  /** Zoom in with a factor below 1, out with one above. */
  zoom(factor: number): void {
    const { target } = this.#controls;
    this.camera.position.sub(target).multiplyScalar(factor).add(target);
    this.#controls.update();
    this.requestPicture();
  }

  /** Look at a place from a distance, in metres, from the direction the camera has now. */
  lookAt(middle: readonly [x: number, y: number, z: number], distanceM: number): void {
    const { target } = this.#controls;
    const away = this.camera.position.clone().sub(target).setLength(distanceM);
    target.set(...middle);
    this.camera.position.copy(target).add(away);
    this.#controls.update();
    this.requestPicture();
  }

  /** The point nearest to a position on the stage, if one is close enough. */
  nearest(xPx: number, yPx: number): Pointed | null {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    const size = [clientWidth, clientHeight] as const;
    return nearestPoint(this.bodies, this.camera, size, [xPx, yPx]);
  }

  protected override resized(before: number): void {
    if (before === 1) this.placeCamera(this.#firstSide);
  }

  override dispose(): void {
    for (const { marks } of this.#marks) marks.dispose();
    this.#clearLabels();
    this.#controls.dispose();
    super.dispose();
  }

  /** The direction the first body faces as it is shown; +z if unknown. */
  #facing(): readonly [x: number, z: number] {
    const body = this.bodies[0];
    return (body && alongFloor(facingOf(body.figure, body.placing.placed))) ?? [0, 1];
  }

  #moveCamera(): void {
    const body = this.bodies[0];
    if (body === undefined || this.#mode === "orbit") return;
    const { placed } = body.placing;
    const [x, , z] = middleOf(body.figure, placed);
    if (this.#mode === "follow") {
      const now = new Vector3(x, 0, z);
      const { target } = this.#controls;
      const moved = now.clone().sub(this.#followed ?? new Vector3(target.x, 0, target.z));
      this.#followed = now;
      this.camera.position.add(moved);
      this.#controls.target.add(moved);
      this.#controls.update();
      return;
    }
    const place = this.blocks?.middle ?? null;
    lookThroughEyes(this.camera, body.figure, placed, { time: this.#time, place });
  }
}

/** Which point of the figures is under the pointer. */

/** A point of a figure on the screen; pixels from the stage's upper left corner. */
export interface Pointed {
  readonly name: string;
  readonly x: number;
  readonly y: number;
}

/** Points farther from the pointer are ignored, pixels. */
const WITHIN = 14;

/** The point nearest to a position on the stage, if one is close enough. */
function nearestPoint(
  bodies: readonly { readonly placing: Placing }[],
  camera: PerspectiveCamera,
  [width, height]: readonly [width: number, height: number],
  [xPx, yPx]: readonly [x: number, y: number],
): Pointed | null {
  let best: Pointed | null = null;
  let least = WITHIN;
  const at = new Vector3();
  for (const { placing } of bodies) {
    placing.figure.motion.names.forEach((name, point) => {
      at.fromArray(placing.placed, 3 * point).project(camera);
      const x = (0.5 + at.x / 2) * width;
      const y = (0.5 - at.y / 2) * height;
      const far = Math.hypot(x - xPx, y - yPx);
      if (at.z < 1 && far < least) {
        least = far;
        best = { name, x, y };
      }
    });
  }
  return best;
}
