/** The floor of the scene: lines at regular distances in metres, labelled along two edges. */
import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Group,
  LineBasicMaterial,
  LineSegments,
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
      const margin = 0.22 * plan.step;
      const label = label3d(text, palette);
      if (axis === 0) label.position.set(value, 0, plan.max[1] + margin);
      else label.position.set(plan.max[0] + 1.4 * margin, 0, value);
      floor.add(label);
    }
  }
  return floor;
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
  const at = new Vector3();
  label.onBeforeRender = (_renderer, _scene, camera) => {
    const [across = 1, , , , , upwards = 1] = camera.projectionMatrix.elements;
    at.setFromMatrixPosition(label.matrixWorld).project(camera);
    const isWhole =
      Math.abs(at.x) + (width / 2) * across < 1 && Math.abs(at.y) + (HEIGHT / 2) * upwards < 1;
    label.material.opacity = isWhole ? 1 : 0;
  };
  return label;
}
