import { describe, expect, it } from "vitest";
import { type AvatarFile, differences } from "../axes";
import {
  byGroup,
  gainsOf,
  isAccepted,
  isInWork,
  toPutBack,
  toTake,
  tunedFor,
  withGainsOf,
} from "./choice";
import type { TunedAxis } from "./tunings";

const own = {
  kp_nm_per_rad: 100,
  kd_nm_s_per_rad: 5,
  max_torque_nm: 50,
  low_deg: -10,
  high_deg: 20,
};
const locked = { ...own, low_deg: 0, high_deg: 0 };
const work = {
  total_mass_kg: 72,
  locked_groups: ["RightHand"],
  axes: {
    SpineX: own,
    LeftLowerArmX: locked,
    LeftLowerArmY: own,
    LeftHandX: own,
    RightLowerArmY: own,
    RightHandX: own,
  },
} as unknown as AvatarFile;

const tuned = (name: string, kp: number, status = "tuned") =>
  ({ name, status, kp_before: 100, kd_before: 5, kp, kd: 5 }) as TunedAxis;
const rows = [
  tuned("SpineX", 200),
  tuned("LeftHandX", 300, "flagged"),
  tuned("LeftLowerArmY", 100),
];
const names = (axes: readonly TunedAxis[]) => axes.map(({ name }) => name);
const taken = {
  ...work,
  axes: { ...work.axes, SpineX: { ...own, kp_nm_per_rad: 200 } },
} as AvatarFile;

describe("accepting and rejecting", () => {
  it("suggests all but doubtful axes, and follows what was chosen", () => {
    expect(rows.map((axis) => isAccepted(axis, {}))).toEqual([true, false, true]);
    expect(rows.map((axis) => isAccepted(axis, { SpineX: false, LeftHandX: true }))).toEqual([
      false,
      true,
      true,
    ]);
    expect(isAccepted({ ...tuned("SpineX", 1), kp: null }, { SpineX: true })).toBe(false);
  });

  it("takes over only what the work does not have yet", () => {
    expect(names(toTake(work, rows, {}))).toEqual(["SpineX"]);
    expect(names(toTake(taken, rows, {}))).toEqual([]);
    expect(isInWork(taken, tuned("SpineX", 200))).toBe(true);
    expect(names(toTake(work, [tuned("NoSuchX", 200)], {}))).toEqual([]);
  });

  it("puts a rejected axis back whose gains were taken over, and no other", () => {
    expect(names(toPutBack(work, rows, { SpineX: false }))).toEqual([]);
    const back = toPutBack(taken, rows, { SpineX: false, LeftLowerArmY: false });
    expect(names(back)).toEqual(["SpineX"]);
    expect(gainsOf(back, "before")).toEqual([
      { operation: "set_gains", targets: ["SpineX"], kp_nm_per_rad: 100, kd_nm_s_per_rad: 5 },
    ]);
  });
});

describe("what was tuned", () => {
  it("counts the axes that can turn, with the other side's where they are mirrored", () => {
    const arm = ["LeftLowerArmX", "LeftLowerArmY", "LeftHandX"];
    expect(tunedFor(work, arm, false)).toEqual(["LeftLowerArmY", "LeftHandX"]);
    expect(tunedFor(work, arm, true)).toEqual(["LeftLowerArmY", "LeftHandX", "RightLowerArmY"]);
  });

  it("differs from the work only in values that are no gains", () => {
    const heavier = { ...taken, total_mass_kg: 80 };
    const found = differences(withGainsOf(heavier, work), heavier);
    expect(found.map(({ path }) => path)).toEqual([["total_mass_kg"]]);
  });
});

it("sums figures up by body group as their root mean square", () => {
  expect(byGroup({ LeftHandX: 3, LeftLowerArmY: 4, SpineX: 2 })).toEqual([
    ["trunk", 2],
    ["left_arm", Math.sqrt(12.5)],
  ]);
});
