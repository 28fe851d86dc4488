/** The messages of the socket that shows a companion (docs/protocol.md, section 13). */
import * as v from "valibot";

const Message = v.object({
  type: v.literal("companion_state"),
  /** Somebody shall be shown; if not, the rest has no meaning. */
  chosen: v.boolean(),
  stature_m: v.number(),
  /** Content hash of the body's model; null for a plain body. */
  model: v.nullable(v.string()),
  in_tasks: v.boolean(),
});
export type CompanionState = v.InferOutput<typeof Message>;

const MAGIC = "RLC1";

/** The message in a text; null for one that this version does not know. */
export function companionState(text: string): CompanionState | null {
  try {
    return v.parse(Message, JSON.parse(text));
  } catch {
    return null;
  }
}

/**
 * The pose in a binary message: the place of the hips in the room, then the rotation w, x, y, z of
 * each of the 22 joints in its parent's frame. Null if the bytes are not `values` numbers.
 */
export function companionPose(bytes: ArrayBuffer, values: number): Float32Array | null {
  if (bytes.byteLength !== MAGIC.length + 4 * values) return null;
  if (String.fromCharCode(...new Uint8Array(bytes, 0, MAGIC.length)) !== MAGIC) return null;
  const view = new DataView(bytes, MAGIC.length);
  return Float32Array.from({ length: values }, (_, at) => view.getFloat32(4 * at, true));
}
