/**
 * The 3-D scene behind a stage. Nothing is drawn unless something changed, so that a page at rest
 * costs nothing. This module brings three.js with it: import it lazily.
 */
import {
  AmbientLight,
  Color,
  DirectionalLight,
  type Group,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Seconds } from "../units";
import { Blocks3d } from "./blocks3d";
import { Body3d } from "./body3d";
import {
  type Block,
  type BlockTones,
  type CameraMode,
  type Figure,
  facingOf,
  type LookFrom,
  middleOf,
  type StagePalette,
} from "./figure";
import { type FloorPlan, floorPlan } from "./floor";
import { disposeFloor, makeFloor } from "./floor3d";
import { nearestPoint, type Pointed } from "./pointed";
import { alongFloor, directionOf, fitting, lookOut } from "./views";

/** What else there is around the figures. */
export interface Surroundings {
  readonly blocks?: readonly Block[];
  /** Figures of other stages: the room is as large as if they were here, so that both compare. */
  readonly beside?: readonly Figure[];
}

/** Fields of view, from top to bottom. */
const USUAL_DEG = 28;
const WIDE_DEG = 75;

export class Stage3d {
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(USUAL_DEG, 1, 0.02, 500);
  readonly #controls: OrbitControls;
  #bodies: readonly Body3d[] = [];
  #blocks: Blocks3d | null = null;
  #floor: Group | null = null;
  #plan: FloorPlan | null = null;
  #ground = "";
  #mode: CameraMode = "orbit";
  #time = 0 as Seconds;
  #asked = 0;
  #followed: Vector3 | null = null;

  /** Throws where the browser has no WebGL. */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly onDrawn: (frame: number) => void,
  ) {
    // Kept after drawing, so that a picture of it can be saved.
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.#renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.enableDamping = false;
    this.#controls.maxPolarAngle = 0.495 * Math.PI;
    this.#controls.addEventListener("change", () => this.#ask());
    const sun = new DirectionalLight("#ffffff", 2.1);
    sun.position.set(2, 6, 3);
    this.#scene.add(new AmbientLight("#ffffff", 1.5), sun);
  }

  /** Put figures on the stage; the camera stays where it is while the floor is the same. */
  setFigures(
    figures: readonly Figure[],
    palette: StagePalette,
    { blocks = [], beside = [] }: Surroundings = {},
  ): void {
    for (const body of this.#bodies) {
      this.#scene.remove(body.group);
      body.dispose();
    }
    this.#bodies = figures.map((figure) => new Body3d(figure, palette));
    for (const body of this.#bodies) this.#scene.add(body.group);
    this.#standBlocks(blocks, palette);
    const plan = floorPlan([...figures, ...beside], blocks);
    const isElsewhere = JSON.stringify(plan) !== JSON.stringify(this.#plan);
    if (isElsewhere || palette.ground !== this.#ground) this.#layFloor(plan, palette);
    if (isElsewhere) this.look("corner");
    else this.show(this.#time);
  }

  #standBlocks(blocks: readonly Block[], palette: StagePalette): void {
    if (this.#blocks !== null) {
      this.#scene.remove(this.#blocks.group);
      this.#blocks.dispose();
    }
    this.#blocks = blocks.length > 0 ? new Blocks3d(blocks, palette) : null;
    if (this.#blocks !== null) this.#scene.add(this.#blocks.group);
  }

  /** Show what the blocks mean now; those that are not named are plain. */
  light(tones: BlockTones): void {
    this.#blocks?.light(tones);
    this.#ask();
  }

  #layFloor(plan: FloorPlan, palette: StagePalette): void {
    if (this.#floor !== null) {
      this.#scene.remove(this.#floor);
      disposeFloor(this.#floor);
    }
    this.#floor = makeFloor(plan, palette);
    this.#scene.add(this.#floor);
    this.#scene.background = new Color(palette.ground);
    this.#plan = plan;
    this.#ground = palette.ground;
  }

  /** Metres between two lines of the floor. */
  get step(): number {
    return this.#plan?.step ?? 1;
  }

  show(time: Seconds): void {
    this.#time = time;
    const frames = this.#bodies.map((body) => {
      body.headless = this.#mode === "eyes";
      return body.show(time);
    });
    this.#moveCamera();
    this.onDrawn(frames[0] ?? 0);
    this.#ask();
  }

  setMode(mode: CameraMode): void {
    const wasInside = this.#mode === "eyes" && mode !== "eyes";
    this.#mode = mode;
    this.#followed = null;
    this.#controls.enabled = mode !== "eyes";
    this.#camera.fov = mode === "eyes" ? WIDE_DEG : USUAL_DEG;
    this.#camera.updateProjectionMatrix();
    if (wasInside) this.look("corner");
    else this.show(this.#time);
  }

  /** Place the camera so that the whole movement is in view, seen from a side of the body. */
  look(from: LookFrom): void {
    const plan = this.#plan;
    if (plan === null) return;
    for (const body of this.#bodies) body.show(this.#time);
    const away = directionOf(from, this.#facing());
    const view = fitting(plan, away, this.#camera);
    this.#camera.near = Math.max(0.01, view.distance / 200);
    this.#camera.far = view.distance * 20;
    this.#camera.updateProjectionMatrix();
    this.#controls.target.copy(view.middle);
    this.#camera.position.copy(view.middle).addScaledVector(away, view.distance);
    this.#followed = null;
    this.#controls.update();
    this.show(this.#time);
  }

  /** Nearer by a factor below 1, farther by one above. */
  zoom(factor: number): void {
    const { target } = this.#controls;
    this.#camera.position.sub(target).multiplyScalar(factor).add(target);
    this.#controls.update();
    this.#ask();
  }

  /** The point that is nearest to a place on the stage, where one is near. */
  nearest(xPx: number, yPx: number): Pointed | null {
    const { clientWidth, clientHeight } = this.#renderer.domElement;
    const size = [clientWidth, clientHeight] as const;
    return nearestPoint(this.#bodies, this.#camera, size, [xPx, yPx]);
  }

  resize(width: number, height: number): void {
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height, false);
    const first = this.#camera.aspect === 1;
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    if (first) this.look("corner");
    // At once: a canvas is empty after its size has changed.
    this.#draw();
  }

  dispose(): void {
    cancelAnimationFrame(this.#asked);
    for (const body of this.#bodies) body.dispose();
    this.#blocks?.dispose();
    if (this.#floor !== null) disposeFloor(this.#floor);
    this.#controls.dispose();
    this.#renderer.dispose();
    this.#renderer.forceContextLoss();
  }

  /** Where the first body faces as it is shown; towards +z where that is not known. */
  #facing(): readonly [x: number, z: number] {
    const body = this.#bodies[0];
    return (body && alongFloor(facingOf(body.figure, body.placing.placed))) ?? [0, 1];
  }

  #ask(): void {
    if (this.#asked !== 0) return;
    this.#asked = requestAnimationFrame(() => this.#draw());
  }

  #draw(): void {
    cancelAnimationFrame(this.#asked);
    this.#asked = 0;
    this.#renderer.render(this.#scene, this.#camera);
  }

  #moveCamera(): void {
    const body = this.#bodies[0];
    if (body === undefined || this.#mode === "orbit") return;
    const { placed } = body.placing;
    const [x, , z] = middleOf(body.figure, placed);
    if (this.#mode === "follow") {
      const now = new Vector3(x, 0, z);
      const { target } = this.#controls;
      const moved = now.clone().sub(this.#followed ?? new Vector3(target.x, 0, target.z));
      this.#followed = now;
      this.#camera.position.add(moved);
      this.#controls.target.add(moved);
      this.#controls.update();
      return;
    }
    lookOut(this.#camera, body.figure, placed, this.#blocks?.middle ?? null);
  }
}
