import { describe, expect, it } from "vitest";
import { seeded, standing } from "../testing/frames";
import { type Batch, crc32, decodeBatch, encodeBatch, VALUES_PER_FRAME } from "./batch";

const batchOf = (count: number, changed: Partial<Batch> = {}): Batch => ({
  ...standing(count),
  stream: "target",
  epoch: 1,
  seqFirst: 0,
  ...changed,
});

describe("a batch", () => {
  it("is decoded to what was encoded, whatever the bits", () => {
    const random = seeded(7);
    for (let round = 0; round < 50; round++) {
      const count = 1 + (random() % 20);
      const bits = Uint32Array.from({ length: count * VALUES_PER_FRAME }, random);
      const flags = Uint8Array.from({ length: count }, random);
      const sent = batchOf(count, {
        stream: round % 2 === 0 ? "target" : "actual",
        seqFirst: random() * 2 ** 20,
        epoch: random(),
        phaseId: random() >>> 1,
        flags,
        values: new Float32Array(bits.buffer),
      });
      const got = decodeBatch(encodeBatch(sent));
      const gotBits = new Uint32Array(got.values.buffer, got.values.byteOffset, bits.length);
      expect(gotBits).toEqual(bits);
      expect({ ...got, values: null }).toEqual({ ...sent, values: null });
    }
  });

  it("is read in place, also from the middle of a larger buffer", () => {
    const message = encodeBatch(batchOf(3));
    expect(decodeBatch(message).values.buffer).toBe(message.buffer);
    const shifted = new Uint8Array(message.length + 1);
    shifted.set(message, 1);
    expect(decodeBatch(shifted.subarray(1))).toEqual(decodeBatch(message));
  });

  it("does not change when the arrays it was made from are filled again", () => {
    const frames = batchOf(2);
    const message = encodeBatch(frames);
    frames.values.fill(9);
    frames.timesS.fill(9);
    expect(decodeBatch(message).values[1]).toBe(1);
    expect(decodeBatch(message).timesS[0]).toBe(0);
  });

  it.each<[string, Partial<Batch>]>([
    ["frame count 0", { ...standing(0) }],
    ["frame count 1025", { ...standing(1025) }],
    ["n, n, 91 n", { flags: new Uint8Array(3) }],
    ["n, n, 91 n", { values: new Float32Array(2 * 90) }],
    ["active_s NaN", { activeS: Number.NaN }],
    ["active_s -0.5", { activeS: -0.5 }],
    ["closed_at_s Infinity", { closedAtS: Number.POSITIVE_INFINITY }],
    ["phase_id 2147483648", { phaseId: 2 ** 31 }],
    ["phase_id 1.5", { phaseId: 1.5 }],
    ["seq -1", { seqFirst: -1 }],
    ["seq 9007199254740992", { seqFirst: 2 ** 53 }],
  ])("that the server could not use is rejected: %s", (title, changed) => {
    expect(() => encodeBatch(batchOf(2, changed))).toThrow(title);
  });
});

describe("the checksum", () => {
  it("is the one of zlib", () => {
    // The check value of CRC-32/ISO-HDLC in the catalogue of CRC algorithms.
    expect(crc32(new TextEncoder().encode("123456789"))).toBe(0xcbf43926);
    expect(crc32(new Uint8Array(0))).toBe(0);
  });

  it("detects every flipped bit", () => {
    const message = encodeBatch(batchOf(1));
    for (let at = 64; at < message.length; at += 7) {
      const broken = message.slice();
      broken[at] = (broken[at] ?? 0) ^ (1 << (at % 8));
      expect(() => decodeBatch(broken)).toThrow("checksum");
    }
  });
});
