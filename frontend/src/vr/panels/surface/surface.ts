/** One panel in the scene: a drawn surface, the target pointed at, the end of the ray. */
import { fromAxes, type Quaternion, type Vector } from "@shared/rotations";
import {
  CanvasTexture,
  Color,
  CylinderGeometry,
  Group,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  ShaderMaterial,
  SRGBColorSpace,
  Vector2,
  Vector3,
} from "three";
import { PANELS_ORDER } from "../../world";
import { type Layout, layOut, PANEL_DMM, type Rectangle, type Target } from "./layout";
import { canvasMeasure, paint } from "./paint";
import type { Board, Hit, Ray } from "./pointing";
import type { PanelScreen } from "./screen";
import type { Measure } from "./wrap";

/** Two pixels a dmm are 35 a degree; the lenses of a Quest 3 show 25. */
const PIXELS_PER_DMM = 2;

/** As far as a panel should be to be looked at without effort; nearer before a wall. */
export const PANEL_DISTANCE_M = 1.75;

/** Far enough below the eyes that the neck rests, near enough that the room stays in view. */
const BELOW_EYES_RAD = (7 * Math.PI) / 180;

/** Below the mirror image of the face and the arms. */
const LOW_RAD = (26 * Math.PI) / 180;

/** In front of the room, and of the curtain that hides it. */
const RENDER_ORDER = PANELS_ORDER + 1;

/** Readable whatever stands in the way, also what only the curtain hides. */
const ON_TOP = {
  transparent: true,
  depthTest: false,
  depthWrite: false,
  toneMapped: false,
} as const;

export class PanelSurface {
  readonly object = new Group();
  readonly measure: Measure;
  readonly #context: CanvasRenderingContext2D;
  readonly #texture: CanvasTexture;
  readonly #panel: Mesh;
  readonly #highlight = new RoundedMark(0.14, "#8fdce2", "#8fdce2");
  readonly #cursor = new RoundedMark(1, "#ffffff", "#10191b");
  readonly #beam: Mesh;
  #layout: Layout | null = null;
  #hovered: string | null = null;
  #distanceM = PANEL_DISTANCE_M;

  constructor(canvas: HTMLCanvasElement = document.createElement("canvas")) {
    canvas.width = PANEL_DMM.width * PIXELS_PER_DMM;
    canvas.height = PANEL_DMM.height * PIXELS_PER_DMM;
    const context = canvas.getContext("2d");
    if (context === null) throw new Error("This browser draws no text: it has no 2D canvas.");
    this.#context = context;
    this.measure = canvasMeasure(context);
    this.#texture = new CanvasTexture(canvas);
    this.#texture.colorSpace = SRGBColorSpace;
    this.#texture.anisotropy = 8;
    this.#texture.minFilter = LinearMipmapLinearFilter;
    this.#texture.magFilter = LinearFilter;
    const drawn = new MeshBasicMaterial({ ...ON_TOP, map: this.#texture });
    this.#panel = new Mesh(new PlaneGeometry(1, 1), drawn);
    const light = new MeshBasicMaterial({ ...ON_TOP, color: "#e8f4f4", opacity: 0.5 });
    this.#beam = new Mesh(new CylinderGeometry(0.0012, 0.0022, 1, 6), light);
    this.object.name = "panel";
    this.#panel.renderOrder = RENDER_ORDER;
    this.#highlight.mesh.renderOrder = RENDER_ORDER + 1;
    this.#cursor.mesh.renderOrder = RENDER_ORDER + 3;
    this.#beam.renderOrder = RENDER_ORDER + 2;
    this.object.add(this.#panel, this.#highlight.mesh, this.#cursor.mesh);
    this.object.visible = false;
    this.#beam.visible = false;
  }

  /** The ray is not part of the panel: it begins at a hand. */
  get beam(): Mesh {
    return this.#beam;
  }

  get board(): Board {
    const { position, quaternion } = this.object;
    const layout = this.#layout ?? { widthDmm: 0, heightDmm: 0 };
    const scale = this.#distanceM / 1000;
    return {
      centreM: [position.x, position.y, position.z],
      rotation: [quaternion.w, quaternion.x, quaternion.y, quaternion.z],
      widthM: layout.widthDmm * scale,
      heightM: layout.heightDmm * scale,
    };
  }

  show(screen: PanelScreen | null): void {
    this.object.visible = screen !== null;
    if (screen === null) {
      this.#beam.visible = false;
      return;
    }
    this.#layout = layOut(screen, this.measure);
    paint(this.#context, this.#layout);
    this.#texture.needsUpdate = true;
    const { widthDmm, heightDmm } = this.#layout;
    this.#panel.scale.set(widthDmm, heightDmm, 1);
    // A low panel uses the upper part of the canvas.
    const { width, height } = this.#context.canvas;
    const share = Math.min(1, (heightDmm / widthDmm) * (width / height));
    this.#texture.repeat.set(1, share);
    this.#texture.offset.set(0, 1 - share);
    this.#hovered = null;
    this.#highlight.mesh.visible = false;
  }

  /** Stand in front of somebody's eyes, upright towards them. */
  place(eyesM: Vector, yawRad: number, distanceM = PANEL_DISTANCE_M, isLow = false): void {
    this.#distanceM = distanceM;
    const below = isLow ? LOW_RAD : BELOW_EYES_RAD;
    const back: Vector = [
      Math.sin(yawRad) * Math.cos(below),
      Math.sin(below),
      Math.cos(yawRad) * Math.cos(below),
    ];
    const rotation = facing(back, yawRad);
    const [x, y, z] = eyesM;
    this.object.position.set(
      x - back[0] * distanceM,
      y - back[1] * distanceM,
      z - back[2] * distanceM,
    );
    this.object.quaternion.set(rotation[1], rotation[2], rotation[3], rotation[0]);
    this.object.scale.setScalar(distanceM / 1000);
  }

  /** The target under a hit, if there is one. */
  targetAt(hit: Hit | null): Target | null {
    const layout = this.#layout;
    if (hit === null || layout === null) return null;
    const x = hit.across * layout.widthDmm;
    const y = hit.down * layout.heightDmm;
    const isIn = ({ at }: Target) =>
      x >= at.x && x <= at.x + at.width && y >= at.y && y <= at.y + at.height;
    return layout.targets.find(isIn) ?? null;
  }

  /** The middle of every target in the room. */
  get targetsM(): readonly { readonly target: string; readonly atM: Vector }[] {
    const layout = this.#layout;
    if (layout === null || !this.object.visible) return [];
    this.object.updateMatrixWorld(true);
    return layout.targets.map(({ target, at }) => {
      const x = at.x + at.width / 2 - layout.widthDmm / 2;
      const y = layout.heightDmm / 2 - at.y - at.height / 2;
      const { x: wx, y: wy, z: wz } = this.object.localToWorld(new Vector3(x, y, 0));
      return { target, atM: [wx, wy, wz] };
    });
  }

  /** The target pointed at, and the ray that points; null if none does. */
  point(target: Target | null, hit: Hit | null, ray: Ray | null): void {
    const layout = this.#layout;
    if (layout === null) return;
    if (target?.target !== this.#hovered) {
      this.#hovered = target?.target ?? null;
      this.#highlight.mesh.visible = target !== null;
      if (target !== null) this.#highlight.fit(layout, grown(target.at, 3), 17, 4);
    }
    this.#cursor.mesh.visible = hit !== null;
    if (hit !== null) {
      const [x, y] = [hit.across * layout.widthDmm, hit.down * layout.heightDmm];
      this.#cursor.fit(layout, { x: x - 8, y: y - 8, width: 16, height: 16 }, 8, 4);
    }
    this.#beam.visible = ray !== null && hit !== null;
    if (ray !== null && hit !== null) aim(this.#beam, ray, hit.distanceM);
  }

  dispose(): void {
    this.#texture.dispose();
    for (const mesh of [this.#panel, this.#highlight.mesh, this.#cursor.mesh, this.#beam]) {
      mesh.geometry.dispose();
      if (!Array.isArray(mesh.material)) mesh.material.dispose();
    }
  }
}

const grown = ({ x, y, width, height }: Rectangle, by: number): Rectangle => ({
  x: x - by,
  y: y - by,
  width: width + 2 * by,
  height: height + 2 * by,
});

/** The rotation of something whose face looks along `back`, without roll. */
function facing(back: Vector, yawRad: number): Quaternion {
  const right: Vector = [Math.cos(yawRad), 0, -Math.sin(yawRad)];
  const up: Vector = [
    back[1] * right[2] - back[2] * right[1],
    back[2] * right[0] - back[0] * right[2],
    back[0] * right[1] - back[1] * right[0],
  ];
  return fromAxes(right, up, back);
}

const AXIS = new Vector3(0, 1, 0);
const TOWARDS = new Vector3();

/** A ray from just before the hand to where it meets the panel. */
function aim(beam: Mesh, { originM, direction }: Ray, distanceM: number): void {
  const from = Math.min(0.06, distanceM);
  const lengthM = distanceM - from;
  const middle = from + lengthM / 2;
  beam.position.set(
    originM[0] + direction[0] * middle,
    originM[1] + direction[1] * middle,
    originM[2] + direction[2] * middle,
  );
  beam.scale.set(1, lengthM, 1);
  // The cylinder's axis is y.
  TOWARDS.fromArray(direction).normalize();
  beam.quaternion.setFromUnitVectors(AXIS, TOWARDS);
}

/**
 * A rounded rectangle or disc with an edge, drawn from its distance field: sharp at every size and
 * without a texture that would have to be uploaded whenever the ray moves.
 */
class RoundedMark {
  readonly mesh: Mesh<PlaneGeometry, ShaderMaterial>;
  readonly #size = new Vector2(1, 1);
  readonly #radius = { value: 1 };
  readonly #edge = { value: 1 };

  constructor(fill: number, colour: string, edgeColour: string) {
    const uniforms = {
      size: { value: this.#size },
      radius: this.#radius,
      edge: this.#edge,
      fill: { value: fill },
      colour: { value: new Color(colour) },
      edgeColour: { value: new Color(edgeColour) },
    };
    const material = new ShaderMaterial({
      ...ON_TOP,
      uniforms,
      vertexShader: VERTICES,
      fragmentShader: FRAGMENTS,
    });
    this.mesh = new Mesh(new PlaneGeometry(1, 1), material);
    this.mesh.visible = false;
  }

  /** Lie over a rectangle of a layout, just before its surface. */
  fit({ widthDmm, heightDmm }: Layout, at: Rectangle, radiusDmm: number, edgeDmm: number): void {
    const { x, y, width, height } = at;
    this.mesh.position.set(x + width / 2 - widthDmm / 2, heightDmm / 2 - y - height / 2, 2);
    this.mesh.scale.set(width, height, 1);
    this.#size.set(width, height);
    this.#radius.value = radiusDmm;
    this.#edge.value = edgeDmm;
  }
}

const VERTICES = `
  varying vec2 at;
  uniform vec2 size;
  void main() {
    at = position.xy * size;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const FRAGMENTS = `
  varying vec2 at;
  uniform vec2 size;
  uniform float radius, edge, fill;
  uniform vec3 colour, edgeColour;
  void main() {
    vec2 corner = abs(at) - 0.5 * size + radius;
    float outside = length(max(corner, 0.0)) + min(max(corner.x, corner.y), 0.0) - radius;
    float soft = max(fwidth(outside), 1e-4);
    float inside = 1.0 - smoothstep(-soft, soft, outside);
    float onEdge = smoothstep(-edge - soft, -edge + soft, outside);
    gl_FragColor = vec4(mix(colour, edgeColour, onEdge), inside * mix(fill, 1.0, onEdge));
    #include <colorspace_fragment>
  }`;
