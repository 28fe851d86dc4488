/**
 * Bodies as they are simulated: their collision shapes over a floor, a box, and the force at a part.
 * This module imports three.js: import it lazily.
 */

import type { CameraSide, StagePalette } from "@shared/stage/figure";
import { disposeLabel, label3d } from "@shared/stage/floor3d";
import { Space3d } from "@shared/stage/space3d";
import { directionOf, fitting } from "@shared/stage/views";
import {
  BoxGeometry,
  type BufferGeometry,
  CapsuleGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  type Object3D,
  PerspectiveCamera,
  Plane,
  Quaternion,
  Raycaster,
  SphereGeometry,
  type Sprite,
  Vector2,
  Vector3,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { ConvexGeometry } from "three/addons/geometries/ConvexGeometry.js";
import { floorOf, NOWHERE, type Reach, reaching } from "./floor";
import type { Vector } from "./physics/commands";
import { BOX } from "./physics/looseBox";
import type { Shape } from "./physics/shapes";
import type { Progress } from "./physics/tryout";

/** Distance between two bodies side by side, metres: room for spread arms. */
const APART_M = 1.9;
const VIEW_DEG = 28;
/** Nearer than where everything around the bodies would be in view. */
const NEARER = 0.84;
const NEWTONS_A_METRE = 250;
/** Length of an arrow's tip, metres. */
const TIP_M = 0.09;
/** The camera goes along with what moves further than this from the middle of the picture. */
const NEAR_M = 0.02;
/** The height of a body's name, metres. */
const LABEL_M = 2.15;
/** How much of its colours the second body keeps, so that the two are told apart. */
const OWN_COLOUR = 0.45;
const UP = new Vector3(0, 1, 0);
const SEE_THROUGH = 0.35;
const NO_FORCE: Vector = [0, 0, 0];

/** A point of a part that the pointer has taken hold of. */
export interface Grip {
  readonly part: string;
  /** In the part's own frame. */
  readonly pointM: Vector;
  /** The body whose part it is. */
  readonly row: number;
}

interface StandingBody {
  readonly group: Group;
  /** The row of its hips among the bodies of its model. */
  readonly hips: number;
  readonly parts: readonly { readonly body: number; readonly group: Group }[];
  readonly arrow: Arrow;
  readonly label: Sprite | null;
}

export class TryoutScene extends Space3d {
  readonly #controls: OrbitControls;
  readonly #ray = new Raycaster();
  #standing: readonly StandingBody[] = [];
  #chosen: string | null = null;
  #palette: StagePalette | null = null;
  #side: CameraSide = "corner";
  #force: Vector = NO_FORCE;
  #isPull = false;
  #isFollowing = false;
  #reach: Reach = NOWHERE;
  /** Where the hips of the first body are on the floor; null before they are known. */
  #place: readonly [x: number, z: number] | null = null;
  /** Where the camera's target is above, as far as it goes along. */
  #along: readonly [x: number, z: number] = [0, 0];

  /** Throws if the browser has no WebGL. */
  constructor(canvas: HTMLCanvasElement) {
    super(new PerspectiveCamera(VIEW_DEG, 1, 0.05, 100), { canvas });
    this.#controls = new OrbitControls(this.camera, canvas);
    this.#controls.enableDamping = false;
    this.#controls.maxPolarAngle = 0.495 * Math.PI;
    this.#controls.addEventListener("change", () => this.requestPicture());
  }

  /** Stand the bodies on the floor, side by side, with their names. */
  prepare(
    bodies: readonly (readonly Shape[])[],
    names: readonly string[],
    palette: StagePalette,
  ): void {
    const isOther = bodies.length !== this.#standing.length || palette !== this.#palette;
    this.#clear();
    this.#palette = palette;
    this.#standing = bodies.map((shapes, row) => {
      const standing = stand(shapes, row, bodies.length, palette, names[row] ?? "");
      standing.group.position.x = (row - (bodies.length - 1) / 2) * APART_M;
      this.scene.add(standing.group);
      return standing;
    });
    this.scene.background = new Color(palette.ground);
    this.layFloor(floorOf(bodies.length, APART_M, this.#reach), palette);
    this.choose(this.#chosen);
    if (isOther) this.placeCamera(this.#side);
  }

  /** Move the bodies to where they are now. */
  show(progress: readonly Progress[]): void {
    this.#standing.forEach(({ parts, arrow, label, hips }, row) => {
      const now = progress[row];
      if (now === undefined) return;
      for (const { body, group } of parts) {
        group.position.fromArray(now.places, 7 * body);
        const [w, x, y, z] = now.places.subarray(7 * body + 3, 7 * body + 7);
        group.quaternion.set(x as number, y as number, z as number, w as number);
      }
      const [x, z] = [now.places[7 * hips], now.places[7 * hips + 2]];
      if (Number.isFinite(x) && Number.isFinite(z)) {
        label?.position.set(x as number, LABEL_M, z as number);
      }
      this.#point(arrow, now.pushedAtM);
    });
    this.#goAlong(progress[0]);
    this.requestPicture();
  }

  /** Whether the camera goes along with the first body. */
  setFollowing(isFollowing: boolean): void {
    this.#isFollowing = isFollowing;
    this.#moveCamera();
  }

  /** Look again from where it was chosen, at where the bodies are. */
  resetCamera(): void {
    this.placeCamera(this.#side);
  }

  /** How far the first body is from the middle of the floor, metres; null before it is known. */
  get distanceM(): number | null {
    return this.#place === null ? null : Math.hypot(...this.#place);
  }

  /**
   * The force that acts wherever somebody pushes or pulls; the arrow has its direction and strength.
   * That of a push ends where it acts, that of a pull begins there.
   */
  setForce(force: Vector, isPull: boolean): void {
    this.#force = force;
    this.#isPull = isPull;
  }

  /** Mark the parts of an axis; null for none. */
  choose(part: string | null): void {
    this.#chosen = part;
    for (const { group } of this.#standing) {
      group.traverse((one) => {
        if (!isShape(one) || this.#palette === null) return;
        const isChosen = one.userData.part === part;
        const { material } = one;
        material.emissive.set(isChosen ? this.#palette.highlight : "#000000");
        material.emissiveIntensity = isChosen ? 0.55 : 0;
      });
    }
    this.requestPicture();
  }

  placeCamera(from: CameraSide): void {
    this.#side = from;
    this.#along = [0, 0];
    const away = directionOf(from, [0, -1]);
    const view = fitting(floorOf(Math.max(this.#standing.length, 1), APART_M), away, this.camera);
    this.#controls.target.copy(view.middle);
    this.camera.position.copy(view.middle).addScaledVector(away, NEARER * view.distance);
    this.#controls.update();
    this.#lookAt(this.#place ?? [0, 0]);
    this.requestPicture();
  }

  /** Take hold of what is under the pointer; null if it is not a part of a body. */
  grip(xPx: number, yPx: number): Grip | null {
    this.#aim(xPx, yPx);
    const groups = this.#standing.map(({ group }) => group);
    const hit = this.#ray.intersectObjects(groups, true).find(({ object }) => isShape(object));
    const holder = hit?.object.parent;
    const part = hit?.object.userData.part as string | undefined;
    if (hit === undefined || part === undefined || part === BOX || !holder) return null;
    const local = holder.worldToLocal(hit.point.clone());
    return { part, pointM: [local.x, local.y, local.z], row: hit.object.userData.row as number };
  }

  /** Whether the camera may be moved: not while somebody pulls at a part. */
  set isCameraFree(isFree: boolean) {
    this.#controls.enabled = isFree;
  }

  /**
   * Where the pointer is, in the world of a body: on the plane through a point (of that world) that
   * faces the camera.
   */
  pointerAt(xPx: number, yPx: number, through: Vector, row: number): Vector | null {
    this.#aim(xPx, yPx);
    const offset = this.#standing[row]?.group.position.x ?? 0;
    const point = new Vector3(through[0] + offset, through[1], through[2]);
    const plane = new Plane().setFromNormalAndCoplanarPoint(
      this.camera.getWorldDirection(new Vector3()),
      point,
    );
    const at = this.#ray.ray.intersectPlane(plane, new Vector3());
    return at === null ? null : [at.x - offset, at.y, at.z];
  }

  /** Where a point of a body's world is in the picture, px. */
  onScreen([x, y, z]: Vector, row: number): readonly [number, number] {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    const offset = this.#standing[row]?.group.position.x ?? 0;
    const at = new Vector3(x + offset, y, z).project(this.camera);
    return [(0.5 + at.x / 2) * clientWidth, (0.5 - at.y / 2) * clientHeight];
  }

  override dispose(): void {
    this.#clear();
    this.#controls.dispose();
    super.dispose();
  }

  protected override resized(before: number): void {
    if (before === 1) this.placeCamera(this.#side);
  }

  #goAlong(now: Progress | undefined): void {
    const standing = this.#standing[0];
    if (now === undefined || standing === undefined) return;
    const at = 7 * standing.hips;
    const place = [now.places[at] as number, now.places[at + 2] as number] as const;
    if (!place.every(Number.isFinite)) return;
    this.#place = place;
    const reach = reaching(this.#reach, place);
    if (reach !== this.#reach && this.#palette !== null) {
      this.#reach = reach;
      this.layFloor(floorOf(this.#standing.length, APART_M, reach), this.#palette);
    }
    this.#moveCamera();
  }

  #moveCamera(): void {
    const place = this.#place;
    if (!this.#isFollowing || place === null) return;
    // A body that sways does not sway the picture.
    const isNear = ([0, 1] as const).every((i) => Math.abs(place[i] - this.#along[i]) < NEAR_M);
    if (!isNear) this.#lookAt(place);
  }

  /** Move the camera and what it looks at over the floor; the direction stays. */
  #lookAt(place: readonly [x: number, z: number]): void {
    const by = new Vector3(place[0] - this.#along[0], 0, place[1] - this.#along[1]);
    this.#along = place;
    this.#controls.target.add(by);
    this.camera.position.add(by);
    this.#controls.update();
  }

  #aim(xPx: number, yPx: number): void {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    const at = new Vector2((2 * xPx) / clientWidth - 1, 1 - (2 * yPx) / clientHeight);
    this.#ray.setFromCamera(at, this.camera);
  }

  #point({ group, shaft, tip }: Arrow, at: Vector | null): void {
    const force = new Vector3(...this.#force);
    const strength = force.length();
    group.visible = at !== null && strength > 0.5;
    if (at === null || !group.visible) return;
    const length = Math.max(strength / NEWTONS_A_METRE, 1.5 * TIP_M);
    force.divideScalar(strength);
    group.position.set(...at);
    if (!this.#isPull) group.position.addScaledVector(force, -length);
    group.quaternion.setFromUnitVectors(UP, force);
    shaft.scale.y = length - TIP_M;
    shaft.position.y = (length - TIP_M) / 2;
    tip.position.y = length - TIP_M / 2;
  }

  #clear(): void {
    for (const { group, arrow, label } of this.#standing) {
      this.scene.remove(group);
      group.traverse((one) => {
        if (!isShape(one)) return;
        one.geometry.dispose();
        one.material.dispose();
      });
      for (const one of [arrow.shaft, arrow.tip]) {
        one.geometry.dispose();
        one.material.dispose();
      }
      if (label !== null) disposeLabel(label);
    }
    this.#standing = [];
  }
}

function stand(
  shapes: readonly Shape[],
  row: number,
  count: number,
  palette: StagePalette,
  name: string,
): StandingBody {
  const group = new Group();
  const parts = [...new Set(shapes.map(({ body }) => body))].map((body) => {
    const holder = new Group();
    for (const shape of shapes.filter((one) => one.body === body)) {
      holder.add(meshOf(shape, row, palette));
    }
    group.add(holder);
    return { body, group: holder };
  });
  const arrow = makeArrow(palette.highlight);
  group.add(arrow.group);
  const label = count > 1 ? label3d(name, palette) : null;
  if (label !== null) {
    label.position.set(0, LABEL_M, 0);
    group.add(label);
  }
  const hips = shapes.find(({ part }) => part === "Hips")?.body ?? 0;
  return { group, hips, parts, arrow, label };
}

/** An arrow along y, of length one before it is pointed; drawn on top, as it may end inside a part. */
interface Arrow {
  readonly group: Group;
  readonly shaft: Mesh<CylinderGeometry, MeshBasicMaterial>;
  readonly tip: Mesh<ConeGeometry, MeshBasicMaterial>;
}

function makeArrow(colour: string): Arrow {
  const look = { color: colour, depthTest: false, transparent: true, opacity: 0.9 };
  const shaft = new Mesh(new CylinderGeometry(0.012, 0.012, 1, 10), new MeshBasicMaterial(look));
  const tip = new Mesh(new ConeGeometry(0.036, TIP_M, 14), new MeshBasicMaterial(look));
  const group = new Group();
  group.add(shaft, tip);
  group.visible = false;
  shaft.renderOrder = 2;
  tip.renderOrder = 2;
  return { group, shaft, tip };
}

type ShapeMesh = Mesh<BufferGeometry, MeshLambertMaterial>;
const isShape = (one: Object3D): one is ShapeMesh =>
  one instanceof Mesh && typeof one.userData.part === "string";

function meshOf(shape: Shape, row: number, palette: StagePalette): ShapeMesh {
  const material = new MeshLambertMaterial({ color: colourOf(shape.part, row, palette) });
  if (!shape.collides) {
    material.transparent = true;
    material.opacity = SEE_THROUGH;
  }
  const mesh = new Mesh(geometryOf(shape), material);
  mesh.position.set(...shape.positionM);
  const [w, x, y, z] = shape.rotation;
  mesh.quaternion.set(x, y, z, w);
  // MuJoCo's capsules lie along z, those of three.js along y.
  if (shape.kind === "capsule") mesh.quaternion.multiply(Z_FROM_Y);
  mesh.userData = { part: shape.part, row };
  return mesh;
}

const Z_FROM_Y = new Quaternion().setFromAxisAngle(new Vector3(1, 0, 0), Math.PI / 2);

/** The colours of the sides; those of the second body fade towards the ground. */
function colourOf(part: string, row: number, palette: StagePalette): Color {
  if (part === BOX) return new Color(palette.highlight);
  const own = new Color(
    part.startsWith("Left")
      ? palette.left
      : part.startsWith("Right")
        ? palette.right
        : palette.trunk,
  );
  return row === 0 ? own : own.lerp(new Color(palette.ground), 1 - OWN_COLOUR);
}

function geometryOf({ kind, sizeM, cornersM }: Shape): BufferGeometry {
  const [a, b, c] = sizeM;
  if (kind === "sphere") return new SphereGeometry(a, 16, 12);
  if (kind === "capsule") return new CapsuleGeometry(a, 2 * b, 6, 14);
  if (kind === "box") return new BoxGeometry(2 * a, 2 * b, 2 * c);
  const corners: Vector3[] = [];
  for (let at = 0; at < cornersM.length; at += 3)
    corners.push(new Vector3().fromArray(cornersM, at));
  return new ConvexGeometry(corners);
}
