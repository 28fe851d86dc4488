import { multiply, normalised, plus, rotate } from "@shared/rotations";
import { describe, expect, it } from "vitest";
import { composed, inverted, turned } from "./places";

const A = { positionM: [0.3, 1.2, -0.4], rotation: normalised([0.9, 0.1, -0.3, 0.2]) } as const;
const B = { positionM: [-0.05, 0.02, 0.11], rotation: normalised([0.2, -0.7, 0.5, 0.1]) } as const;

describe("a place in another's frame", () => {
  it("is, to the bit, what the rotations' own functions give", () => {
    expect(composed(A, B)).toEqual({
      positionM: plus(A.positionM, rotate(A.rotation, B.positionM)),
      rotation: normalised(multiply(A.rotation, B.rotation)),
    });
  });

  it("is the origin where it is composed with its inverse", () => {
    const { positionM, rotation } = composed(A, inverted(A));
    for (const value of positionM) expect(value).toBeCloseTo(0, 12);
    expect(rotation[0]).toBeCloseTo(1, 12);
    const half = { positionM: [0, 0, 0], rotation: turned([0, 1, 0], Math.PI / 4) } as const;
    expect(composed(half, half).rotation[2]).toBeCloseTo(Math.SQRT1_2, 12);
  });
});
