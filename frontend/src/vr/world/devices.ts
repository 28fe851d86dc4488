/**
 * What the participant holds and wears, shown until there is a body; with reflections. This module
 * imports three.js.
 */
import type { Place } from "@shared/avatar/hips";
import {
  type BufferGeometry,
  CapsuleGeometry,
  CylinderGeometry,
  DynamicDrawUsage,
  Group,
  InstancedMesh,
  Matrix4,
  MeshLambertMaterial,
  Quaternion,
  SphereGeometry,
  TorusGeometry,
  Vector3,
} from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import type { Mirror } from "./mirror";

export type DeviceKind = "controller" | "hand" | "tracker";

export interface Device {
  readonly kind: DeviceKind;
  /** For a controller: its grip space. */
  readonly place: Place;
}

const MOST = 8;

export class Devices {
  readonly group = new Group();
  readonly #mirror: Mirror | null;
  readonly #meshes: Readonly<Record<DeviceKind, InstancedMesh>>;
  readonly #material = new MeshLambertMaterial({ color: "#4a5258" });
  readonly #matrix = new Matrix4();
  readonly #at = new Vector3();
  readonly #turn = new Quaternion();

  constructor(mirror: Mirror | null) {
    this.#mirror = mirror;
    const make = (shape: BufferGeometry) => {
      const mesh = new InstancedMesh(shape, this.#material, 2 * MOST);
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      mesh.frustumCulled = false;
      mesh.count = 0;
      mesh.visible = false;
      this.group.add(mesh);
      return mesh;
    };
    this.#meshes = { controller: make(controller()), hand: make(hand()), tracker: make(tracker()) };
  }

  show(devices: readonly Device[]): void {
    for (const mesh of [this.#meshes.controller, this.#meshes.hand, this.#meshes.tracker]) {
      mesh.count = 0;
      mesh.visible = false;
    }
    for (const { kind, place } of devices) this.#add(this.#meshes[kind], place);
  }

  dispose(): void {
    for (const mesh of Object.values(this.#meshes)) {
      mesh.geometry.dispose();
      mesh.dispose();
    }
    this.#material.dispose();
  }

  #add(mesh: InstancedMesh, { positionM, rotation }: Place): void {
    if (mesh.count + 2 > 2 * MOST) return;
    const [w, x, y, z] = rotation;
    this.#at.set(...positionM);
    this.#turn.set(x, y, z, w);
    this.#matrix.compose(this.#at, this.#turn, ONE);
    mesh.setMatrixAt(mesh.count++, this.#matrix);
    if (this.#mirror !== null) {
      // Left and right of each shape are equal, so its reflection is the shape, turned.
      this.#mirror.reflectPoint(this.#at);
      this.#mirror.reflectRotation(this.#turn).multiply(HALF_TURN);
      this.#matrix.compose(this.#at, this.#turn, ONE);
      mesh.setMatrixAt(mesh.count++, this.#matrix);
    }
    mesh.instanceMatrix.needsUpdate = true;
    mesh.visible = true;
  }
}

const ONE = new Vector3(1, 1, 1);
/** S R diag(-1, 1, 1) = (S R S) diag(-1, 1, -1): half a turn about the shape's own y axis. */
const HALF_TURN = new Quaternion(0, 1, 0, 0);

/** A handle along z and a ring at the thumb's end: where a grip space has its axes. */
function controller(): BufferGeometry {
  const handle = new CapsuleGeometry(0.017, 0.085, 4, 14)
    .rotateX(Math.PI / 2)
    .translate(0, 0, 0.012);
  const face = new CylinderGeometry(0.026, 0.024, 0.02, 20)
    .rotateX(0.5)
    .translate(0, 0.012, -0.045);
  const ring = new TorusGeometry(0.034, 0.005, 8, 28)
    .rotateX(Math.PI / 2 + 0.5)
    .translate(0, 0.01, -0.06);
  return merged([handle, face, ring]);
}

/** A hand from its wrist: the palm and what it points with. */
function hand(): BufferGeometry {
  const palm = new SphereGeometry(1, 16, 10).scale(0.038, 0.016, 0.05).translate(0, 0, -0.05);
  const fingers = [-0.024, -0.008, 0.008, 0.024].map((x) =>
    new CapsuleGeometry(0.008, 0.06, 3, 8).rotateX(Math.PI / 2).translate(x, 0, -0.12),
  );
  return merged([palm, ...fingers]);
}

const tracker = (): BufferGeometry => merged([new CylinderGeometry(0.032, 0.036, 0.026, 24)]);

function merged(shapes: readonly BufferGeometry[]): BufferGeometry {
  const made = mergeGeometries(shapes.map((shape) => shape.toNonIndexed()));
  for (const shape of shapes) shape.dispose();
  return made;
}
