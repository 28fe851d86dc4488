import { AXES, PARTS } from "@shared/avatar/anatomy.generated";
import { describe, expect, it } from "vitest";
import { type AvatarFile, axesOf, differences, isCast, passes, SECTIONS, sectionOf } from "./axes";
import { begun, reached, redone, undone } from "./history";

const settings = {
  kp_nm_per_rad: 100,
  kd_nm_s_per_rad: 5,
  max_torque_nm: 50,
  low_deg: -10,
  high_deg: 20,
};
const file = {
  format: "reembody-avatar",
  version: 1,
  total_mass_kg: 72,
  locked_groups: [],
  held_deg: {},
  axes: Object.fromEntries(AXES.map(({ name }) => [name, settings])),
} as unknown as AvatarFile;

describe("the sections of the table", () => {
  it("hold each of the 91 axes once, 29 of them in an arm with its fingers", () => {
    const counted = SECTIONS.map(
      (section) => AXES.filter(({ part }) => sectionOf(part) === section).length,
    );
    expect(counted.reduce((sum, count) => sum + count)).toBe(91);
    expect(counted).toEqual([9, 6, 9, 20, 9, 9, 20, 9]);
    expect(PARTS.every(({ name }) => SECTIONS.includes(sectionOf(name)))).toBe(true);
  });

  it("name groups that may overlap", () => {
    expect(axesOf(file, "left_foot")).toEqual(["LeftFootX", "LeftFootZ", "LeftFootY", "LeftToesX"]);
    expect(axesOf(file, "trunk_head").length).toBe(15);
    expect(axesOf(file, "LeftHand").length).toBe(3);
    expect(axesOf(file, "all").length).toBe(91);
  });
});

describe("what differs between configurations", () => {
  const changed = {
    ...file,
    total_mass_kg: 60,
    locked_groups: ["LeftHand"],
    axes: { ...file.axes, HeadX: { ...settings, low_deg: 20 } },
  };

  it("is listed by its place with both values", () => {
    expect(differences(file, file)).toEqual([]);
    expect(differences(file, changed)).toEqual([
      { path: ["total_mass_kg"], before: 72, after: 60 },
      { path: ["locked_groups"], before: [], after: ["LeftHand"] },
      { path: ["axes", "HeadX", "low_deg"], before: -10, after: 20 },
    ]);
  });

  it("counts what a file leaves out: groups that are stiff, and parts without a delay", () => {
    const soft = {
      ...file,
      delays_ms: { LeftHand: 50 },
      compliance: { left_leg: { stiffness_percent: 10, targets: "joint" } },
    } as AvatarFile;
    expect(differences(file, soft)).toEqual([
      { path: ["delays_ms", "LeftHand"], before: undefined, after: 50 },
      { path: ["compliance", "left_leg", "stiffness_percent"], before: 100, after: 10 },
    ]);
    expect(differences(soft, { ...soft, compliance: null })).toEqual([
      { path: ["compliance", "left_leg", "stiffness_percent"], before: 10, after: 100 },
    ]);
  });

  it("can be filtered, as can casts and equal limits", () => {
    const shown = (filter: "changed" | "cast" | "locked") =>
      AXES.map(({ name }) => name).filter((axis) => passes(filter, changed, file, axis));
    expect(shown("changed")).toEqual(["HeadX"]);
    expect(shown("locked")).toEqual(["HeadX"]);
    expect(shown("cast")).toEqual(["LeftHandX", "LeftHandY", "LeftHandZ"]);
    expect(isCast(changed, "LeftThumbDistalY")).toBe(false);
  });
});

describe("the history", () => {
  it("goes back and forth through the same states, and forgets what a new edit replaces", () => {
    const three = reached(reached(begun("a"), "b"), "c");
    expect(undone(undone(three))).toEqual({ past: [], now: "a", future: ["b", "c"] });
    expect(redone(redone(undone(undone(three))))).toEqual(three);
    expect(undone(begun("a"))).toEqual(begun("a"));
    expect(reached(undone(three), "d")).toEqual({ past: ["a", "b"], now: "d", future: [] });
  });
});
