import { expect, it } from "vitest";
import { pullOf, STRONGEST_N, strengthOf } from "./pulling";

it("pulls like a spring of 600 N/m towards the pointer, with at most 300 N", () => {
  expect(pullOf([0, 1, 0], [0.1, 1, 0])).toEqual([60, 0, 0]);
  const strong = pullOf([0, 0, 0], [3, 4, 0]);
  expect(strengthOf(strong)).toBeCloseTo(STRONGEST_N, 9);
  expect((strong[1] as number) / (strong[0] as number)).toBeCloseTo(4 / 3, 9);
});
