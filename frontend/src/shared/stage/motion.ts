/**
 * Points over time, as a stage draws them: the joints of a skeleton, markers, or rigid bodies.
 *
 * The world is y up and right-handed, in metres. A point that was not seen is NaN.
 */
import { type Seconds, seconds } from "../units";

export type PointKind = "skeleton" | "markers" | "bodies";

export interface PointMotion {
  readonly kind: PointKind;
  readonly names: readonly string[];
  /** Index of each point's parent, -1 for none. */
  readonly parents: readonly number[];
  readonly frames: number;
  readonly rateHz: number;
  /** The rate of the recording, before frames were left out for drawing. */
  readonly recordedRateHz: number;
  /** x, y, z in metres: [frame][point][axis]. */
  readonly positions: Float32Array;
  /**
   * w, x, y, z of each joint's rotation in its parent's frame, of any length but zero where it is
   * unknown: [frame][joint][wxyz]. Left out where only positions are known.
   */
  readonly rotations?: Float32Array | Int16Array;
  /**
   * The same of the finger parts (`FINGER_PARTS`), [frame][part][wxyz], relative to the part above
   * and to the T-pose, where they were recorded; zeros where unknown.
   */
  readonly fingers?: Float32Array | Int16Array;
}

/** A skeleton at one moment, whose positions are written in place as it moves. */
export const momentOf = (
  { joints, parents }: { readonly joints: readonly string[]; readonly parents: readonly number[] },
  positions: Float32Array,
): PointMotion => ({
  kind: "skeleton",
  names: joints,
  parents,
  frames: 1,
  rateHz: 1,
  recordedRateHz: 1,
  positions,
});

/** Thrown if the bytes are not a movement: truncated, or of another format. */
export class MotionError extends Error {
  override readonly name = "MotionError";
}

interface Header {
  readonly kind: PointKind;
  readonly names: readonly string[];
  readonly parents: readonly number[];
  readonly frames: number;
  readonly rate_hz: number;
  readonly recorded_rate_hz: number;
  readonly rotations?: boolean;
}

/**
 * Decode the server's format: the header's length, the header as JSON, then float32, all
 * little-endian.
 *
 * Throws MotionError if the bytes do not match the header.
 */
export function decodeMotion(bytes: ArrayBuffer): PointMotion {
  const { header, numbers } = splitMovement(bytes, countOf);
  const places = placesOf(header);
  return {
    kind: header.kind,
    names: header.names,
    parents: header.parents,
    frames: header.frames,
    rateHz: header.rate_hz,
    recordedRateHz: header.recorded_rate_hz,
    positions: numbers.subarray(0, places),
    ...(header.rotations === true ? { rotations: numbers.subarray(places) } : {}),
  };
}

const placesOf = ({ frames, names }: Header): number => frames * names.length * 3;

const countOf = (header: Header): number =>
  placesOf(header) + (header.rotations === true ? 4 * header.frames * header.names.length : 0);

/**
 * Split a movement in the server's format into its header, the numbers that it announces, and the
 * integers of 16 bits that may follow them.
 */
export function splitMovement<Header>(
  bytes: ArrayBuffer,
  countOf: (header: Header) => number,
  integersOf: (header: Header) => number = () => 0,
): { readonly header: Header; readonly numbers: Float32Array; readonly integers: Int16Array } {
  if (bytes.byteLength < 4) throw new MotionError(`${bytes.byteLength} bytes are not a movement.`);
  const length = new DataView(bytes).getUint32(0, true);
  if (4 + length > bytes.byteLength) {
    throw new MotionError(`The header should have ${length} bytes; the answer has fewer.`);
  }
  const header = headerOf<Header>(new Uint8Array(bytes, 4, length));
  const expected = countOf(header);
  const integers = integersOf(header);
  const actual = (bytes.byteLength - 4 - length - 2 * integers) / 4;
  if (actual !== expected) {
    throw new MotionError(`Expected ${expected} numbers after the header, got ${actual}.`);
  }
  return {
    header,
    numbers: numbersFrom(bytes, 4 + length, expected),
    integers: integersFrom(bytes, 4 + length + 4 * expected, integers),
  };
}

function headerOf<Header>(bytes: Uint8Array): Header {
  try {
    return JSON.parse(new TextDecoder().decode(bytes)) as Header;
  } catch (cause) {
    throw new MotionError("The header is not valid JSON.", { cause });
  }
}

function numbersFrom(bytes: ArrayBuffer, from: number, count: number): Float32Array {
  if (from % 4 === 0 && isLittleEndian()) return new Float32Array(bytes, from, count);
  const view = new DataView(bytes, from);
  return Float32Array.from({ length: count }, (_, index) => view.getFloat32(4 * index, true));
}

function integersFrom(bytes: ArrayBuffer, from: number, count: number): Int16Array {
  const view = new DataView(bytes, from);
  return Int16Array.from({ length: count }, (_, index) => view.getInt16(2 * index, true));
}

const isLittleEndian = (): boolean => new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

/** The time of the last frame; zero for a single frame. */
export const durationOf = (motion: PointMotion): Seconds =>
  seconds(Math.max(0, motion.frames - 1) / motion.rateHz);

/** The frame nearest to a time. */
export function frameAt(motion: PointMotion, time: Seconds): number {
  // A time that was computed from a frame must lead back to it.
  const frame = Math.round(time * motion.rateHz + 1e-6);
  return Math.min(Math.max(frame, 0), Math.max(0, motion.frames - 1));
}

export const timeOf = (motion: PointMotion, frame: number): Seconds =>
  seconds(frame / motion.rateHz);

/** The frame's number in the recording, counted from 0. */
export const recordedFrame = (motion: PointMotion, frame: number): number =>
  Math.round((frame / motion.rateHz) * motion.recordedRateHz);

/**
 * Recorded frames from one drawn frame to the next: of a fast recording, the server leaves frames
 * out for drawing, so that a step of the picture is several of the recording.
 */
export const drawnEvery = ({ rateHz, recordedRateHz }: PointMotion): number =>
  Math.max(1, Math.round(recordedRateHz / rateHz));

export interface Box {
  readonly min: readonly [x: number, y: number, z: number];
  readonly max: readonly [x: number, y: number, z: number];
}

/** The bounding box of all seen points of all frames; null if nothing was ever seen. */
export function boxOf(motion: PointMotion): Box | null {
  const min: [number, number, number] = [Infinity, Infinity, Infinity];
  const max: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  const { positions } = motion;
  for (let at = 0; at < positions.length; at += 3) {
    for (let axis = 0; axis < 3; axis++) {
      const value = positions[at + axis] ?? Number.NaN;
      // NaN is neither smaller nor larger than anything.
      if (value < (min[axis] ?? 0)) min[axis] = value;
      if (value > (max[axis] ?? 0)) max[axis] = value;
    }
  }
  return Number.isFinite(min[0]) ? { min, max } : null;
}

/** The largest side of one frame's bounding box; for a body about its height. */
export function sizeOf(motion: PointMotion): number {
  const points = motion.names.length;
  const every = Math.max(1, Math.floor(motion.frames / 20));
  let largest = 0;
  for (let frame = 0; frame < motion.frames; frame += every) {
    const from = frame * points * 3;
    const one = { ...motion, positions: motion.positions.subarray(from, from + points * 3) };
    const box = boxOf(one);
    if (box === null) continue;
    for (let axis = 0; axis < 3; axis++) {
      largest = Math.max(largest, (box.max[axis] ?? 0) - (box.min[axis] ?? 0));
    }
  }
  return largest;
}
