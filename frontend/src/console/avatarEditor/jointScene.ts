/**
 * The stage of the editor: a body, and at its joints the limits of each axis as an arc in the plane
 * in which it turns, with the present angle as a needle that can be dragged.
 *
 * This module imports three.js: import it lazily.
 */

import type { Vector } from "@shared/rotations";
import type { CameraSide, StagePalette } from "@shared/stage/figure";
import { disposeLabel, label3d } from "@shared/stage/floor3d";
import { Stage3d } from "@shared/stage/scene";
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Group,
  Line,
  LineBasicMaterial,
  type Material,
  Mesh,
  MeshBasicMaterial,
  Plane,
  Raycaster,
  SphereGeometry,
  Sprite,
  Vector2,
  Vector3,
} from "three";
import { angleAt, onArc, type PlacedAxis } from "./pose";

/** By the letter of the axis; distinguishable with any kind of colour vision. */
export const AXIS_COLOURS: Readonly<Record<string, string>> = {
  X: "#d55e00",
  Y: "#0a8f6c",
  Z: "#3a7fd0",
};
const STEP_DEG = 4;
/** A needle's end is grabbed within this distance, pixels. */
const GRAB_PX = 16;
/** Distance of a close view, in radii of the arc. */
const CLOSE = 9;
/** A stage leaves room for a body that walks; this one does not. */
const BODY_ZOOM = 0.72;
/** Arcs are drawn over the body, so that no limb hides them. */
const OVER = 10;

export interface DrawnAxis {
  readonly placed: PlacedAxis;
  readonly isChosen: boolean;
}

export class JointScene extends Stage3d {
  readonly #arcs = new Group();
  #drawn: readonly DrawnAxis[] = [];

  constructor(canvas: HTMLCanvasElement) {
    super(canvas);
    this.scene.add(this.#arcs);
  }

  /** Draw the limits of these axes, and no others. */
  setAxes(drawn: readonly DrawnAxis[], palette: StagePalette): void {
    this.#clear();
    this.#drawn = drawn;
    for (const one of drawn) this.#arcs.add(...arcOf(one, palette));
    this.renderer.domElement.dataset.arcs = drawn.map(({ placed }) => placed.axis).join(" ");
    this.requestPicture();
  }

  /** Bring the chosen joint close, or the whole body if none is chosen. */
  showJoint(): void {
    const chosen = this.#drawn.find(({ isChosen }) => isChosen)?.placed;
    if (chosen === undefined) this.showBody("corner");
    else this.lookAt(chosen.anchorM, CLOSE * chosen.radiusM);
  }

  /** Look at the whole body, which stands on its place, so that it fills the picture. */
  showBody(from: CameraSide): void {
    this.placeCamera(from);
    this.zoom(BODY_ZOOM);
  }

  /** The axis whose needle ends near a position on the stage, the chosen one before others. */
  needleAt(xPx: number, yPx: number): PlacedAxis | null {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    const near = this.#drawn.filter(({ placed }) => {
      const end = new Vector3(...onArc(placed, placed.angleDeg)).project(this.camera);
      const x = (0.5 + end.x / 2) * clientWidth - xPx;
      const y = (0.5 - end.y / 2) * clientHeight - yPx;
      return Math.hypot(x, y) < GRAB_PX;
    });
    return (near.find(({ isChosen }) => isChosen) ?? near[0])?.placed ?? null;
  }

  /** The angle that a position on the stage means for an axis; null where its plane is edge-on. */
  angleUnder(placed: PlacedAxis, xPx: number, yPx: number): number | null {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    const at = new Vector2((2 * xPx) / clientWidth - 1, 1 - (2 * yPx) / clientHeight);
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    const normal = new Vector3(...placed.direction);
    if (Math.abs(ray.ray.direction.dot(normal)) < 0.08) return null;
    const plane = new Plane().setFromNormalAndCoplanarPoint(normal, new Vector3(...placed.anchorM));
    const hit = ray.ray.intersectPlane(plane, new Vector3());
    return hit === null ? null : angleAt(placed, hit.toArray() as unknown as Vector);
  }

  override dispose(): void {
    this.#clear();
    super.dispose();
  }

  #clear(): void {
    for (const child of [...this.#arcs.children]) {
      this.#arcs.remove(child);
      if (child instanceof Sprite) disposeLabel(child);
      else if (child instanceof Mesh || child instanceof Line) {
        child.geometry.dispose();
        (child.material as Material).dispose();
      }
    }
  }
}

function arcOf({ placed, isChosen }: DrawnAxis, palette: StagePalette) {
  const colour = AXIS_COLOURS[placed.axis.slice(-1)] ?? palette.ink;
  const rim = rimOf(placed);
  const anchor = placed.anchorM;
  const outline = line([anchor, ...rim, anchor], colour, isChosen ? 1 : 0.55);
  const zero = line(
    [anchor, onArc(placed, 0, 0.55 * placed.radiusM)],
    palette.ink,
    isChosen ? 0.5 : 0,
  );
  const needle = line(
    [anchor, onArc(placed, placed.angleDeg)],
    isChosen ? palette.ink : colour,
    isChosen ? 1 : 0.55,
  );
  const knob = new Mesh(
    new SphereGeometry(placed.radiusM * (isChosen ? 0.07 : 0.045), 16, 12),
    over(new MeshBasicMaterial({ color: isChosen ? palette.ink : colour })),
  );
  knob.position.set(...onArc(placed, placed.angleDeg));
  knob.renderOrder = OVER + 2;
  const letter = label3d(placed.axis.slice(-1), palette);
  letter.material.depthTest = false;
  letter.renderOrder = OVER + 3;
  letter.position.set(...onArc(placed, placed.highDeg, 1.14 * placed.radiusM));
  letter.visible = isChosen;
  return [sector(anchor, rim, colour, isChosen ? 0.34 : 0.1), outline, zero, needle, knob, letter];
}

/** The points of the arc from the lower to the upper limit. */
function rimOf(placed: PlacedAxis): readonly Vector[] {
  const { lowDeg, highDeg } = placed;
  const steps = Math.max(1, Math.ceil((highDeg - lowDeg) / STEP_DEG));
  return Array.from({ length: steps + 1 }, (_, step) =>
    onArc(placed, lowDeg + ((highDeg - lowDeg) * step) / steps),
  );
}

function over<Kind extends Material>(material: Kind): Kind {
  material.depthTest = false;
  material.depthWrite = false;
  material.transparent = true;
  return material;
}

function line(points: readonly Vector[], color: string, opacity: number): Line {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(points.flat()), 3));
  const made = new Line(geometry, over(new LineBasicMaterial({ color, opacity })));
  made.renderOrder = OVER + 1;
  return made;
}

function sector(anchor: Vector, rim: readonly Vector[], color: string, opacity: number): Mesh {
  const corners = rim.slice(1).flatMap((point, at) => [anchor, rim[at] ?? point, point]);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners.flat()), 3));
  const made = new Mesh(
    geometry,
    over(new MeshBasicMaterial({ color, opacity, side: DoubleSide })),
  );
  made.renderOrder = OVER;
  return made;
}
