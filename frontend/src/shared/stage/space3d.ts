/**
 * The base of every 3-D view: renderer, camera and light, bodies among blocks on a floor.
 *
 * A picture is drawn at most once per animation frame, and only after something has changed, so
 * that
 * a page at rest costs nothing. This module imports three.js: import it lazily.
 */
import {
  AmbientLight,
  DirectionalLight,
  type Group,
  type PerspectiveCamera,
  Scene,
  WebGLRenderer,
  type WebGLRendererParameters,
} from "three";
import { Blocks3d } from "./blocks3d";
import { Body3d } from "./body3d";
import type { Block, BlockTones, Figure, StagePalette } from "./figure";
import type { FloorPlan } from "./floor";
import { disposeFloor, makeFloor, turnLabels } from "./floor3d";
import { SkinnedBody3d } from "./skin/skinnedBody3d";

/** A figure in the scene: a skeleton, or the body that it wears. */
export type StageBody = Body3d | SkinnedBody3d;

export const bodyOf = (figure: Figure, palette: StagePalette): StageBody =>
  figure.worn === undefined
    ? new Body3d(figure, palette)
    : new SkinnedBody3d(figure, figure.worn, palette);

export abstract class Space3d {
  protected readonly renderer: WebGLRenderer;
  protected readonly scene = new Scene();
  protected bodies: readonly StageBody[] = [];
  protected blocks: Blocks3d | null = null;
  #floor: Group | null = null;
  #frameRequest = 0;

  /** Throws if the browser has no WebGL. */
  constructor(
    protected readonly camera: PerspectiveCamera,
    canvas: WebGLRendererParameters,
  ) {
    this.renderer = new WebGLRenderer({ antialias: true, ...canvas });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    const sun = new DirectionalLight("#ffffff", 2.1);
    sun.position.set(2, 6, 3);
    // Bodies usually face away from the sun, -z: this light keeps faces from lying in the dark.
    const fill = new DirectionalLight("#ffffff", 1.1);
    fill.position.set(-2, 3, -5);
    this.scene.add(new AmbientLight("#ffffff", 1.3), sun, fill);
  }

  /** Show the blocks in their current tones; those that are not listed are plain. */
  light(tones: BlockTones): void {
    this.blocks?.light(tones);
    this.requestPicture();
  }

  resize(width: number, height: number): void {
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    const before = this.camera.aspect;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.resized(before);
    // Immediately: a canvas is empty after its size has changed.
    this.#draw();
  }

  dispose(): void {
    cancelAnimationFrame(this.#frameRequest);
    this.#clearBodies();
    this.#clearBlocks();
    this.#clearFloor();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** Called after the camera's aspect ratio has changed; `before` is the previous one. */
  protected abstract resized(before: number): void;

  /** Called after every picture. */
  protected drawn(): void {}

  protected standBodies(bodies: readonly StageBody[]): void {
    this.#clearBodies();
    this.bodies = bodies;
    for (const body of bodies) this.scene.add(body.group);
  }

  protected standBlocks(blocks: readonly Block[], palette: StagePalette): void {
    this.#clearBlocks();
    if (blocks.length === 0) return;
    this.blocks = new Blocks3d(blocks, palette);
    this.scene.add(this.blocks.group);
  }

  protected layFloor(plan: FloorPlan, palette: StagePalette): void {
    this.#clearFloor();
    this.#floor = makeFloor(plan, palette);
    this.scene.add(this.#floor);
  }

  protected requestPicture(): void {
    if (this.#frameRequest !== 0) return;
    this.#frameRequest = requestAnimationFrame(() => this.#draw());
  }

  #draw(): void {
    cancelAnimationFrame(this.#frameRequest);
    this.#frameRequest = 0;
    if (this.#floor !== null) turnLabels(this.#floor, this.camera);
    this.renderer.render(this.scene, this.camera);
    this.drawn();
  }

  #clearBodies(): void {
    for (const body of this.bodies) {
      this.scene.remove(body.group);
      body.dispose();
    }
    this.bodies = [];
  }

  #clearBlocks(): void {
    if (this.blocks === null) return;
    this.scene.remove(this.blocks.group);
    this.blocks.dispose();
    this.blocks = null;
  }

  #clearFloor(): void {
    if (this.#floor === null) return;
    this.scene.remove(this.#floor);
    disposeFloor(this.#floor);
    this.#floor = null;
  }
}
