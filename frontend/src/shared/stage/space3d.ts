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
import { isDrawnInSoftware, Sharpness } from "./graphics";
import { SkinnedBody3d } from "./skin/skinnedBody3d";

/** After so long without a picture, the last one is drawn finely, ms. */
const REST_MS = 250;

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
  readonly #sharpness: Sharpness | null;
  #floor: Group | null = null;
  #frameRequest = 0;
  #restTimer = 0;

  /**
   * `isLive`: what it shows moves now, so it draws coarsely rather than late. Throws if the browser
   * has no WebGL.
   */
  constructor(
    protected readonly camera: PerspectiveCamera,
    { isLive = false, ...canvas }: WebGLRendererParameters & { readonly isLive?: boolean },
  ) {
    const isSlow = isLive && isDrawnInSoftware();
    this.renderer = new WebGLRenderer({ antialias: !isSlow, ...canvas });
    // Without a graphics card smooth edges would cost most of the time: at rest, pixels smooth them.
    const ratio = isSlow ? 2 : Math.min(window.devicePixelRatio, 2);
    this.renderer.setPixelRatio(ratio);
    this.#sharpness = isLive ? new Sharpness(ratio, isSlow ? 1 : ratio) : null;
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
    window.clearTimeout(this.#restTimer);
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
    this.#frameRequest = requestAnimationFrame((nowMs) => {
      this.#keepUp(nowMs);
      this.#draw();
    });
  }

  /** Choose the pixels of a picture that is drawn now, and of the one that follows at rest. */
  #keepUp(nowMs: number): void {
    const sharpness = this.#sharpness;
    if (sharpness === null) return;
    requestAnimationFrame((nextMs) => sharpness.note(nextMs - nowMs));
    this.#drawWith(sharpness.moving);
    window.clearTimeout(this.#restTimer);
    this.#restTimer = window.setTimeout(() => {
      if (this.#drawWith(sharpness.still)) this.#draw();
    }, REST_MS);
  }

  /** Return whether the ratio is another one; the picture is empty then. */
  #drawWith(pixelRatio: number): boolean {
    if (this.renderer.getPixelRatio() === pixelRatio) return false;
    this.renderer.setPixelRatio(pixelRatio);
    return true;
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
