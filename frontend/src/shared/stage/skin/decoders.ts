/**
 * The decoders of compressed meshes and textures: three's own, in workers that may run WebAssembly
 * although the page may not (docs/threat-model.md). This module imports three.js.
 */
import { LoadingManager } from "three";
import { DRACOLoader } from "three/addons/loaders/DRACOLoader.js";
import { KTX2Loader } from "three/addons/loaders/KTX2Loader.js";
import { fetchPart, reportUnloaded } from "../../ui/unloaded";
import codeWorker from "./codeWorker?worker&url";
import type { MeshoptRequest, MeshoptResult } from "./meshoptWorker";
import meshoptWorker from "./meshoptWorker?worker&url";
import textureWorker from "./textureWorker?worker&url";

/**
 * The URL of a worker that runs the code at a blob's URL under the worker's own policy. The
 * development server has no policy, and workers of another kind.
 */
const running = (worker: string, code: string): string =>
  import.meta.env.DEV ? code : `${worker}#${code}`;

/** Three's loader starts the workers of these libraries by the URL in `workerSourceURL`. */
interface WithWorkers {
  workerSourceURL: string;
}

/**
 * Whether the worker can be loaded: three waits for an answer of a worker that never starts. What
 * was fetched is in the browser's cache afterwards.
 */
async function checked(worker: string): Promise<void> {
  if (!import.meta.env.DEV) await fetchPart(worker);
}

/** Have the page say why a decoder could not be loaded. */
const reported = (error: unknown): never => {
  reportUnloaded(error);
  throw error;
};

class Draco extends DRACOLoader {
  /** Load the decoder; called by three before its first worker. */
  _initDecoder(): Promise<void> {
    const self = this as unknown as WithWorkers & { readonly decoderPending: Promise<void> | null };
    if (self.decoderPending !== null) return self.decoderPending;
    const above = DRACOLoader.prototype as unknown as { _initDecoder(): Promise<void> };
    const loaded = Promise.all([above._initDecoder.call(this), checked(codeWorker)]);
    const pending = loaded.then(() => {
      self.workerSourceURL = running(codeWorker, self.workerSourceURL);
    }, reported);
    (this as unknown as { decoderPending: Promise<void> }).decoderPending = pending;
    return pending;
  }
}

class Ktx2 extends KTX2Loader {
  isMissing = false;
  #ready: Promise<void> | null = null;

  override init(): Promise<void> {
    this.#ready ??= this.#load();
    return this.#ready;
  }

  async #load(): Promise<void> {
    const self = this as unknown as WithWorkers;
    const above = KTX2Loader.prototype as unknown as { init(): Promise<void> };
    try {
      await Promise.all([above.init.call(this), checked(textureWorker)]);
    } catch (error) {
      this.isMissing = true;
      reported(error);
    }
    // Workers are created later, from this address.
    self.workerSourceURL = running(textureWorker, self.workerSourceURL);
  }

  /** Load a picture in the file; the page's policy lets nobody fetch a `data:` address. */
  override load(...[url, onLoad, onProgress, onError]: Parameters<KTX2Loader["load"]>): void {
    const embedded = embeddedIn(url);
    if (embedded !== null) this.parse(embedded, onLoad, onError);
    else if (url.startsWith("blob:")) super.load(url, onLoad, onProgress, onError);
    else onError?.(new Error("The model needs another file."));
  }
}

/** The bytes of a base64 `data:` address; null for any other address. */
export function embeddedIn(url: string): ArrayBuffer | null {
  const data = /^data:[^,]*;base64,/.exec(url);
  if (data === null) return null;
  return Uint8Array.from(atob(url.slice(data[0].length)), (one) => one.charCodeAt(0)).buffer;
}

/** Decodes meshopt's buffers, in the form in which GLTFLoader asks for it. */
class Meshopt {
  readonly supported = typeof Worker !== "undefined";
  #worker: Worker | null = null;
  readonly #waiting = new Map<number, (result: MeshoptResult) => void>();
  #next = 0;

  async decodeGltfBufferAsync(
    count: number,
    stride: number,
    source: Uint8Array,
    mode: string,
    filter?: string,
  ): Promise<Uint8Array> {
    const id = this.#next++;
    // A copy: the buffer holds other things too.
    const request: MeshoptRequest = { id, count, stride, source: source.slice(), mode, filter };
    const result = await new Promise<MeshoptResult>((resolve) => {
      this.#waiting.set(id, resolve);
      this.#started().postMessage(request, [request.source.buffer]);
    });
    if (result.decoded === null) throw new Error(result.error);
    return result.decoded;
  }

  dispose(): void {
    this.#worker?.terminate();
    this.#worker = null;
  }

  #started(): Worker {
    if (this.#worker !== null) return this.#worker;
    const worker = new Worker(meshoptWorker, { type: "module" });
    worker.onmessage = ({ data }: MessageEvent<MeshoptResult>) => {
      this.#waiting.get(data.id)?.(data);
      this.#waiting.delete(data.id);
    };
    worker.onerror = ({ message }) => {
      // Without words it is the browser that could not load the worker.
      if (!message) reportUnloaded(null);
      const error = message || "The decoder of compressed meshes could not be started.";
      for (const [id, resolve] of this.#waiting) resolve({ id, decoded: null, error });
      this.#waiting.clear();
    };
    this.#worker = worker;
    return worker;
  }
}

export interface Decoders {
  readonly manager: LoadingManager;
  readonly draco: DRACOLoader;
  readonly ktx2: KTX2Loader;
  readonly meshopt: Meshopt;
  /** Whether the decoder of textures was needed and could not be loaded. */
  readonly isTextureDecoderMissing: () => boolean;
  readonly dispose: () => void;
}

/** Decoders for one model; nothing is loaded or started before it is needed. */
export function makeDecoders(): Decoders {
  const manager = new LoadingManager();
  const draco = new Draco(manager).setWorkerLimit(1);
  const ktx2 = new Ktx2(manager);
  ktx2.setWorkerLimit(1).detectSupport(renderSupport() as never);
  const meshopt = new Meshopt();
  const dispose = () => {
    for (const one of [draco, ktx2]) {
      const { workerSourceURL } = one as unknown as WithWorkers;
      URL.revokeObjectURL(workerSourceURL.slice(workerSourceURL.indexOf("#") + 1));
      one.dispose();
    }
    meshopt.dispose();
  };
  const isTextureDecoderMissing = () => ktx2.isMissing;
  return { manager, draco, ktx2, meshopt, isTextureDecoderMissing, dispose };
}

/** Which compressed textures the browser draws, in the form in which KTX2Loader asks for it. */
function renderSupport() {
  const context = document.createElement("canvas").getContext("webgl2");
  const found = new Map<string, unknown>();
  const get = (name: string): unknown => {
    if (!found.has(name)) found.set(name, context?.getExtension(name) ?? null);
    return found.get(name);
  };
  for (const name of TEXTURE_EXTENSIONS) get(name);
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return { extensions: { has: (name: string) => get(name) !== null, get } };
}

const TEXTURE_EXTENSIONS = [
  "WEBGL_compressed_texture_astc",
  "WEBGL_compressed_texture_etc1",
  "WEBGL_compressed_texture_etc",
  "WEBGL_compressed_texture_s3tc",
  "EXT_texture_compression_bptc",
  "WEBGL_compressed_texture_pvrtc",
  "WEBKIT_WEBGL_compressed_texture_pvrtc",
] as const;
