import { expect, test } from "vitest";
import { decoded, isText } from "./readText";

const bytes = (...values: number[]): ArrayBuffer => new Uint8Array(values).buffer;

test("a file in any usual encoding is read", () => {
  expect(decoded(bytes(0x42, 0xc3, 0xa4, 0x72))).toBe("Bär");
  expect(decoded(bytes(0x42, 0xe4, 0x72))).toBe("Bär");
  expect(decoded(bytes(0xff, 0xfe, 0x42, 0, 0xe4, 0, 0x72, 0))).toBe("Bär");
});

test("a picture, a PDF and a workbook are not accepted as tables", () => {
  const png = bytes(0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0, 0, 0, 0x0d);
  expect(isText(decoded(png))).toBe(false);
  expect(isText("%PDF-1.7\n")).toBe(false);
  expect(isText(decoded(bytes(0x50, 0x4b, 3, 4, 0x14)))).toBe(false);
  expect(isText("code;q1\tq2\r\nP-1;4\t5\n")).toBe(true);
});
