import { expect, test } from "vitest";
import { decoded } from "./readText";

const bytes = (...values: number[]): ArrayBuffer => new Uint8Array(values).buffer;

test("a file of any usual encoding is read", () => {
  expect(decoded(bytes(0x42, 0xc3, 0xa4, 0x72))).toBe("Bär");
  expect(decoded(bytes(0x42, 0xe4, 0x72))).toBe("Bär");
  expect(decoded(bytes(0xff, 0xfe, 0x42, 0, 0xe4, 0, 0x72, 0))).toBe("Bär");
});
