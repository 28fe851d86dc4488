import { describe, expect, it } from "vitest";
import { changeOf, grouped } from "./differing";

const at = (...path: string[]) => ({ path, before: 1, after: 2 });

describe("what two versions differ in", () => {
  it("is told with the difference and its share, where both are numbers", () => {
    expect(changeOf({ before: 200, after: 150 }, "en")).toEqual(["−50", "−25"]);
    expect(changeOf({ before: -10, after: -5 }, "en")).toEqual(["+5", "+50"]);
    expect(changeOf({ before: 0, after: 5 }, "en")).toEqual(["+5", ""]);
    expect(changeOf({ before: undefined, after: 5 }, "en")).toEqual(["", ""]);
    expect(changeOf({ before: "average", after: "female" }, "en")).toEqual(["", ""]);
  });

  it("stands by body group, the whole body first", () => {
    const rows = [
      at("axes", "RightLowerLegX", "kp_nm_per_rad"),
      at("axes", "LeftHandX", "low_deg"),
      at("compliance", "left_leg", "targets"),
      at("total_mass_kg"),
      at("delays_ms", "LeftFoot"),
    ];
    expect(grouped(rows).map(([group, found]) => [group, found.length])).toEqual([
      ["all", 1],
      ["left_arm", 1],
      ["left_leg", 2],
      ["right_leg", 1],
    ]);
  });
});
