/** Frames of a body in rest pose, with noise, for tests. */
import { type Frames, VALUES_PER_FRAME } from "../wire/batch";

export function standing(count: number, firstS = 0, phaseId = 0): Frames {
  const values = new Float32Array(count * VALUES_PER_FRAME);
  for (let frame = 0; frame < count; frame++) {
    const at = frame * VALUES_PER_FRAME;
    values[at + 1] = 1;
    for (let joint = 0; joint < 22; joint++) values[at + 3 + 4 * joint] = 1;
  }
  const timesS = Float64Array.from({ length: count }, (_, frame) => firstS + frame / 90);
  const flags = new Uint8Array(count);
  return { phaseId, timesS, flags, values, activeS: 0, closedAtS: firstS + count / 90 };
}

/** A reproducible generator of whole numbers below 2^32. */
export function seeded(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x9e3779b9) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 16), 0x85ebca6b);
    mixed = Math.imul(mixed ^ (mixed >>> 13), 0xc2b2ae35);
    return (mixed ^ (mixed >>> 16)) >>> 0;
  };
}
