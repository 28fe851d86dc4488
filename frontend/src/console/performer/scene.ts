/**
 * A performer's body over flat or uneven ground, as it moves now; the camera goes along with it.
 * This module imports three.js: import it lazily.
 */
import type { BodyPose, BodySetup } from "@shared/api/performers";
import type { CameraSide, Figure, StagePalette } from "@shared/stage/figure";
import { momentOf } from "@shared/stage/motion";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { type LivePose, livePose } from "@shared/stage/skin/pose";
import { bodyOf, Space3d } from "@shared/stage/space3d";
import { directionOf, fitting } from "@shared/stage/views";
import { seconds } from "@shared/units";
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Vector3,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { floorOf, NOWHERE, type Reach, reaching } from "../avatarEditor/tryout/floor";
import { rolesFrom } from "../captures/bodyJoints";
import { makePlaced, type Placed, place, restValues } from "../cockpit/live3d/kinematics";
import { groundStrip } from "./groundStrip";

const NOW = seconds(0);
const VIEW_DEG = 28;
/** The camera goes along with what moves further than this from the middle of the picture. */
const NEAR_M = 0.02;
/** In front of the hips, where nobody has moved the camera: bodies face -z at first. */
const AHEAD = [0, -1] as const;

export class PerformerScene extends Space3d {
  /** Called after every picture. */
  onDrawn = (): void => {};
  readonly #controls: OrbitControls;
  #setup: BodySetup | null = null;
  #pose: LivePose | null = null;
  #placed: Placed | null = null;
  #ground: Group | null = null;
  #palette: StagePalette | null = null;
  #side: CameraSide = "corner";
  #isFollowing = true;
  #reach: Reach = NOWHERE;
  #along: readonly [x: number, z: number] = [0, 0];
  #stands: readonly [x: number, z: number] = [0, 0];

  /** Throws if the browser has no WebGL. */
  constructor(canvas: HTMLCanvasElement) {
    super(new PerspectiveCamera(VIEW_DEG, 1, 0.05, 200), { canvas });
    this.#controls = new OrbitControls(this.camera, canvas);
    this.#controls.enableDamping = false;
    this.#controls.maxPolarAngle = 0.495 * Math.PI;
    this.#controls.addEventListener("change", () => this.requestPicture());
  }

  /** Make the body anew, in the pose that was shown last; without a model it is a skeleton. */
  prepare(setup: BodySetup, palette: StagePalette, model: BodyModel | null): void {
    const before = this.#pose?.values;
    const isFirst = this.#setup === null;
    this.#setup = setup;
    this.#palette = palette;
    const placed = makePlaced(setup.joints.length);
    const pose = livePose(setup.joints, setup.parents);
    pose.values.set(restValues(setup));
    place(setup, pose.values, placed);
    const figure = figureOf(setup, placed, pose, model);
    // A body is measured at rest, then put where it was.
    const body = bodyOf(figure, palette);
    if (before?.length === pose.values.length) {
      pose.values.set(before);
      place(setup, pose.values, placed);
    }
    this.#pose = pose;
    this.#placed = placed;
    this.standBodies([body]);
    this.#layGround(setup, palette);
    this.scene.background = new Color(palette.ground);
    this.layFloor(floorOf(1, 0, this.#reach), palette);
    body.show(NOW);
    if (isFirst) this.placeCamera(this.#side);
    this.requestPicture();
  }

  show({ values }: BodyPose): void {
    const [setup, pose, placed] = [this.#setup, this.#pose, this.#placed];
    // A picture in any case: the server waits for the answer that one was drawn.
    this.requestPicture();
    if (setup === null || pose === null || placed === null) return;
    if (values.length !== pose.values.length) return;
    pose.values.set(values);
    place(setup, values, placed);
    for (const body of this.bodies) body.show(NOW);
    this.#goAlong([values[0] ?? 0, values[2] ?? 0]);
  }

  setFollowing(isFollowing: boolean): void {
    this.#isFollowing = isFollowing;
    if (isFollowing) this.#lookAt(this.#stands);
  }

  zoom(factor: number): void {
    const { target } = this.#controls;
    this.camera.position.sub(target).multiplyScalar(factor).add(target);
    this.#controls.update();
  }

  placeCamera(from: CameraSide): void {
    this.#side = from;
    this.#along = [0, 0];
    const away = directionOf(from, AHEAD);
    const view = fitting(floorOf(1, 0), away, this.camera);
    this.#controls.target.copy(view.middle);
    this.camera.position.copy(view.middle).addScaledVector(away, view.distance);
    this.#controls.update();
    this.#lookAt(this.#stands);
    this.requestPicture();
  }

  override dispose(): void {
    this.#clearGround();
    this.#controls.dispose();
    super.dispose();
  }

  protected override resized(before: number): void {
    if (before === 1) this.placeCamera(this.#side);
  }

  protected override drawn(): void {
    this.onDrawn();
  }

  #goAlong(stands: readonly [x: number, z: number]): void {
    if (!stands.every(Number.isFinite)) return;
    this.#stands = stands;
    const reach = reaching(this.#reach, stands);
    if (reach !== this.#reach && this.#palette !== null) {
      this.#reach = reach;
      this.layFloor(floorOf(1, 0, reach), this.#palette);
    }
    // A body that sways does not sway the picture.
    const isNear = ([0, 1] as const).every((i) => Math.abs(stands[i] - this.#along[i]) < NEAR_M);
    if (this.#isFollowing && !isNear) this.#lookAt(stands);
  }

  /** Move the camera and what it looks at over the floor; the direction stays. */
  #lookAt(stands: readonly [x: number, z: number]): void {
    const by = new Vector3(stands[0] - this.#along[0], 0, stands[1] - this.#along[1]);
    this.#along = stands;
    this.#controls.target.add(by);
    this.camera.position.add(by);
    this.#controls.update();
  }

  #layGround(setup: BodySetup, palette: StagePalette): void {
    this.#clearGround();
    const strip = groundStrip(setup);
    if (strip === null) return;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(strip, 3));
    geometry.computeVertexNormals();
    const look = { color: palette.lineStrong, transparent: true, opacity: 0.45, side: DoubleSide };
    const lines = new LineBasicMaterial({ color: palette.lineStrong });
    this.#ground = new Group();
    this.#ground.add(
      new Mesh(geometry, new MeshLambertMaterial(look)),
      new LineSegments(new EdgesGeometry(geometry, 5), lines),
    );
    this.scene.add(this.#ground);
  }

  #clearGround(): void {
    if (this.#ground === null) return;
    this.scene.remove(this.#ground);
    for (const one of this.#ground.children as (Mesh | LineSegments)[]) {
      one.geometry.dispose();
      for (const material of [one.material].flat()) material.dispose();
    }
    this.#ground = null;
  }
}

function figureOf(
  setup: BodySetup,
  placed: Placed,
  pose: LivePose,
  model: BodyModel | null,
): Figure {
  return {
    key: "performer",
    motion: momentOf(setup, placed.positions),
    tone: "solid",
    roles: rolesFrom(setup.joints, setup.joint_map),
    ...(model === null || setup.stature_m === null
      ? {}
      : { worn: { model, statureM: setup.stature_m, pose } }),
  };
}
