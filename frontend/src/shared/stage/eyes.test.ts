import { describe, expect, it } from "vitest";
import { sightAt, sightOf } from "./eyes";
import type { PointMotion } from "./motion";

const HALF = Math.SQRT1_2;
const UPRIGHT = [1, 0, 0, 0];
/** A quarter turn to the left, about y. */
const LEFTWARDS = [HALF, 0, HALF, 0];

const body = (rotations: readonly number[]): PointMotion => ({
  kind: "skeleton",
  names: ["Hips", "Head"],
  parents: [-1, 0],
  frames: 2,
  rateHz: 30,
  recordedRateHz: 90,
  positions: new Float32Array([0, 1, 0, 0, 1.6, 0, 0, 1, 0, 1, 1.6, 2]),
  // As they are stored: of any length.
  rotations: new Float32Array(rotations.map((value) => 3 * value)),
});

describe("the first person", () => {
  it("sees from between the eyes to where the head faces, a little downwards", () => {
    const sight = sightOf([0, 1.6, 0], [1, 0, 0, 0]);
    expect(sight?.fromM.map((value) => value.toFixed(2))).toEqual(["0.00", "1.69", "-0.10"]);
    expect(sight?.toM.map((value) => value.toFixed(2))).toEqual(["0.00", "1.14", "-1.10"]);
  });

  it("turns with the hips as with the head, at each frame's own place", () => {
    const turned = body([...UPRIGHT, ...LEFTWARDS, ...LEFTWARDS, ...UPRIGHT]);
    const [one, other] = [sightAt(turned, 0), sightAt(turned, 1)];
    expect(one?.fromM[0]).toBeCloseTo(-0.1, 6);
    expect(other?.fromM[0]).toBeCloseTo(1 - 0.1, 6);
    expect(other?.toM[0]).toBeCloseTo(1 - 1.1, 6);
  });

  it("is unknown where a rotation is, and without rotations", () => {
    expect(sightAt(body([...UPRIGHT, 0, 0, 0, 0, ...UPRIGHT, ...UPRIGHT]), 0)).toBeNull();
    const { rotations: _, ...positions } = body([]);
    expect(sightAt(positions, 0)).toBeNull();
  });
});
