import { AXES, PARTS } from "@shared/avatar/anatomy.generated";
import { cross, dot, length, type Vector } from "@shared/rotations";
import { type BodyBinding, Parts } from "@shared/stage/skin/pose";
import { describe, expect, it } from "vitest";
import type { AvatarFile } from "./axes";
import { angleAt, angleOf, JOINTS, onArc, PARENTS, placedAxes, poseValues } from "./pose";

/** A body whose arms lie along x and whose other parts are above each other. */
const PLACES: Readonly<Record<string, Vector>> = {
  Hips: [0, 1, 0],
  LeftShoulder: [-0.1, 1.4, 0],
  LeftUpperArm: [-0.2, 1.4, 0],
  LeftLowerArm: [-0.5, 1.4, 0],
  LeftHand: [-0.75, 1.4, 0],
};
const binding: BodyBinding = {
  stature_m: 1.75,
  parts: JOINTS,
  parents: PARENTS,
  joints_m: PARTS.map(({ name }, index) => PLACES[name] ?? [0, 1 + index / 100, 0]),
  nodes: JOINTS.map((_, index) => index),
  part_from_node: [],
};
const file = {
  held_deg: { HeadX: 12 },
  axes: Object.fromEntries(
    AXES.map(({ name, lowRad, highRad }) => [
      name,
      { low_deg: (lowRad * 180) / Math.PI, high_deg: (highRad * 180) / Math.PI },
    ]),
  ),
} as unknown as AvatarFile;

function standing(angles: ReadonlyMap<string, number>) {
  const parts = new Parts(binding, 1, { joints: JOINTS, parents: PARENTS });
  expect(parts.place(poseValues(file, angles, [0, 1, 0]))).toBe(true);
  const at = (part: string) =>
    parts.places.slice(3 * JOINTS.indexOf(part), 3 * JOINTS.indexOf(part) + 3);
  return { parts, at, axes: placedAxes(file, angles, binding, parts) };
}

describe("the pose of the editor's body", () => {
  it("keeps angles within limits, and casts at their own", () => {
    expect(angleOf(file, new Map([["LeftLowerArmY", 200]]), "LeftLowerArmY")).toBeCloseTo(150);
    expect(angleOf(file, new Map([["HeadX", -5]]), "HeadX")).toBe(12);
    expect(angleOf(file, new Map(), "LeftLowerArmY")).toBe(0);
  });

  it("brings the left hand ahead of the elbow when the elbow bends by 90 degrees", () => {
    const { at } = standing(new Map([["LeftLowerArmY", 90]]));
    // The body faces -z.
    expect([...at("LeftHand")].map((value) => Math.round(1e3 * value) / 1e3)).toEqual([
      -0.5, 1.4, -0.25,
    ]);
  });

  it("draws each arc in the plane of its axis, with its needle along the part", () => {
    const { axes, at } = standing(
      new Map([
        ["LeftUpperArmZ", 30],
        ["LeftUpperArmX", 20],
        ["LeftLowerArmY", 70],
      ]),
    );
    expect(axes.size).toBe(91);
    for (const placed of axes.values()) {
      expect(dot(placed.direction, placed.zero)).toBeCloseTo(0, 6);
      expect(length(cross(placed.direction, placed.zero))).toBeCloseTo(1, 6);
      for (const angle of [-170, -30, 0, 45]) {
        expect(angleAt(placed, onArc(placed, angle))).toBeCloseTo(angle, 6);
      }
    }
    const elbow = axes.get("LeftLowerArmY");
    if (elbow === undefined) throw new Error("no elbow");
    const end = onArc(elbow, elbow.angleDeg, 0.25);
    [...at("LeftHand")].forEach((value, axis) => {
      expect(end[axis]).toBeCloseTo(value, 5);
    });
  });
});
