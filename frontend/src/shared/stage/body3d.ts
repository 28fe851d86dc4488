/**
 * A figure in the scene: bones, joints and a shadow on the floor, moved without allocating objects.
 */
import {
  Color,
  type ColorRepresentation,
  CylinderGeometry,
  DynamicDrawUsage,
  Group,
  InstancedMesh,
  type Material,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  OctahedronGeometry,
  Quaternion,
  SphereGeometry,
  Vector3,
} from "three";
import type { Seconds } from "../units";
import type { Figure, StagePalette } from "./figure";
import { type PointMotion, sizeOf } from "./motion";
import { type Placing, placing } from "./placing";

const UP = new Vector3(0, 1, 0);
/** The size of a body of 1.7 m, metres. */
const USUAL_SIZE = 1.7;
const RADIUS = { skeleton: 0.029, markers: 0.018, bodies: 0.05 } as const;
const HEAD_RADIUS = 0.095;
const GHOST_OPACITY = 0.45;
/**
 * A ghost is thinner, so that it disappears inside the body it is compared with where both agree.
 */
const GHOST_GIRTH = 0.85;

export class Body3d {
  readonly group = new Group();
  readonly placing: Placing;
  /** Hide the head, for a view through the figure's own eyes. */
  headless = false;
  readonly #bones: readonly (readonly [from: number, to: number])[];
  readonly #meshes: Meshes;
  readonly #scale: number;

  constructor(
    readonly figure: Figure,
    palette: StagePalette,
  ) {
    const { motion } = figure;
    this.placing = placing(figure);
    this.#bones = motion.parents.flatMap((parent, child) =>
      parent < 0 ? [] : [[parent, child] as const],
    );
    // One or two trackers do not show how large a body is.
    const size = motion.names.length < 3 ? 1 : Math.max(sizeOf(motion), 1e-3) / USUAL_SIZE;
    this.#scale = size * (figure.tone === "ghost" ? GHOST_GIRTH : 1);
    this.#meshes = makeMeshes(motion, this.#bones.length, figure, palette);
    this.group.add(...Object.values(this.#meshes).filter((mesh) => mesh !== null));
    this.#colour(palette);
  }

  /** Move to a time; return the frame that is shown. */
  show(time: Seconds): number {
    const frame = this.placing.place(time);
    this.#placeBones();
    this.#placeJoints();
    this.#placeExtras();
    return frame;
  }

  /** Recolour the figure: a bone has the colour of the joint at its upper end, which moves it. */
  paint(colourOf: (point: number) => ColorRepresentation): void {
    const { bones, joints, head } = this.#meshes;
    this.#bones.forEach(([parent], index) => {
      bones.setColorAt(index, new Color(colourOf(parent)));
    });
    this.figure.motion.names.forEach((_, point) => {
      joints.setColorAt(point, new Color(colourOf(point)));
    });
    const above = this.figure.roles?.head ?? null;
    if (head !== null && above !== null) head.material.color.set(colourOf(above));
    for (const mesh of [bones, joints]) {
      if (mesh.instanceColor !== null) mesh.instanceColor.needsUpdate = true;
    }
  }

  dispose(): void {
    for (const mesh of Object.values(this.#meshes)) {
      if (mesh === null) continue;
      mesh.geometry.dispose();
      (mesh.material as Material).dispose();
      if (mesh instanceof InstancedMesh) mesh.dispose();
    }
  }

  #point(point: number, into: Vector3): Vector3 {
    return into.fromArray(this.placing.placed, 3 * point);
  }

  #placeBones(): void {
    const { bones, shadow } = this.#meshes;
    const from = new Vector3();
    const to = new Vector3();
    const along = new Vector3();
    const turned = new Quaternion();
    const matrix = new Matrix4();
    this.#bones.forEach(([parent, child], index) => {
      this.#point(parent, from);
      along.subVectors(this.#point(child, to), from);
      const length = along.length();
      const seen = this.placing.seen[parent] === 1 && this.placing.seen[child] === 1;
      // A bone with an unseen end is drawn as a thread.
      const radius = Math.min(0.021 * this.#scale, 0.14 * length) * (seen ? 1 : 0.25);
      turned.setFromUnitVectors(UP, length > 0 ? along.divideScalar(length) : UP);
      matrix.compose(
        from.addScaledVector(along, length / 2),
        turned,
        to.set(radius, length, radius),
      );
      bones.setMatrixAt(index, Number.isFinite(length) ? matrix : NOWHERE);
    });
    bones.instanceMatrix.needsUpdate = true;
    shadow.instanceMatrix = bones.instanceMatrix;
  }

  #placeJoints(): void {
    const { joints, unseen } = this.#meshes;
    const at = new Vector3();
    const matrix = new Matrix4();
    const radius = RADIUS[this.figure.motion.kind] * this.#scale;
    for (let point = 0; point < this.placing.seen.length; point++) {
      this.#point(point, at);
      const known = Number.isFinite(at.x);
      const seen = this.placing.seen[point] === 1;
      matrix.makeScale(radius, radius, radius).setPosition(at);
      joints.setMatrixAt(point, known && seen ? matrix : NOWHERE);
      matrix.makeScale(1.6 * radius, 1.6 * radius, 1.6 * radius).setPosition(at);
      unseen.setMatrixAt(point, known && !seen ? matrix : NOWHERE);
    }
    joints.instanceMatrix.needsUpdate = true;
    unseen.instanceMatrix.needsUpdate = true;
  }

  #placeExtras(): void {
    const { head, pointer } = this.#meshes;
    const { roles, highlighted = null, motion } = this.figure;
    const joint = roles?.head ?? null;
    const at = new Vector3();
    if (head !== null && joint !== null) {
      const neck = this.#point(motion.parents[joint] ?? joint, new Vector3());
      this.#point(joint, at);
      const along = at.clone().sub(neck).normalize();
      head.position.copy(at).addScaledVector(along, 0.8 * HEAD_RADIUS * this.#scale);
      head.visible = !this.headless && Number.isFinite(at.x) && this.placing.seen[joint] === 1;
    }
    pointer.visible = highlighted !== null && Number.isFinite(this.#point(highlighted, at).x);
    if (highlighted !== null) pointer.position.copy(this.#point(highlighted, at));
  }

  #colour(palette: StagePalette): void {
    const { bones, joints, head, pointer } = this.#meshes;
    const { roles, tone } = this.figure;
    const of = (point: number): ColorRepresentation => {
      if (tone === "ghost") return palette.ghost;
      if (roles?.left.has(point)) return palette.left;
      return roles?.right.has(point) ? palette.right : palette.trunk;
    };
    this.#bones.forEach(([, child], index) => {
      bones.setColorAt(index, new Color(of(child)));
    });
    this.figure.motion.names.forEach((_, point) => {
      joints.setColorAt(point, new Color(of(point)));
    });
    head?.scale.setScalar(HEAD_RADIUS * this.#scale);
    pointer.scale.setScalar(0.05 * this.#scale);
  }
}

const NOWHERE = new Matrix4().makeScale(0, 0, 0);

type Head = Mesh<SphereGeometry, MeshLambertMaterial>;

interface Meshes {
  readonly bones: InstancedMesh;
  readonly joints: InstancedMesh;
  readonly unseen: InstancedMesh;
  readonly shadow: InstancedMesh;
  readonly pointer: Mesh;
  readonly head: Head | null;
}

function makeMeshes(
  motion: PointMotion,
  boneCount: number,
  figure: Figure,
  palette: StagePalette,
): Meshes {
  const material =
    figure.tone === "ghost" ? { transparent: true, opacity: GHOST_OPACITY, depthWrite: false } : {};
  const points = motion.names.length;
  const ball = motion.kind === "bodies" ? new OctahedronGeometry(1) : new SphereGeometry(1, 14, 10);
  const bone = new CylinderGeometry(1, 1, 1, 8);
  const flat = new MeshBasicMaterial({ color: palette.shadow });
  const bones = instanced(new InstancedMesh(bone, new MeshLambertMaterial(material), boneCount));
  const shadow = instanced(new InstancedMesh(bone.clone(), flat, boneCount));
  // The bones a second time, flattened onto the floor.
  shadow.scale.y = 0;
  shadow.position.y = 0.001;
  shadow.visible = figure.tone === "solid";
  const hollow = { color: palette.unseen, wireframe: true };
  return {
    bones,
    shadow,
    joints: instanced(new InstancedMesh(ball, new MeshLambertMaterial(material), points)),
    unseen: instanced(
      new InstancedMesh(new OctahedronGeometry(1, 1), new MeshBasicMaterial(hollow), points),
    ),
    head: headOf(figure, palette, material),
    pointer: pointerOf(palette),
  };
}

function headOf(figure: Figure, palette: StagePalette, material: object): Head | null {
  if (figure.roles?.head == null) return null;
  const colour = figure.tone === "ghost" ? palette.ghost : palette.trunk;
  return new Mesh(
    new SphereGeometry(1, 22, 16),
    new MeshLambertMaterial({ ...material, color: colour }),
  );
}

/** Drawn on top of everything: what it points at may be inside the body. */
function pointerOf(palette: StagePalette): Mesh {
  const material = new MeshBasicMaterial({
    color: palette.highlight,
    transparent: true,
    opacity: 0.85,
    depthTest: false,
  });
  const pointer = new Mesh(new SphereGeometry(1, 18, 12), material);
  pointer.renderOrder = 2;
  pointer.visible = false;
  return pointer;
}

function instanced(mesh: InstancedMesh): InstancedMesh {
  mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  // The figure moves all the time, and drawing what is out of view is cheap.
  mesh.frustumCulled = false;
  return mesh;
}
