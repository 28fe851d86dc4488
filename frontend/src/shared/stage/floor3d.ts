/**
 * The floor of the scene: lines at regular distances in metres, labelled along the two edges that
 * are nearest to the camera, so that nobody stands between it and the labels.
 */
import {
  BufferAttribute,
  BufferGeometry,
  type Camera,
  CanvasTexture,
  Group,
  LineBasicMaterial,
  LineSegments,
  type PerspectiveCamera,
  Sprite,
  SpriteMaterial,
  Vector3,
} from "three";
import type { StagePalette } from "./figure";
import type { FloorPlan } from "./floor";

const MAX_LABELS = 14;

export function makeFloor(plan: FloorPlan, palette: StagePalette): Group {
  const floor = new Group();
  floor.add(lines(plan, palette.lineStrong, 0.55));
  for (const axis of [0, 1] as const) {
    const [first, last] = [plan.min[axis], plan.max[axis]];
    const cells = Math.round((last - first) / plan.step);
    const every = Math.max(1, Math.ceil(cells / MAX_LABELS));
    // The corner belongs to one of both edges, or it would be named twice.
    for (let cell = 1; cell <= cells - axis; cell += every) {
      const value = first + cell * plan.step;
      const text = `${tidy(value)} m`;
      const margin = (axis === 0 ? 0.22 : 0.31) * plan.step;
      const label = label3d(text, palette);
      // Where the near edge is outside of the picture, a label on the far one is read over the legs.
      label.material.depthTest = false;
      label.renderOrder = 1;
      const across = axis === 0 ? 1 : 0;
      const edges = [plan.min[across] - margin, plan.max[across] + margin] as const;
      label.userData = { axis, value, edges } satisfies EdgeLabel;
      floor.add(label);
    }
  }
  return floor;
}

interface EdgeLabel {
  /** The axis along which it stands: 0 for x, 1 for z. */
  readonly axis: 0 | 1;
  readonly value: number;
  /** Where the two edges are on the other axis. */
  readonly edges: readonly [low: number, high: number];
}

/** Stand each label on the edge nearer to the camera, or on the other one if it is cut off there. */
export function turnLabels(floor: Group, camera: PerspectiveCamera): void {
  camera.updateMatrixWorld();
  const { x, z } = camera.position;
  for (const label of floor.children) {
    if (!(label instanceof Sprite)) continue;
    const { axis, value, edges } = label.userData as EdgeLabel;
    const [low, high] = edges;
    const isHigh = (axis === 0 ? z : x) > (low + high) / 2;
    for (const edge of isHigh ? [high, low] : [low, high]) {
      if (axis === 0) label.position.set(value, 0, edge);
      else label.position.set(edge, 0, value);
      if (isWhole(label, camera, AT.copy(label.position))) break;
    }
  }
}

const AT = new Vector3();

/** Whether a label at a place in the world is not cut by the picture's edge; `at` is changed. */
function isWhole({ scale }: Sprite, camera: Camera, at: Vector3): boolean {
  const [across = 1, , , , , upwards = 1] = camera.projectionMatrix.elements;
  at.project(camera);
  return (
    Math.abs(at.x) + (scale.x / 2) * across < 1 &&
    Math.abs(at.y) + (scale.y / 2) * upwards < 1 &&
    at.z < 1
  );
}

export function disposeFloor(floor: Group): void {
  for (const part of floor.children) {
    if (part instanceof LineSegments) {
      part.geometry.dispose();
      part.material.dispose();
    }
    if (part instanceof Sprite) disposeLabel(part);
  }
}

export function disposeLabel(label: Sprite): void {
  label.material.map?.dispose();
  label.material.dispose();
}

const tidy = (value: number): string => String(Number(value.toPrecision(6)) + 0).replace("-", "−");

function lines(plan: FloorPlan, colour: string, opacity: number): LineSegments {
  const { step } = plan;
  const ends: number[] = [];
  const [minX, minZ] = plan.min;
  const [maxX, maxZ] = plan.max;
  for (let n = 0; n <= Math.round((maxX - minX) / step); n++) {
    ends.push(minX + n * step, 0, minZ, minX + n * step, 0, maxZ);
  }
  for (let n = 0; n <= Math.round((maxZ - minZ) / step); n++) {
    ends.push(minX, 0, minZ + n * step, maxX, 0, minZ + n * step);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(ends), 3));
  return new LineSegments(
    geometry,
    new LineBasicMaterial({ color: colour, transparent: true, opacity }),
  );
}

/** Size of a label relative to its distance from the camera. */
const WIDTH = 0.078;
const HEIGHT = 0.026;
const NARROWEST_PX = 192;

/** Words in the scene that face the camera; they are hidden where the picture's edge cuts them. */
export function label3d(text: string, palette: StagePalette): Sprite {
  const canvas = document.createElement("canvas");
  canvas.width = NARROWEST_PX;
  canvas.height = 64;
  const ink = canvas.getContext("2d");
  if (ink !== null) {
    const font = `44px ${palette.font}`;
    ink.font = font;
    // As wide as the words; a new width forgets the font.
    canvas.width = Math.max(NARROWEST_PX, Math.ceil(ink.measureText(text).width) + 8);
    ink.font = font;
    ink.fillStyle = palette.ink;
    ink.textAlign = "center";
    ink.textBaseline = "middle";
    ink.fillText(text, canvas.width / 2, 34);
  }
  const label = new Sprite(
    new SpriteMaterial({
      map: new CanvasTexture(canvas),
      transparent: true,
      depthWrite: false,
      // The same size near and far, so that it can be read.
      sizeAttenuation: false,
    }),
  );
  const width = (WIDTH * canvas.width) / NARROWEST_PX;
  label.scale.set(width, HEIGHT, 1);
  label.onBeforeRender = (_renderer, _scene, camera) => {
    const at = AT.setFromMatrixPosition(label.matrixWorld);
    label.material.opacity = isWhole(label, camera, at) ? 1 : 0;
  };
  return label;
}
