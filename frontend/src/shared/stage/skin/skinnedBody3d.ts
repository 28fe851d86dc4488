/**
 * A figure that wears a body: skinned meshes, moved by the figure's pose without allocating
 * anything, with a shadow on the floor. This module imports three.js.
 */
import {
  type ColorRepresentation,
  Group,
  type Material,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  type MeshStandardMaterial,
  Sphere,
  Vector3,
} from "three";
import type { Seconds } from "../../units";
import type { Figure, StagePalette } from "../figure";
import { type Placing, placing } from "../placing";
import type { BodyMesh } from "./bodyModel";
import { BodyBones, skinned } from "./bones";
import { numbersOf } from "./pose";
import { Tints } from "./tint";
import type { Worn } from "./worn";

const GHOST_OPACITY = 0.42;

export class SkinnedBody3d {
  readonly group = new Group();
  readonly placing: Placing;
  /** Hide the head, for a view through the figure's own eyes. */
  headless = false;
  readonly #worn: Worn;
  readonly #meshes = new Group();
  readonly #values: Float32Array;
  readonly #bones: BodyBones;
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
    this.#values = new Float32Array(numbersOf(pose.joints)).fill(Number.NaN);
    this.#bones = new BodyBones(model, statureM, pose);
    this.#tints = new Tints(binding.parts.length);
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
    if (this.#bones.place(this.#values)) this.#moved();
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
    this.#bones.dispose();
    for (const material of this.#materials) material.dispose();
  }

  #moved(): void {
    this.#meshes.visible = true;
    this.#placeRigid();
    const { places } = this.#bones.parts;
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

  #placeRigid(): void {
    for (let at = 0; at < this.#drawn.length; at++) {
      const one = this.#drawn[at];
      if (one === undefined || one.source.skin >= 0) continue;
      one.made.matrixWorld.copy(this.#bones.nodeWorld(one.source.node));
    }
  }

  #make(mesh: BodyMesh, material: Material | Material[]): Mesh {
    const skeleton = this.#bones.skeletons[mesh.skin];
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
      const skeleton = this.#bones.skeletons[skin];
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
