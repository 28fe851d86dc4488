/**
 * A body's model as it is drawn: its nodes in the order in which they are placed, its skins and its
 * meshes. It is loaded once and may be worn by several figures. This module imports three.js.
 */
import {
  BufferAttribute,
  BufferGeometry,
  type InterleavedBufferAttribute,
  type Material,
  Matrix4,
  type Mesh,
  type Object3D,
  type Skeleton,
  type SkinnedMesh,
  Texture,
  Uint8BufferAttribute,
  Vector3,
} from "three";
import type { BodyBinding } from "./pose";

/** A node that moves: with its part, or else as it lies below its parent. */
export interface BodyNode {
  /** Index in `BodyModel.nodes`; smaller than the node's own. -1 only for nodes with a part. */
  readonly parent: number;
  readonly local: Matrix4;
  /** Index in `BodyBinding.parts`, or -1. */
  readonly part: number;
}

export interface BodySkin {
  /** Indices in `BodyModel.nodes`. */
  readonly joints: readonly number[];
  readonly inverses: Matrix4[];
}

/** Who sees a mesh, as VRM names it: `auto` hides only the head from the wearer. */
export type MeshView = "auto" | "both" | "firstPersonOnly" | "thirdPersonOnly";

export interface BodyMesh {
  readonly geometry: BufferGeometry;
  readonly material: Material | readonly Material[];
  /** Index in `BodyModel.skins`; -1 for a rigid mesh. */
  readonly skin: number;
  /** Index in `BodyModel.nodes`: the node that carries a rigid mesh. */
  readonly node: number;
  readonly morphs: readonly number[];
  readonly view: MeshView;
}

/** Thrown if a model's file and its binding do not belong together. */
export class BodyError extends Error {
  override readonly name = "BodyError";
}

/** Pictures of the file that are not drawn: their parts are plain. */
export interface MissingPictures {
  readonly count: number;
  /** The decoder of compressed pictures (KTX2) could not be loaded; another try may. */
  readonly isDecoderMissing: boolean;
}

export class BodyModel {
  missing: MissingPictures = { count: 0, isDecoderMissing: false };
  readonly nodes: readonly BodyNode[];
  readonly skins: readonly BodySkin[];
  readonly meshes: readonly BodyMesh[];
  readonly #headless = new Map<BufferGeometry, BufferGeometry>();
  #aboveJointsM: number | null = null;

  /** `objects` are the nodes of the file, by their index in it. */
  constructor(
    readonly binding: BodyBinding,
    scene: Object3D,
    objects: ReadonlyMap<number, Object3D>,
    viewOf: (mesh: Object3D) => MeshView = () => "auto",
  ) {
    scene.updateMatrixWorld(true);
    const found = meshesIn(scene);
    const { nodes, indexOf } = nodesOf(binding, scene, objects, found);
    this.nodes = nodes;
    const skins = new Map<Skeleton, BodySkin>();
    const meshes: BodyMesh[] = [];
    for (const mesh of found) {
      const skeleton = isSkinned(mesh) ? mesh.skeleton : null;
      if (skeleton !== null && !skins.has(skeleton)) {
        const joints = skeleton.bones.map((bone) => indexOf.get(bone) ?? 0);
        skins.set(skeleton, { joints, inverses: skeleton.boneInverses });
      }
      const node = indexOf.get(mesh) ?? 0;
      const partOf = partsOf(nodes);
      const joints = skeleton === null ? null : (skins.get(skeleton)?.joints ?? []);
      markParts(
        mesh.geometry,
        (joint) => partOf[joints === null ? node : (joints[joint] ?? 0)] ?? 0,
      );
      meshes.push({
        geometry: mesh.geometry,
        material: mesh.material,
        skin: skeleton === null ? -1 : [...skins.keys()].indexOf(skeleton),
        node,
        morphs: mesh.morphTargetInfluences ?? [],
        view: viewOf(mesh),
      });
    }
    this.skins = [...skins.values()];
    this.meshes = meshes;
  }

  /** How far the skin reaches above the highest joint in the T-pose, in the model's own size. */
  get aboveJointsM(): number {
    this.#aboveJointsM ??= this.#topM() - Math.max(...this.binding.joints_m.map(([, y = 0]) => y));
    return this.#aboveJointsM;
  }

  /** How high the skin reaches above its soles in the T-pose, hair and hats included, in the model's own size. */
  get drawnHeightM(): number {
    return this.aboveJointsM + Math.max(...this.binding.joints_m.map(([, y = 0]) => y));
  }

  get triangles(): number {
    return this.meshes.reduce((sum, { geometry }) => {
      const corners = geometry.index?.count ?? geometry.getAttribute("position").count;
      return sum + Math.floor(corners / 3);
    }, 0);
  }

  /** The geometry without the triangles that the head moves. */
  headless(geometry: BufferGeometry): BufferGeometry {
    const known = this.#headless.get(geometry);
    if (known !== undefined) return known;
    const head = this.binding.parts.flatMap((part, index) => (HEAD.includes(part) ? [index] : []));
    const made = without(geometry, new Set(head));
    this.#headless.set(geometry, made);
    return made;
  }

  /** The height of the skin in the T-pose, each vertex placed by the first bone that moves it. */
  #topM(): number {
    const { joints_m, part_from_node } = this.binding;
    const worlds: Matrix4[] = [];
    for (const { part, parent, local } of this.nodes) {
      const world = new Matrix4();
      if (part < 0) world.multiplyMatrices(worlds[parent] ?? world, local);
      else {
        const [x = 0, y = 0, z = 0] = joints_m[part] ?? [];
        const rows = part_from_node[part] ?? [];
        world.makeTranslation(x, y, z).multiply(new Matrix4().fromArray([...rows]).transpose());
      }
      worlds.push(world);
    }
    const at = new Vector3();
    const placed = new Matrix4();
    let top = 0;
    for (const { geometry, skin, node } of this.meshes) {
      const positions = geometry.getAttribute("position");
      const indices = geometry.attributes.skinIndex as Attribute | undefined;
      const { joints = [], inverses = [] } = this.skins[skin] ?? {};
      for (let vertex = 0; vertex < positions.count; vertex++) {
        const joint = indices?.getX(vertex) ?? 0;
        placed.copy(worlds[skin < 0 ? node : (joints[joint] ?? 0)] ?? placed.identity());
        if (skin >= 0) placed.multiply(inverses[joint] ?? new Matrix4());
        top = Math.max(top, at.fromBufferAttribute(positions, vertex).applyMatrix4(placed).y);
      }
    }
    return top;
  }

  /** Release geometries, materials and textures; figures must not wear the body any more. */
  dispose(): void {
    for (const geometry of this.#headless.values()) geometry.dispose();
    for (const { geometry, material } of this.meshes) {
      geometry.dispose();
      for (const one of [material].flat()) disposeMaterial(one as Material);
    }
  }
}

const HEAD: readonly string[] = ["Head", "LeftEye", "RightEye", "Jaw"];

const isSkinned = (mesh: Mesh): mesh is SkinnedMesh =>
  (mesh as Partial<SkinnedMesh>).isSkinnedMesh === true;

function meshesIn(scene: Object3D): readonly Mesh[] {
  const meshes: Mesh[] = [];
  scene.traverse((object) => {
    if ((object as Partial<Mesh>).isMesh === true) meshes.push(object as Mesh);
  });
  return meshes;
}

/** The nodes that a part or a mesh depends on, each after the node that it moves with. */
function nodesOf(
  binding: BodyBinding,
  scene: Object3D,
  objects: ReadonlyMap<number, Object3D>,
  meshes: readonly Mesh[],
): { readonly nodes: readonly BodyNode[]; readonly indexOf: ReadonlyMap<Object3D, number> } {
  const parts = new Map<Object3D, number>();
  binding.nodes.forEach((node, part) => {
    const object = objects.get(node);
    if (object === undefined) {
      throw new BodyError(`The model has no node ${node} for ${binding.parts[part]}.`);
    }
    parts.set(object, part);
  });
  const needed = new Set<Object3D>(parts.keys());
  for (const mesh of meshes) {
    const held = isSkinned(mesh) ? mesh.skeleton.bones : [mesh];
    for (const object of held) {
      // Everything between it and the part that it moves with.
      for (let at: Object3D | null = object; at !== null && !needed.has(at); at = at.parent) {
        needed.add(at);
      }
    }
  }
  const nodes: BodyNode[] = [];
  const indexOf = new Map<Object3D, number>();
  const outside: Object3D[] = [];
  const add = (object: Object3D, node: BodyNode): void => {
    indexOf.set(object, nodes.length);
    nodes.push(node);
  };
  scene.traverse((object) => {
    if (!needed.has(object)) return;
    const part = parts.get(object) ?? -1;
    const parent = object.parent === null ? -1 : (indexOf.get(object.parent) ?? -1);
    if (part < 0 && parent < 0) outside.push(object);
    else add(object, { parent, local: object.matrix.clone(), part });
  });
  // What hangs on no part, such as the root of the file, moves with the hips.
  const hips = objects.get(binding.nodes[0] ?? -1);
  for (const object of outside) {
    if (hips === undefined) break;
    const local = hips.matrixWorld.clone().invert().multiply(object.matrixWorld);
    add(object, { parent: indexOf.get(hips) ?? 0, local, part: -1 });
  }
  return { nodes, indexOf };
}

/** The part that each node moves with. */
function partsOf(nodes: readonly BodyNode[]): readonly number[] {
  const of: number[] = [];
  for (const { parent, part } of nodes) of.push(part >= 0 ? part : (of[parent] ?? 0));
  return of;
}

/** The vertex attribute with the index of the part that moves a vertex most. */
export const PART_ATTRIBUTE = "bodyPart";

type Attribute = BufferAttribute | InterleavedBufferAttribute;

function markParts(geometry: BufferGeometry, partOfJoint: (joint: number) => number): void {
  const count = geometry.getAttribute("position").count;
  const parts = new Uint8Array(count);
  const indices = geometry.attributes.skinIndex as Attribute | undefined;
  const weights = geometry.attributes.skinWeight as Attribute | undefined;
  const shares = new Map<number, number>();
  for (let vertex = 0; vertex < count; vertex++) {
    shares.clear();
    for (let slot = 0; slot < 4 && indices !== undefined && weights !== undefined; slot++) {
      const part = partOfJoint(indices.getComponent(vertex, slot));
      shares.set(part, (shares.get(part) ?? 0) + weights.getComponent(vertex, slot));
    }
    let most = -1;
    parts[vertex] = indices === undefined ? partOfJoint(0) : 0;
    for (const [part, share] of shares) {
      if (share <= most) continue;
      most = share;
      parts[vertex] = part;
    }
  }
  geometry.setAttribute(PART_ATTRIBUTE, new Uint8BufferAttribute(parts, 1));
}

function without(geometry: BufferGeometry, parts: ReadonlySet<number>): BufferGeometry {
  const made = new BufferGeometry();
  for (const [name, attribute] of Object.entries(geometry.attributes)) {
    made.setAttribute(name, attribute);
  }
  made.morphAttributes = geometry.morphAttributes;
  made.morphTargetsRelative = geometry.morphTargetsRelative;
  const partOf = geometry.getAttribute(PART_ATTRIBUTE);
  const count = geometry.index?.count ?? partOf.count;
  const corner = (at: number): number => geometry.index?.getX(at) ?? at;
  const kept: number[] = [];
  for (let at = 0; at + 2 < count; at += 3) {
    const corners = [corner(at), corner(at + 1), corner(at + 2)];
    if (corners.some((vertex) => parts.has(partOf.getX(vertex)))) continue;
    kept.push(...corners);
  }
  made.setIndex(new BufferAttribute(new Uint32Array(kept), 1));
  // Several materials draw all triangles one after the other, an outline last.
  for (const { materialIndex = 0 } of geometry.groups) made.addGroup(0, kept.length, materialIndex);
  return made;
}

function disposeMaterial(material: Material): void {
  const { uniforms = {} } = material as { uniforms?: Record<string, { value: unknown }> };
  const values = [...Object.values(material), ...Object.values(uniforms).map(({ value }) => value)];
  for (const value of values) if (value instanceof Texture) value.dispose();
  material.dispose();
}
