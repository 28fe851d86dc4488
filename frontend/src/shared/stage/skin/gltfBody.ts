/** A body's model from a file that GLTFLoader has read. */
import type { Object3D } from "three";
import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import { BodyModel, type MeshView } from "./bodyModel";
import type { BodyBinding } from "./pose";

/** Throws BodyError if the binding is another file's. */
export const bodyOfGltf = (gltf: GLTF, binding: BodyBinding): BodyModel =>
  new BodyModel(binding, gltf.scene, nodesOf(gltf), viewsOf(gltf));

/** The nodes of the file by their index in it. */
function nodesOf({ parser, scene }: GLTF): ReadonlyMap<number, Object3D> {
  const nodes = new Map<number, Object3D>();
  scene.traverse((object) => {
    const index = parser.associations.get(object)?.nodes;
    if (index !== undefined && !nodes.has(index)) nodes.set(index, object);
  });
  return nodes;
}

interface VrmViews {
  readonly meshAnnotations: readonly {
    readonly meshes: readonly Object3D[];
    readonly type: MeshView;
  }[];
}

/** Who sees which mesh, as a VRM says. */
function viewsOf({ userData }: GLTF): (mesh: Object3D) => MeshView {
  const { firstPerson } = (userData.vrm ?? {}) as { readonly firstPerson?: VrmViews };
  const views = new Map<Object3D, MeshView>();
  for (const { meshes, type } of firstPerson?.meshAnnotations ?? []) {
    for (const mesh of meshes) views.set(mesh, type);
  }
  return (mesh) => views.get(mesh) ?? "auto";
}
