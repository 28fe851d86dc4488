/**
 * Soft shadows below hips and feet, which show where bodies stand; with their reflections in one
 * draw call. This module imports three.js.
 */
import {
  CanvasTexture,
  DynamicDrawUsage,
  InstancedMesh,
  Matrix4,
  MeshBasicMaterial,
  PlaneGeometry,
} from "three";
import type { Body3d } from "./bodies3d";
import type { Mirror } from "./mirror";

interface Cast {
  readonly part: string;
  readonly radiusM: number;
  /** From this height of the part's joint on there is no shadow, metres. */
  readonly untilM: number;
}
const CASTS: readonly Cast[] = [
  { part: "Hips", radiusM: 0.34, untilM: 3 },
  { part: "LeftFoot", radiusM: 0.15, untilM: 0.45 },
  { part: "RightFoot", radiusM: 0.15, untilM: 0.45 },
  { part: "LeftToes", radiusM: 0.11, untilM: 0.4 },
  { part: "RightToes", radiusM: 0.11, untilM: 0.4 },
];
/** Above the floor, and above the start square. */
const HEIGHT_M = 0.007;
/** The participant's, and a companion's. */
const MOST_BODIES = 2;

export class Shadows {
  readonly mesh: InstancedMesh<PlaneGeometry, MeshBasicMaterial>;
  readonly #mirror: Mirror | null;
  readonly #matrix = new Matrix4();

  constructor(mirror: Mirror | null) {
    this.#mirror = mirror;
    const material = new MeshBasicMaterial({
      map: blot(),
      color: "#000000",
      transparent: true,
      depthWrite: false,
      polygonOffset: true,
      polygonOffsetFactor: -1,
      polygonOffsetUnits: -1,
    });
    const plane = new PlaneGeometry(2, 2).rotateX(-Math.PI / 2);
    const most = MOST_BODIES * CASTS.length * (mirror === null ? 1 : 2);
    this.mesh = new InstancedMesh(plane, material, most);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  /** Below these bodies, of which those count that are seen. */
  show(bodies: readonly (Body3d | null)[]): void {
    let count = 0;
    for (const body of bodies) {
      if (body?.group.visible === true) count = this.#cast(body, count);
    }
    this.mesh.count = count;
    this.mesh.visible = count > 0;
    this.mesh.instanceMatrix.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.map?.dispose();
    this.mesh.material.dispose();
    this.mesh.dispose();
  }

  /** Set a body's shadows from a number on; returns the number after its last one. */
  #cast({ parts: { places }, partNames }: Body3d, from: number): number {
    let at = from;
    for (const { part, radiusM, untilM } of CASTS) {
      const joint = 3 * partNames.indexOf(part);
      const [x = 0, y = 0, z = 0] = [places[joint], places[joint + 1], places[joint + 2]];
      const size = joint < 0 ? 0 : radiusM * Math.max(0, 1 - y / untilM);
      this.#set(at++, x, z, size);
      if (this.#mirror !== null) this.#set(at++, x, 2 * this.#mirror.planeZM - z, size);
    }
    return at;
  }

  #set(at: number, x: number, z: number, size: number): void {
    this.#matrix.makeScale(size, 1, size).setPosition(x, HEIGHT_M, z);
    this.mesh.setMatrixAt(at, this.#matrix);
  }
}

function blot(): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = 128;
  canvas.height = 128;
  const ink = canvas.getContext("2d");
  if (ink !== null) {
    const fading = ink.createRadialGradient(64, 64, 0, 64, 64, 63);
    for (const [at, share] of [
      [0, 0.34],
      [0.35, 0.24],
      [0.7, 0.08],
      [1, 0],
    ] as const) {
      fading.addColorStop(at, `rgba(0, 0, 0, ${share})`);
    }
    ink.fillStyle = fading;
    ink.fillRect(0, 0, 128, 128);
  }
  return new CanvasTexture(canvas);
}
