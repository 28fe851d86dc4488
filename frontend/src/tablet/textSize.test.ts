import { expect, test } from "vitest";
import { nextSize, storedSize, TEXT_SIZES } from "./textSize";

test("every press is a larger text, and after the largest comes the usual one", () => {
  const seen = [storedSize(null)];
  for (let press = 0; press < TEXT_SIZES.length; press += 1) seen.push(nextSize(seen.at(-1) ?? 1));
  expect(seen).toEqual([...TEXT_SIZES, TEXT_SIZES[0]]);
});

test("what was stored is taken up, and nonsense is the usual size", () => {
  expect(storedSize("1.2")).toBe(1.2);
  expect(storedSize("12")).toBe(1);
});
