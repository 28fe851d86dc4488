import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { withArms } from "./arms";
import { type BodyBinding, Parts } from "./pose";

const FOLDER = resolve(import.meta.dirname, "../../../../../tests/vectors/skin");
const { binding }: { binding: BodyBinding } = JSON.parse(
  readFileSync(resolve(FOLDER, "skin.json"), "utf8"),
);
const STATURE_M = 1.62;
const ARMS_M = { upper_arm: 0.25, forearm: 0.31 };
const SCALE = STATURE_M / binding.stature_m;

type Point = readonly number[];

/** The places of the joints of somebody of this stature in the T-pose. */
function places(of: BodyBinding): (part: string) => Point {
  const { parts, parents } = of;
  const placed = new Parts(of, SCALE, { joints: parts, parents });
  const values = new Float64Array(3 + 4 * parts.length);
  values.set((of.joints_m[0] ?? []).map((value) => SCALE * value));
  for (let at = 3; at < values.length; at += 4) values[at] = 1;
  placed.place(values);
  return (part) => [...placed.places.subarray(3 * parts.indexOf(part)).subarray(0, 3)];
}

const between = (from: Point, to: Point): Point => to.map((value, at) => value - (from[at] ?? 0));

/** A point of a part's frame, from the frame of the part's node. */
function inPart(of: BodyBinding, part: string, node: Point): Point {
  const rows = of.part_from_node[of.parts.indexOf(part)] ?? [];
  const at = (row: number, column: number): number => rows[4 * row + column] ?? 0;
  return [0, 1, 2].map((row) =>
    [0, 1, 2].reduce((sum, column) => sum + at(row, column) * (node[column] ?? 0), at(row, 3)),
  );
}

/** The same point in the frame of the part's node. */
function inNode(of: BodyBinding, part: string, point: Point): Point {
  const origin = inPart(of, part, [0, 0, 0]);
  const sizes = [0, 1, 2].map((axis) => {
    const unit = [0, 0, 0].map((zero, at) => (at === axis ? 1 : zero));
    return between(origin, inPart(of, part, unit));
  });
  // Solve by Cramer's rule.
  const [a = [], b = [], c = []] = sizes;
  const cross = (u: Point, v: Point): Point =>
    [0, 1, 2].map((at) => {
      const [i, j] = [(at + 1) % 3, (at + 2) % 3];
      return (u[i] ?? 0) * (v[j] ?? 0) - (u[j] ?? 0) * (v[i] ?? 0);
    });
  const dot = (u: Point, v: Point): number =>
    u.reduce((sum, one, at) => sum + one * (v[at] ?? 0), 0);
  const from = between(origin, point);
  const whole = dot(a, cross(b, c));
  return [dot(from, cross(b, c)), dot(from, cross(c, a)), dot(from, cross(a, b))].map(
    (one) => one / whole,
  );
}

describe("arms of another length", () => {
  const fitted = withArms(binding, STATURE_M, ARMS_M);
  const [own, given] = [places(binding), places(fitted)];

  it.each(["Left", "Right"])("puts elbow and wrist of the %s arm where they belong", (side) => {
    const length = (from: string, to: string): number =>
      Math.hypot(...between(given(side + from), given(side + to)));
    expect(length("UpperArm", "LowerArm")).toBeCloseTo(ARMS_M.upper_arm, 9);
    expect(length("LowerArm", "Hand")).toBeCloseTo(ARMS_M.forearm, 9);
    expect(given(`${side}UpperArm`)).toEqual(own(`${side}UpperArm`));
    const finger = fitted.parts.find((part) => part.startsWith(`${side}Middle`)) ?? `${side}Hand`;
    const reach = (of: typeof own) => between(of(`${side}Hand`), of(finger));
    for (const [axis, value] of reach(own).entries()) {
      expect(reach(given)[axis]).toBeCloseTo(value, 9);
    }
  });

  it.each([
    ["LeftUpperArm", "LeftLowerArm", "upper_arm"],
    ["RightLowerArm", "RightHand", "forearm"],
  ] as const)("stretches the skin of %s along its bone only", (part, end, segment) => {
    const at = (of: BodyBinding, name: string): Point => of.joints_m[of.parts.indexOf(name)] ?? [];
    const bone = between(at(binding, part), at(binding, end));
    const length = Math.hypot(...bone);
    const ratio = ARMS_M[segment] / SCALE / length;
    const aside: Point = [0.01, 0.03, -0.02];
    const point = bone.map((value, axis) => 0.5 * value + (aside[axis] ?? 0));
    const along = point.reduce((sum, value, axis) => sum + value * (bone[axis] ?? 0), 0);
    const moved = inPart(fitted, part, inNode(binding, part, point));
    for (let axis = 0; axis < 3; axis++) {
      const expected =
        (point[axis] ?? 0) + ((ratio - 1) * along * (bone[axis] ?? 0)) / (length * length);
      expect(moved[axis]).toBeCloseTo(expected, 9);
    }
  });

  it("leaves everything else as it is", () => {
    expect(withArms(binding, STATURE_M, {})).toEqual(binding);
    for (const part of ["Hips", "Head", "LeftFoot"]) expect(given(part)).toEqual(own(part));
  });
});
