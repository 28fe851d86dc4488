/**
 * A figure that wears a body: skinned meshes, moved by the figure's pose without allocating
 * anything, with a shadow on the floor. This module imports three.js.
 */
import {
  Bone,
  type ColorRepresentation,
  DetachedBindMode,
  Group,
  type Material,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  type MeshStandardMaterial,
  Skeleton,
  SkinnedMesh,
  Sphere,
  Vector3,
} from "three";
import type { Seconds } from "../../units";
import type { Figure, StagePalette } from "../figure";
import { type Placing, placing } from "../placing";
import type { BodyMesh } from "./bodyModel";
import { numbersOf, Parts } from "./pose";
import { Tints } from "./tint";
import type { Worn } from "./worn";

const GHOST_OPACITY = 0.42;
const IDENTITY = new Matrix4();

export class SkinnedBody3d {
  readonly group = new Group();
  readonly placing: Placing;
  /** Hide the head, for a view through the figure's own eyes. */
  headless = false;
  readonly #worn: Worn;
  readonly #meshes = new Group();
  readonly #parts: Parts;
  readonly #values: Float32Array;
  readonly #bones: readonly Bone[];
  /** By part: the node's place in its part, in the wearer's size. */
  readonly #partFromNode: readonly Matrix4[];
  readonly #skeletons: readonly Skeleton[];
  readonly #drawn: readonly Drawn[];
  readonly #materials = new Set<Material>();
  readonly #tints: Tints;
  readonly #middle = new Sphere(new Vector3(), 1.2);
  /** By part of the figure's points: the part at the point, or -1. */
  readonly #partOfPoint: readonly number[];
  #isHeadless = false;

  constructor(
    readonly figure: Figure,
    worn: Worn,
    palette: StagePalette,
  ) {
    const { model, statureM, pose } = worn;
    const { binding } = model;
    this.#worn = worn;
    this.placing = placing(figure);
    const scale = statureM / binding.stature_m;
    this.#parts = new Parts(binding, scale, pose);
    this.#values = new Float32Array(numbersOf(pose.joints)).fill(Number.NaN);
    this.#bones = model.nodes.map(() => new Bone());
    this.#partFromNode = binding.part_from_node.map((rows) => scaled(rows, scale));
    this.#tints = new Tints(binding.parts.length);
    this.#skeletons = model.skins.map(({ joints, inverses }) => {
      const bones = joints.map((joint) => this.#bones[joint] as Bone);
      return new Skeleton(bones, inverses);
    });
    const isGhost = figure.tone === "ghost";
    const dress = isGhost ? ghostly(palette, this.#materials) : this.#own();
    this.#drawn = model.meshes.map((mesh) => {
      const made = this.#make(mesh, dress(mesh.material));
      this.#meshes.add(made);
      return { source: mesh, made };
    });
    if (!isGhost) this.#castShadows(palette);
    this.group.add(this.#meshes);
    this.#meshes.visible = false;
    this.#partOfPoint = figure.motion.names.map((name) => binding.parts.indexOf(name));
  }

  /** Move to a time; return the frame that is shown. */
  show(time: Seconds): number {
    const frame = this.placing.place(time);
    this.#worn.pose.read(frame, this.#values);
    const [x, z] = this.figure.offset ?? NOT_MOVED;
    this.#values[0] = (this.#values[0] ?? 0) + x;
    this.#values[2] = (this.#values[2] ?? 0) + z;
    if (this.#parts.place(this.#values)) this.#moved();
    if (this.#isHeadless !== this.headless) this.#turnHeadless();
    return frame;
  }

  /**
   * Tint the skin: each part has the colour of the figure's point of its name, fingers that of
   * their hand.
   */
  paint(colourOf: (point: number) => ColorRepresentation): void {
    const { parts, parents } = this.#worn.model.binding;
    const points = parts.map(() => -1);
    parts.forEach((part, index) => {
      const own = this.figure.motion.names.indexOf(part);
      points[index] = own >= 0 ? own : (points[parents[index] ?? -1] ?? -1);
      if ((points[index] ?? -1) < 0) return;
      this.#tints.set(index, colourOf(points[index] ?? 0) as string);
    });
  }

  dispose(): void {
    // Geometries and textures belong to the model, which others may wear.
    for (const skeleton of this.#skeletons) skeleton.dispose();
    for (const material of this.#materials) material.dispose();
  }

  #moved(): void {
    this.#meshes.visible = true;
    this.#placeNodes();
    const { places } = this.#parts;
    this.#middle.center.set(places[0] ?? 0, places[1] ?? 0, places[2] ?? 0);
    const { placed, seen } = this.placing;
    for (let point = 0; point < this.#partOfPoint.length; point++) {
      const part = this.#partOfPoint[point] ?? -1;
      if (part < 0 || seen[point] === 0) continue;
      for (let axis = 0; axis < 3; axis++) {
        placed[3 * point + axis] = places[3 * part + axis] ?? Number.NaN;
      }
    }
  }

  #placeNodes(): void {
    const { nodes } = this.#worn.model;
    const { places, rotations } = this.#parts;
    for (let index = 0; index < nodes.length; index++) {
      const node = nodes[index];
      const world = this.#bones[index]?.matrixWorld;
      if (node === undefined || world === undefined) continue;
      const { part, parent } = node;
      if (part < 0) {
        world.multiplyMatrices(this.#bones[parent]?.matrixWorld ?? IDENTITY, node.local);
        continue;
      }
      setPose(world, places, 3 * part, rotations, 4 * part);
      world.multiply(this.#partFromNode[part] ?? IDENTITY);
    }
    for (let at = 0; at < this.#drawn.length; at++) {
      const one = this.#drawn[at];
      if (one === undefined || one.source.skin >= 0) continue;
      one.made.matrixWorld.copy(this.#bones[one.source.node]?.matrixWorld ?? IDENTITY);
    }
  }

  #make(mesh: BodyMesh, material: Material | Material[]): Mesh {
    const skeleton = this.#skeletons[mesh.skin];
    const made =
      skeleton === undefined
        ? new Mesh(mesh.geometry, material)
        : skinned(mesh.geometry, material, skeleton, this.#middle);
    if (mesh.morphs.length > 0) made.morphTargetInfluences = [...mesh.morphs];
    made.visible = mesh.view !== "firstPersonOnly";
    made.frustumCulled = false;
    made.matrixAutoUpdate = false;
    // A rigid mesh is placed with its node; a skin is already in the world.
    made.matrixWorldAutoUpdate = skeleton !== undefined;
    return made;
  }

  /** The model's own materials, to be tinted. */
  #own(): (material: BodyMesh["material"]) => Material | Material[] {
    const made = new Map<Material, Material>();
    const own = (material: Material): Material => {
      const known = made.get(material);
      if (known !== undefined) return known;
      const copy = material.clone();
      this.#tints.apply(copy);
      this.#materials.add(copy);
      made.set(material, copy);
      return copy;
    };
    return (material) => (isList(material) ? material.map(own) : own(material));
  }

  /** The skin a second time, flattened onto the floor. */
  #castShadows(palette: StagePalette): void {
    const material = new MeshBasicMaterial({ color: palette.shadow });
    this.#materials.add(material);
    for (const { skin, geometry, view } of this.#worn.model.meshes) {
      const skeleton = this.#skeletons[skin];
      if (skeleton === undefined || view === "firstPersonOnly") continue;
      const shadow = skinned(geometry, material, skeleton, this.#middle);
      shadow.matrix.makeScale(1, 0, 1).setPosition(0, 0.001, 0);
      shadow.matrixAutoUpdate = false;
      this.#meshes.add(shadow);
    }
  }

  #turnHeadless(): void {
    this.#isHeadless = this.headless;
    for (const { source, made } of this.#drawn) {
      if (source.view === "auto") {
        const { model } = this.#worn;
        made.geometry = this.headless ? model.headless(source.geometry) : source.geometry;
      } else {
        made.visible =
          source.view === "both" || (source.view === "firstPersonOnly") === this.headless;
      }
    }
  }
}

interface Drawn {
  readonly source: BodyMesh;
  readonly made: Mesh;
}

const NOT_MOVED = [0, 0] as const;

const isList = (material: BodyMesh["material"]): material is readonly Material[] =>
  Array.isArray(material);

function skinned(
  geometry: BodyMesh["geometry"],
  material: Material | Material[],
  skeleton: Skeleton,
  middle: Sphere,
): SkinnedMesh {
  const mesh = new SkinnedMesh(geometry, material);
  mesh.bind(skeleton, IDENTITY);
  // Bones are placed in the world, wherever the mesh is.
  mesh.bindMode = DetachedBindMode;
  // The figure moves all the time, and drawing what is out of view is cheap.
  mesh.frustumCulled = false;
  mesh.boundingSphere = middle;
  return mesh;
}

/** One translucent grey; what is cut out of a texture, such as hair, stays cut out. */
function ghostly(palette: StagePalette, made: Set<Material>) {
  const plain = ghostMaterial(palette, made);
  const of = (material: Material): Material => {
    const { alphaTest, map = null, side } = material as MeshStandardMaterial;
    if (!(alphaTest > 0) || map === null) return plain;
    const cut = ghostMaterial(palette, made);
    cut.map = map;
    cut.alphaTest = alphaTest * GHOST_OPACITY;
    cut.side = side;
    return cut;
  };
  // The first of several materials is the surface; the others, such as an outline, are left out.
  return (material: BodyMesh["material"]): Material =>
    of(isList(material) ? (material[0] as Material) : (material as Material));
}

function ghostMaterial(palette: StagePalette, made: Set<Material>): MeshLambertMaterial {
  const material = new MeshLambertMaterial({
    color: palette.ghost,
    transparent: true,
    opacity: GHOST_OPACITY,
  });
  made.add(material);
  return material;
}

/** A matrix from 16 numbers row by row, for a body of another size. */
function scaled(rows: readonly number[], by: number): Matrix4 {
  const matrix = new Matrix4().fromArray([...rows]).transpose();
  const { elements } = matrix;
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 3; row++)
      elements[4 * column + row] = (elements[4 * column + row] ?? 0) * by;
  }
  return matrix;
}

/** Set a matrix to a place and a rotation, which are at these indices. */
function setPose(
  matrix: Matrix4,
  places: Float64Array,
  place: number,
  rotations: Float64Array,
  rotation: number,
): void {
  const w = rotations[rotation] ?? 1;
  const x = rotations[rotation + 1] ?? 0;
  const y = rotations[rotation + 2] ?? 0;
  const z = rotations[rotation + 3] ?? 0;
  // biome-ignore format: as a matrix is written
  matrix.set(
    1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), places[place] ?? 0,
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), places[place + 1] ?? 0,
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), places[place + 2] ?? 0,
    0, 0, 0, 1,
  );
}
