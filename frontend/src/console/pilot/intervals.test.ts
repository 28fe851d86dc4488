import { expect, test } from "vitest";
import { interval, listed } from "./intervals";

test("where commas are decimal, semicolons are between numbers", () => {
  expect(interval("0.225", "0.280", "en")).toBe("[0.225, 0.280]");
  expect(interval("0,225", "0,280", "de")).toBe("[0,225; 0,280]");
  expect(listed([1, 2], "de", String)).toBe("1; 2");
});
