/** A ring before the eyes that fills while the participant holds the stop gesture, with a word on it. */
import { rotate, type Vector } from "@shared/rotations";
import {
  CanvasTexture,
  Group,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  RingGeometry,
  SRGBColorSpace,
} from "three";
import type { TrackedFrame } from "../../tracking/tracked";
import { PANELS_ORDER } from "../../world";
import { paintLabel } from "../surface/paint";
import type { PanelWords } from "../texts";
import type { StopProgress } from "./stopGesture";

const DISTANCE_M = 1;
const SEGMENTS = 96;
const LABEL_PX = { width: 880, height: 200 } as const;

export class StopRing {
  readonly object = new Group();
  readonly #words: PanelWords;
  readonly #ring: Mesh<RingGeometry, MeshBasicMaterial>;
  readonly #texture: CanvasTexture;
  readonly #context: CanvasRenderingContext2D;
  #by: StopProgress["by"] | null = null;

  constructor(words: PanelWords, canvas: HTMLCanvasElement = document.createElement("canvas")) {
    this.#words = words;
    canvas.width = LABEL_PX.width;
    canvas.height = LABEL_PX.height;
    const context = canvas.getContext("2d");
    if (context === null) throw new Error("This browser draws no text: it has no 2D canvas.");
    this.#context = context;
    this.#texture = new CanvasTexture(canvas);
    this.#texture.colorSpace = SRGBColorSpace;
    // Always on top: it must be seen whatever stands before the participant.
    const onTop = { transparent: true, depthTest: false, depthWrite: false, toneMapped: false };
    const track = new Mesh(
      new RingGeometry(0.05, 0.064, SEGMENTS),
      new MeshBasicMaterial({ ...onTop, color: "#1b2325", opacity: 0.75 }),
    );
    this.#ring = new Mesh(
      new RingGeometry(0.05, 0.064, SEGMENTS, 1, Math.PI / 2, -2 * Math.PI),
      // Clockwise from the top: its faces look away.
      new MeshBasicMaterial({ ...onTop, color: "#f7bf74", side: 2 }),
    );
    const label = new Mesh(
      new PlaneGeometry(0.44, 0.1),
      new MeshBasicMaterial({ ...onTop, map: this.#texture }),
    );
    label.position.y = -0.13;
    for (const [at, mesh] of [track, this.#ring, label].entries())
      mesh.renderOrder = PANELS_ORDER + 10 + at;
    this.object.add(track, this.#ring, label);
    this.object.visible = false;
  }

  update({ eyes }: TrackedFrame, progress: StopProgress | null): void {
    this.object.visible = progress !== null && eyes !== null;
    if (progress === null || eyes === null) return;
    if (progress.by !== this.#by) {
      this.#by = progress.by;
      const cancel = this.#words(progress.by === "hand" ? "stop.cancel" : "stop.cancelGrips");
      paintLabel(this.#context, [this.#words("stop.hold"), cancel]);
      this.#texture.needsUpdate = true;
    }
    const triangles = Math.ceil(progress.share * SEGMENTS) * 2;
    this.#ring.geometry.setDrawRange(0, triangles * 3);
    const ahead: Vector = rotate(eyes.rotation, [0, -0.06, -DISTANCE_M]);
    const [x, y, z] = eyes.positionM;
    this.object.position.set(x + ahead[0], y + ahead[1], z + ahead[2]);
    const [w, qx, qy, qz] = eyes.rotation;
    this.object.quaternion.set(qx, qy, qz, w);
  }

  dispose(): void {
    this.#texture.dispose();
    for (const child of this.object.children) {
      if (child instanceof Mesh) {
        child.geometry.dispose();
        child.material.dispose();
      }
    }
  }
}
