import { expect, test } from "vitest";
import { nextSize, storedSize, TEXT_SIZES } from "./textSize";

test("each press enlarges the text, and after the largest size comes the usual one", () => {
  const seen = [storedSize(null)];
  for (let press = 0; press < TEXT_SIZES.length; press += 1) seen.push(nextSize(seen.at(-1) ?? 1));
  expect(seen).toEqual([...TEXT_SIZES, TEXT_SIZES[0]]);
});

test("a stored size is restored, and an invalid one becomes the usual size", () => {
  expect(storedSize("1.2")).toBe(1.2);
  expect(storedSize("12")).toBe(1);
});
