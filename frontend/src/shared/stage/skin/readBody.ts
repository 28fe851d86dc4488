/** Read a body from the bytes of its model's file. This module imports three.js. */
import { LoadingManager, TextureLoader } from "three";
import { GLTFLoader, type GLTFParser } from "three/addons/loaders/GLTFLoader.js";
import type { BodyModel } from "./bodyModel";
import { embeddedIn, makeDecoders } from "./decoders";
import { bodyOfGltf } from "./gltfBody";
import type { BodyBinding } from "./pose";

/** Read a model's file: glTF in one file, or VRM 0 or 1, whose materials are kept. */
export async function readBody(file: ArrayBuffer, binding: BodyBinding): Promise<BodyModel> {
  const decoders = makeDecoders();
  try {
    const loader = new GLTFLoader(decoders.manager)
      .setDRACOLoader(decoders.draco)
      .setKTX2Loader(decoders.ktx2)
      .setMeshoptDecoder(decoders.meshopt as never);
    const failed = new Set<number>();
    loader.register((parser) => {
      keepToFile(parser);
      noteFailures(parser, failed);
      return { name: "REEMBODY_one_file" };
    });
    if (namesVrm(file)) {
      const { VRMLoaderPlugin } = await import("@pixiv/three-vrm");
      loader.register((parser) => new VRMLoaderPlugin(parser));
    }
    const body = bodyOfGltf(await loader.parseAsync(file, ""), binding);
    body.missing = { count: failed.size, isDecoderMissing: decoders.isTextureDecoderMissing() };
    return body;
  } finally {
    decoders.dispose();
  }
}

/** Load nothing from other addresses, and images only as elements, as the page's policy allows. */
function keepToFile(parser: GLTFParser): void {
  const own = parser as unknown as {
    textureLoader: TextureLoader;
    fileLoader: { load: (...all: FileLoaderArguments) => void };
  };
  const inFile = new LoadingManager();
  inFile.setURLModifier((url) => (/^(data|blob):/.test(url) ? url : NO_PICTURE));
  own.textureLoader = new TextureLoader(inFile);
  own.fileLoader = Object.assign(parser.fileLoader, {
    load: (url: string, onLoad: (data: ArrayBuffer) => void, _: unknown, onError: () => void) => {
      const embedded = embeddedIn(url);
      if (embedded === null) onError();
      else onLoad(embedded);
    },
  }) as typeof own.fileLoader;
}

/** Three leaves pictures out that it cannot read, without a word: note them by their index. */
function noteFailures(parser: GLTFParser, failed: Set<number>): void {
  const own = parser as unknown as { loadImageSource: LoadImage };
  const load = own.loadImageSource.bind(parser);
  own.loadImageSource = async (index, loader) => {
    try {
      return await load(index, loader);
    } catch (error) {
      failed.add(index);
      throw error;
    }
  };
}

type LoadImage = (index: number, loader: unknown) => Promise<unknown>;

/** An address without a picture, for those that lead out of the file. */
const NO_PICTURE = "data:,";

type FileLoaderArguments = [
  url: string,
  onLoad: (data: ArrayBuffer) => void,
  onProgress: unknown,
  onError: () => void,
];

/** Whether the file's description names an extension of VRM, in which case its plugin is needed. */
function namesVrm(file: ArrayBuffer): boolean {
  const view = new DataView(file);
  const isBinary = file.byteLength >= 20 && view.getUint32(0, true) === GLB_MAGIC;
  const text = isBinary ? new Uint8Array(file, 20, view.getUint32(12, true)) : new Uint8Array(file);
  return /"VRM(C_\w+)?"/.test(new TextDecoder().decode(text));
}

const GLB_MAGIC = 0x46546c67;
