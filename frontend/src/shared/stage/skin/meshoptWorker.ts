/** A worker that decodes buffers of meshes compressed by meshopt. */
import { MeshoptDecoder } from "three/addons/libs/meshopt_decoder.module.js";

export interface MeshoptRequest {
  readonly id: number;
  readonly count: number;
  readonly stride: number;
  readonly source: Uint8Array<ArrayBuffer>;
  readonly mode: string;
  readonly filter: string | undefined;
}

export type MeshoptResult =
  | { readonly id: number; readonly decoded: Uint8Array }
  | { readonly id: number; readonly decoded: null; readonly error: string };

self.onmessage = async ({ data }: MessageEvent<MeshoptRequest>) => {
  const { id, count, stride, source, mode, filter } = data;
  let result: MeshoptResult;
  try {
    await MeshoptDecoder.ready;
    const decoded = new Uint8Array(count * stride);
    MeshoptDecoder.decodeGltfBuffer(decoded, count, stride, source, mode, filter);
    result = { id, decoded };
  } catch (error) {
    result = { id, decoded: null, error: String(error) };
  }
  self.postMessage(result);
};
