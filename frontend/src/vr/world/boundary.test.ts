import { describe, expect, it } from "vitest";
import { boundaryProblem, edgeDistanceM, type FloorPoint, sizeOf } from "./boundary";

const square = (halfM: number): readonly FloorPoint[] => [
  { x: -halfM, z: -halfM },
  { x: halfM, z: -halfM },
  { x: halfM, z: halfM },
  { x: -halfM, z: halfM },
];
const NEEDED = { minX: -1, maxX: 1, minZ: -1, maxZ: 1 };
const DENTED = [...square(2).slice(0, 2), { x: 0.5, z: 0 }, ...square(2).slice(2)];

describe("the guarded space", () => {
  it("suffices if it holds all that is needed, without a dent in it", () => {
    expect(boundaryProblem(square(1.2), NEEDED)).toBeNull();
    expect(boundaryProblem(square(0.9), NEEDED)).toBe("too_small");
    expect(boundaryProblem(DENTED, NEEDED)).toBe("too_small");
    expect(boundaryProblem(null, NEEDED)).toBe("missing");
    expect(boundaryProblem([], NEEDED)).toBe("missing");
  });

  it("has an edge whose distance is negative outside, at a dent as well", () => {
    expect(edgeDistanceM({ x: 0, z: 0 }, square(2))).toBe(2);
    expect(edgeDistanceM({ x: 1.7, z: 0.5 }, square(2))).toBeCloseTo(0.3, 9);
    expect(edgeDistanceM({ x: 2.25, z: 0 }, square(2))).toBe(-0.25);
    expect(edgeDistanceM({ x: 0.4, z: 0 }, DENTED)).toBeCloseTo(0.1, 9);
  });

  it("is as wide and deep as the rectangle around it", () => {
    expect(sizeOf([...square(1), { x: -1.5, z: 0 }])).toEqual([2.5, 2]);
    expect(sizeOf(null)).toEqual([0, 0]);
  });
});
