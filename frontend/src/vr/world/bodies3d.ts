/**
 * A body in the room: as its wearer's eyes see it, without its head, and its reflection, with it.
 * This module imports three.js.
 */

import type { ArmsM } from "@shared/stage/skin/arms";
import type { BodyMesh, BodyModel } from "@shared/stage/skin/bodyModel";
import { BodyBones, skinned } from "@shared/stage/skin/bones";
import { Parts } from "@shared/stage/skin/pose";
import {
  CapsuleGeometry,
  DynamicDrawUsage,
  FrontSide,
  Group,
  InstancedMesh,
  type Material,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  MeshStandardMaterial,
  Quaternion,
  Sphere,
  Vector3,
} from "three";
import type { Mirror } from "./mirror";
import { POSE, UNIT_SKELETON, unitSkeleton, WHOLE_VALUES, writePose } from "./skeleton";

/** How a body looks. */
export type Look = "own" | "transparent";

export interface Body3d {
  readonly group: Group;
  /** World places and rotations of its parts, and their names. */
  readonly parts: Parts;
  readonly partNames: readonly string[];
  /** Move; does nothing while the pose is not fully known. */
  move(pose: ArrayLike<number>, fingers: ArrayLike<number> | null): void;
  /** Whether the eyes in the body's head look: then they do not see that head. */
  setSeenFromWithin(isSeenFromWithin: boolean): void;
  /** How high the hips' joint is in the T-pose, metres. */
  readonly hipsHeightM: number;
  dispose(): void;
}

/** Farther away by a trace, so that a body at the same place hides it. */
const TRANSPARENT = {
  ...{ color: "#7f9cab", transparent: true, opacity: 0.4 },
  ...{ polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 },
} as const;

/** A body's model, and the arms that it has been given where they are not its own. */
export interface Wearable {
  readonly model: BodyModel;
  readonly armsM?: ArmsM;
}

/**
 * A model that is worn. Two draws a mesh on one skeleton: what the eyes see, and its reflection,
 * whose matrix is the mirror's (three.js turns its faces round itself).
 */
export class SkinnedBody implements Body3d {
  readonly group = new Group();
  readonly partNames: readonly string[];
  readonly hipsHeightM: number;
  readonly #bones: BodyBones;
  readonly #values = new Float32Array(WHOLE_VALUES);
  readonly #drawn: readonly DrawnMesh[];
  readonly #materials = new Map<Material, Material>();
  readonly #mirror: Mirror | null;

  constructor({ model, armsM }: Wearable, statureM: number, look: Look, mirror: Mirror | null) {
    this.#mirror = mirror;
    this.#bones = new BodyBones(model, statureM, POSE, armsM);
    const { binding } = model;
    this.partNames = binding.parts;
    this.hipsHeightM = ((binding.joints_m[0]?.[1] ?? 0) * statureM) / binding.stature_m;
    const around = new Sphere(new Vector3(), 100);
    this.#drawn = model.meshes.map((source) => {
      const material = this.#dressed(source.material, look);
      const make = (): Mesh => {
        const skeleton = this.#bones.skeletons[source.skin];
        const mesh =
          skeleton === undefined
            ? new Mesh(source.geometry, material)
            : skinned(source.geometry, material, skeleton, around);
        if (source.morphs.length > 0) mesh.morphTargetInfluences = [...source.morphs];
        mesh.frustumCulled = false;
        mesh.matrixAutoUpdate = false;
        mesh.matrixWorldAutoUpdate = false;
        return mesh;
      };
      const seen = make();
      const glass = mirror === null ? null : make();
      if (mirror !== null) glass?.matrixWorld.copy(mirror.matrix);
      this.group.add(seen);
      if (glass !== null) this.group.add(glass);
      return { source, seen, glass, headless: model.headless(source.geometry) };
    });
    this.group.visible = false;
    this.setSeenFromWithin(false);
  }

  get parts(): Parts {
    return this.#bones.parts;
  }

  move(pose: ArrayLike<number>, fingers: ArrayLike<number> | null): void {
    writePose(pose, fingers, this.#values);
    if (!this.#bones.place(this.#values)) return;
    this.group.visible = true;
    for (const { source, seen, glass } of this.#drawn) {
      if (source.skin >= 0) {
        if (this.#mirror !== null) glass?.matrixWorld.copy(this.#mirror.matrix);
        continue;
      }
      // A rigid mesh moves with its node; a skin is in the world already.
      const world = this.#bones.nodeWorld(source.node);
      seen.matrixWorld.copy(world);
      if (this.#mirror !== null) glass?.matrixWorld.multiplyMatrices(this.#mirror.matrix, world);
    }
  }

  setSeenFromWithin(isSeenFromWithin: boolean): void {
    for (const { source, seen, glass, headless } of this.#drawn) {
      seen.geometry = isSeenFromWithin && source.view === "auto" ? headless : source.geometry;
      seen.visible = source.view !== (isSeenFromWithin ? "thirdPersonOnly" : "firstPersonOnly");
      if (glass !== null) glass.visible = source.view !== "firstPersonOnly";
    }
  }

  dispose(): void {
    // Geometries and textures belong to the model, which others may wear.
    this.#bones.dispose();
    for (const material of this.#materials.values()) material.dispose();
  }

  #dressed(material: BodyMesh["material"], look: Look): Material | Material[] {
    if (!isList(material)) return this.#dressedOne(material, look);
    // The first of several materials is the surface; the others, such as outlines, cost a draw each.
    return this.#dressedOne(material[0] ?? new MeshLambertMaterial(), look);
  }

  #dressedOne(material: Material, look: Look): Material {
    const known = this.#materials.get(material);
    if (known !== undefined) return known;
    const made =
      look === "transparent"
        ? new MeshLambertMaterial({ ...TRANSPARENT, side: FrontSide })
        : matt(material);
    this.#materials.set(material, made);
    return made;
  }
}

interface DrawnMesh {
  readonly source: BodyMesh;
  readonly seen: Mesh;
  readonly glass: Mesh | null;
  readonly headless: Mesh["geometry"];
}

const isList = (material: BodyMesh["material"]): material is readonly Material[] =>
  Array.isArray(material);

/**
 * The same surface without reflections: at a headset's resolution they cost more than they show.
 * Materials with shaders of their own are kept as they are.
 */
function matt(material: Material): Material {
  if (!(material instanceof MeshStandardMaterial)) return material.clone();
  const { color, map, vertexColors, alphaTest, transparent, opacity, side, alphaMap } = material;
  const { emissive, emissiveMap, emissiveIntensity, normalMap, normalScale } = material;
  return new MeshLambertMaterial({
    ...{ color, map, vertexColors, alphaTest, transparent, opacity, side, alphaMap },
    ...{ emissive, emissiveMap, emissiveIntensity, normalMap, normalScale },
  });
}

/** A part of the simple body: from its joint to another's, or to a place beyond it. */
interface Limb {
  readonly part: number;
  readonly to: number;
  /** Where it ends if there is no other joint, in the part, as a share of the stature. */
  readonly end: readonly [number, number, number];
  readonly radius: number;
}

const ENDS: Readonly<Record<string, readonly [number, number, number]>> = {
  Head: [0, 0.125, 0],
  LeftHand: [-0.108, 0, 0],
  RightHand: [0.108, 0, 0],
  LeftToes: [0, 0, -0.042],
  RightToes: [0, 0, -0.042],
};
/** Radii as shares of the stature: `app/science/skeleton/model.py`. */
const RADIUS: Readonly<Record<string, number>> = {
  ...{ Hips: 0.08, Spine: 0.075, Chest: 0.075, UpperChest: 0.075, Neck: 0.033, Head: 0.0625 },
  ...{ Shoulder: 0.033, UpperArm: 0.027, LowerArm: 0.022, Hand: 0.018 },
  ...{ UpperLeg: 0.048, LowerLeg: 0.032, Foot: 0.014, Toes: 0.014 },
};
const CONTINUES: Readonly<Record<string, string>> = {
  ...{ Hips: "Spine", Spine: "Chest", Chest: "UpperChest", UpperChest: "Neck", Neck: "Head" },
  ...{ Shoulder: "UpperArm", UpperArm: "LowerArm", LowerArm: "Hand" },
  ...{ UpperLeg: "LowerLeg", LowerLeg: "Foot", Foot: "Toes" },
};

/** Capsules around the bones, for as long as no model is loaded; the eyes never see the head. */
export class PlainBody implements Body3d {
  readonly group = new Group();
  readonly parts: Parts;
  readonly partNames = UNIT_SKELETON.parts;
  readonly hipsHeightM: number;
  readonly #values = new Float32Array(WHOLE_VALUES);
  readonly #limbs: readonly Limb[];
  readonly #statureM: number;
  readonly #mirror: Mirror | null;
  readonly #mesh: InstancedMesh<CapsuleGeometry, MeshLambertMaterial>;
  #isSeenFromWithin = false;

  constructor(statureM: number, look: Look, mirror: Mirror | null, armStretch = 1) {
    this.#statureM = statureM;
    this.#mirror = mirror;
    const skeleton = unitSkeleton(armStretch);
    this.parts = new Parts({ ...skeleton, nodes: [], part_from_node: [] }, statureM, POSE);
    this.hipsHeightM = statureM * (UNIT_SKELETON.joints_m[0]?.[1] ?? 0);
    this.#limbs = limbs();
    // A capsule's double is a capsule: both are instances of one.
    const count = this.#limbs.length * (mirror === null ? 1 : 2);
    const material = new MeshLambertMaterial(look === "own" ? { color: "#c9b8a8" } : TRANSPARENT);
    this.#mesh = new InstancedMesh(new CapsuleGeometry(1, 2, 5, 12), material, count);
    this.#mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.#mesh.frustumCulled = false;
    this.group.add(this.#mesh);
    this.group.visible = false;
  }

  move(pose: ArrayLike<number>, fingers: ArrayLike<number> | null): void {
    writePose(pose, fingers, this.#values);
    if (!this.parts.place(this.#values)) return;
    this.group.visible = true;
    const { places, rotations } = this.parts;
    this.#limbs.forEach(({ part, to, end, radius }, at) => {
      FROM.fromArray(places, 3 * part);
      if (to >= 0) TO.fromArray(places, 3 * to);
      else {
        const [w = 1, x = 0, y = 0, z = 0] = rotations.subarray(4 * part, 4 * part + 4);
        TO.set(...end)
          .multiplyScalar(this.#statureM)
          .applyQuaternion(TURN.set(x, y, z, w))
          .add(FROM);
      }
      this.#setLimb(at, radius * this.#statureM, part);
    });
    this.#mesh.instanceMatrix.needsUpdate = true;
  }

  setSeenFromWithin(isSeenFromWithin: boolean): void {
    this.#isSeenFromWithin = isSeenFromWithin;
  }

  dispose(): void {
    this.#mesh.geometry.dispose();
    this.#mesh.material.dispose();
    this.#mesh.dispose();
  }

  #setLimb(at: number, radiusM: number, part: number): void {
    ALONG.subVectors(TO, FROM);
    const length = Math.max(ALONG.length(), 1e-6);
    TURN.setFromUnitVectors(UP, ALONG.divideScalar(length));
    FROM.addScaledVector(ALONG, length / 2);
    // A capsule of radius 1 is 4 units long.
    SIZE.set(radiusM, (length + radiusM) / 4, radiusM);
    const name = this.partNames[part] ?? "";
    const isHidden = this.#isSeenFromWithin && (name === "Head" || name === "Neck");
    this.#mesh.setMatrixAt(at, isHidden ? NOWHERE : MATRIX.compose(FROM, TURN, SIZE));
    if (this.#mirror === null) return;
    this.#mirror.reflectPoint(FROM);
    this.#mirror.reflectRotation(TURN);
    this.#mesh.setMatrixAt(this.#limbs.length + at, MATRIX.compose(FROM, TURN, SIZE));
  }
}

function limbs(): readonly Limb[] {
  const { parts } = UNIT_SKELETON;
  return parts.map((name, part) => {
    const [, side = "", bare = name] = /^(Left|Right)(.+)$/.exec(name) ?? [];
    const next = CONTINUES[bare];
    const to = next === undefined ? -1 : parts.indexOf(side + next);
    return { part, to, end: ENDS[name] ?? [0, 0, 0], radius: RADIUS[bare] ?? 0.02 };
  });
}

const FROM = new Vector3();
const TO = new Vector3();
const ALONG = new Vector3();
const SIZE = new Vector3();
const UP = new Vector3(0, 1, 0);
const TURN = new Quaternion();
const MATRIX = new Matrix4();
const NOWHERE = new Matrix4().makeScale(0, 0, 0);
