/**
 * The binary telemetry batch: a 64-byte header and little-endian arrays.
 *
 * `docs/protocol.md` has the layout, `tests/vectors/wire` the bytes that this and the server's
 * implementation agree on. All arrays start at multiples of 8 bytes, so both sides read them in
 * place.
 * Samples are passed through bit by bit: a NaN keeps its payload. (Typed arrays have the byte order
 * of
 * the machine; every machine that runs a browser is little-endian.)
 */

const HEADER_BYTES = 64;
const BODY_JOINTS = 22;
const FINGER_PARTS = 30;
/** Values in a frame of a body: its root's position, then its rotations. */
export const VALUES_PER_FRAME = 3 + 4 * BODY_JOINTS;
/** Values in a frame of fingers: rotations only. */
export const FINGER_VALUES_PER_FRAME = 4 * FINGER_PARTS;
const MAX_FRAMES = 1024;
/** Frame flag: the phase's clock was running when this frame was shown. */
export const ACTIVE = 1;

const MAX_TIME_S = 1e9;
const MAX_U31 = 2 ** 31 - 1;
const MAGIC = 0x31424d52; // "RMB1"
const CODES = { target: 1, actual: 2, target_fingers: 3, actual_fingers: 4 } as const;

/**
 * `target` is the tracked pose, `actual` the remote avatar's. Those of their fingers are optional
 * streams of their own.
 */
export type StreamName = keyof typeof CODES;
/** The streams that every client sends. */
export const BODY_STREAMS = ["target", "actual"] as const satisfies readonly StreamName[];
const STREAM_NAMES = Object.keys(CODES) as readonly StreamName[];

/** The number of values in each frame of a stream. */
export function valuesPerFrame(stream: StreamName): number {
  return stream.endsWith("_fingers") ? FINGER_VALUES_PER_FRAME : VALUES_PER_FRAME;
}

/** Frames of one stream in one phase, as the headset passes them in. */
export interface Frames {
  /** The phase they belong to; 0 outside phases. */
  readonly phaseId: number;
  /** Client monotonic time of each frame, s (n). */
  readonly timesS: Float64Array;
  /** `ACTIVE` or 0 (n). */
  readonly flags: Uint8Array;
  /**
   * Of a body root position x, y, z (m, world), then 22 local rotations w, x, y, z (n x 91); of
   * fingers 30 local rotations (n x 120), NaN throughout for a hand that is not tracked.
   */
  readonly values: Float32Array;
  /** Active time of the phase at the last frame, s. */
  readonly activeS: number;
  /** Client monotonic time at which the batch was closed, s. */
  readonly closedAtS: number;
}

export interface Batch extends Frames {
  readonly stream: StreamName;
  /** The run of the client. */
  readonly epoch: number;
  /** Number of the first frame within its stream and epoch. */
  readonly seqFirst: number;
}

/**
 * Thrown for an invalid batch, given or received; the message names the field, its value, the rule.
 */
export class MalformedBatch extends Error {
  override readonly name = "MalformedBatch";
}

/** Size in bytes of the message for so many frames of a stream. */
export function batchBytes(frames: number, stream: StreamName = "target"): number {
  return valuesAt(frames) + 4 * valuesPerFrame(stream) * frames;
}

/** The message for a batch; throws MalformedBatch if the server could not use it. */
export function encodeBatch(batch: Batch): Uint8Array<ArrayBuffer> {
  requireUsable(batch);
  const count = batch.timesS.length;
  const message = new Uint8Array(batchBytes(count, batch.stream));
  message.set(bytesOf(batch.timesS), HEADER_BYTES);
  message.set(batch.flags, HEADER_BYTES + 8 * count);
  message.set(bytesOf(batch.values), valuesAt(count));
  const header = new DataView(message.buffer);
  header.setUint32(0, MAGIC, true);
  header.setUint16(4, HEADER_BYTES, true);
  header.setUint8(6, CODES[batch.stream]);
  header.setUint32(8, batch.epoch, true);
  header.setUint32(12, batch.phaseId, true);
  header.setBigUint64(16, BigInt(batch.seqFirst), true);
  header.setUint16(24, count, true);
  header.setUint16(26, valuesPerFrame(batch.stream), true);
  header.setUint32(28, crc32(message.subarray(HEADER_BYTES)), true);
  header.setFloat64(32, batch.activeS, true);
  header.setFloat64(40, batch.closedAtS, true);
  return message;
}

/**
 * Throw MalformedBatch unless the server could use the batch: once journaled, an invalid one would
 * be rejected forever.
 */
function requireUsable(batch: Batch): void {
  const { timesS, flags, values } = batch;
  const count = timesS.length;
  const width = valuesPerFrame(batch.stream);
  if (flags.length !== count || values.length !== count * width) {
    throw new MalformedBatch(
      `${count} times, ${flags.length} flags, ${values.length} values; expected n, n, ${width} n`,
    );
  }
  requireRange("frame count", count, 1, MAX_FRAMES);
  requireRange("epoch", batch.epoch, 0, 2 ** 32 - 1);
  requireRange("phase_id", batch.phaseId, 0, MAX_U31);
  requireRange("seq", batch.seqFirst, 0, Number.MAX_SAFE_INTEGER - count);
  requireTimes(batch.activeS, batch.closedAtS);
}

/**
 * The batch in `message`, its arrays in place; throws MalformedBatch also if the checksum is wrong.
 */
export function decodeBatch(message: Uint8Array<ArrayBuffer>): Batch {
  // Float64Array reads in place only from multiples of 8.
  const bytes = message.byteOffset % 8 === 0 ? message : message.slice();
  if (bytes.length < HEADER_BYTES) {
    throw new MalformedBatch(
      `message of ${bytes.length} bytes; a batch has ${HEADER_BYTES} and more`,
    );
  }
  const header = new DataView(bytes.buffer, bytes.byteOffset, HEADER_BYTES);
  const { stream, count } = readShape(header, bytes.length);
  const crc = crc32(bytes.subarray(HEADER_BYTES));
  const expected = header.getUint32(28, true);
  if (crc !== expected) throw new MalformedBatch(`checksum ${crc}; the header says ${expected}`);
  const at = (offset: number) => bytes.byteOffset + offset;
  return {
    stream,
    epoch: header.getUint32(8, true),
    phaseId: header.getUint32(12, true),
    seqFirst: Number(header.getBigUint64(16, true)),
    activeS: header.getFloat64(32, true),
    closedAtS: header.getFloat64(40, true),
    timesS: new Float64Array(bytes.buffer, at(HEADER_BYTES), count),
    flags: new Uint8Array(bytes.buffer, at(HEADER_BYTES + 8 * count), count),
    values: new Float32Array(bytes.buffer, at(valuesAt(count)), count * valuesPerFrame(stream)),
  };
}

function readShape(header: DataView, length: number): { stream: StreamName; count: number } {
  if (header.getUint32(0, true) !== MAGIC) throw new MalformedBatch("magic is not RMB1");
  requireRange("header length", header.getUint16(4, true), HEADER_BYTES, HEADER_BYTES);
  const code = header.getUint8(6);
  const stream = STREAM_NAMES.find((name) => CODES[name] === code);
  if (stream === undefined) throw new MalformedBatch(`stream code ${code}; valid are 1 to 4`);
  const count = header.getUint16(24, true);
  requireRange("frame count", count, 1, MAX_FRAMES);
  const width = valuesPerFrame(stream);
  requireRange("values per frame", header.getUint16(26, true), width, width);
  requireRange("phase_id", header.getUint32(12, true), 0, MAX_U31);
  requireRange("seq", Number(header.getBigUint64(16, true)), 0, Number.MAX_SAFE_INTEGER);
  requireTimes(header.getFloat64(32, true), header.getFloat64(40, true));
  const bytes = batchBytes(count, stream);
  requireRange(`bytes of ${count} frames`, length, bytes, bytes);
  return { stream, count };
}

function requireTimes(activeS: number, closedAtS: number): void {
  const times = [
    ["active_s", activeS],
    ["closed_at_s", closedAtS],
  ] as const;
  for (const [name, timeS] of times) {
    // Written so that NaN is caught too.
    if (!(timeS >= 0 && timeS <= MAX_TIME_S)) {
      throw new MalformedBatch(`${name} ${timeS}; expected 0 to ${MAX_TIME_S} s`);
    }
  }
}

function requireRange(what: string, value: number, least: number, most: number): void {
  if (!Number.isInteger(value) || value < least || value > most) {
    throw new MalformedBatch(`${what} ${value}; valid are whole numbers from ${least} to ${most}`);
  }
}

const valuesAt = (count: number): number => HEADER_BYTES + 8 * count + 8 * Math.ceil(count / 8);

const bytesOf = (array: Float64Array | Float32Array): Uint8Array =>
  new Uint8Array(array.buffer, array.byteOffset, array.byteLength);

/**
 * CRC-32 as in zlib and PNG (polynomial 0xEDB88320, reflected) of `bytes`, as an unsigned number.
 */
export function crc32(bytes: Uint8Array): number {
  let crc = 0xffffffff;
  for (const byte of bytes) crc = (TABLE[(crc ^ byte) & 0xff] ?? 0) ^ (crc >>> 8);
  return (crc ^ 0xffffffff) >>> 0;
}

const POLYNOMIAL = 0xedb88320;

const TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let remainder = byte;
  for (let bit = 0; bit < 8; bit++) {
    remainder = remainder & 1 ? (remainder >>> 1) ^ POLYNOMIAL : remainder >>> 1;
  }
  return remainder;
});
