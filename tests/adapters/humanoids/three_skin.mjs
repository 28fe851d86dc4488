// Poses models with three.js as docs/avatar-configuration.md says, and prints how far vertices are
// from where the server has them: three_skin.mjs THREE MODEL VECTORS [MODEL VECTORS ...]
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

globalThis.self = globalThis;
const [folder, ...files] = process.argv.slice(2);
const load = (path) => import(pathToFileURL(`${folder}/${path}`));
const { Matrix4, Quaternion, Texture, Vector3 } = await load("build/three.module.js");
const { GLTFLoader } = await load("examples/jsm/loaders/GLTFLoader.js");
const { MeshoptDecoder } = await load("examples/jsm/libs/meshopt_decoder.module.js");
const noTextures = () => ({ name: "no textures", loadTexture: async () => new Texture() });
const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).register(noTextures);
const rowByRow = (numbers) => new Matrix4().fromArray(numbers).transpose();

function worldFromParts(binding, pose, factor) {
  const joint = (row) => new Vector3(...binding.joints_m[row]);
  const world = [];
  pose.rotations.forEach(([w, x, y, z], row) => {
    const parent = binding.parents[row];
    const place =
      parent < 0
        ? new Vector3(...pose.hips_m)
        : joint(row).sub(joint(parent)).multiplyScalar(factor);
    const local = new Matrix4().compose(place, new Quaternion(x, y, z, w), new Vector3(1, 1, 1));
    world.push(parent < 0 ? local : world[parent].clone().multiply(local));
  });
  return world;
}

/** The greatest distance in metres between three's vertices and the server's, and their number. */
async function compare(model, vectors) {
  const { binding, cases } = JSON.parse(readFileSync(vectors, "utf8"));
  const bytes = readFileSync(model);
  const whole = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
  const { scene, parser } = await loader.parseAsync(whole, "");
  scene.updateMatrixWorld(true);
  const nodes = new Map();
  scene.traverse((object) => {
    const node = parser.associations.get(object)?.nodes;
    if (node !== undefined) nodes.set(node, object);
    object.matrixAutoUpdate = false;
    object.userData.rest = object.matrix.clone();
  });
  const bound = binding.nodes.map((node) => nodes.get(node));
  const hipsAtRest = bound[0].matrixWorld.clone();
  const meshes = (object) => (object.isMesh ? [object] : object.children.filter((o) => o.isMesh));
  let worst = 0;
  let count = 0;
  for (const pose of cases) {
    const factor = pose.stature_m / binding.stature_m;
    const scale = new Matrix4().makeScale(factor, factor, factor);
    const world = worldFromParts(binding, pose, factor).map((part, row) =>
      part.multiply(scale).multiply(rowByRow(binding.part_from_node[row])),
    );
    scene.traverse((object) => object.matrix.copy(object.userData.rest));
    // The whole file moves with the hips, the other parts by their own matrices.
    scene.matrix.copy(world[0].clone().multiply(hipsAtRest.clone().invert()));
    scene.updateMatrixWorld(true);
    bound.slice(1).forEach((object, row) => {
      object.matrix.copy(object.parent.matrixWorld.clone().invert()).multiply(world[row + 1]);
      object.updateMatrixWorld(true);
    });
    for (const piece of pose.vertices) {
      const mesh = meshes(nodes.get(piece.node)).find(
        (one) => (parser.associations.get(one)?.primitives ?? 0) === piece.primitive,
      );
      mesh.skeleton?.update();
      piece.rows.forEach((row, at) => {
        const vertex = mesh.getVertexPosition(row, new Vector3()).applyMatrix4(mesh.matrixWorld);
        worst = Math.max(worst, vertex.distanceTo(new Vector3(...piece.places_m[at])));
        count += 1;
      });
    }
  }
  return { worst_m: worst, vertices: count };
}

const found = [];
for (let at = 0; at < files.length; at += 2) found.push(await compare(files[at], files[at + 1]));
process.stdout.write(`${JSON.stringify(found)}\n`);
