import { describe, expect, it } from "vitest";
import { type AvatarFile, differences } from "./axes";
import { changedByBoth, valueAt, withOwnChanges } from "./merge";

const axis = (kp: number) => ({
  low_deg: -10,
  high_deg: 10,
  kp_nm_per_rad: kp,
  kd_nm_s_per_rad: 1,
  max_torque_nm: 5,
});
const file = (changes: object): AvatarFile =>
  ({
    format: "reembody-avatar",
    version: 1,
    total_mass_kg: 72,
    delays_ms: {},
    axes: { LeftHandX: axis(5), LeftFootX: axis(6) },
    ...changes,
  }) as unknown as AvatarFile;

describe("one's own changes on a colleague's version", () => {
  const start = file({});
  const theirs = file({
    total_mass_kg: 60,
    axes: { LeftHandX: axis(50), LeftFootX: axis(6) },
    compliance: { left_leg: { stiffness_percent: 20, targets: "joint" } },
  });

  it("are all that differs from it", () => {
    const mine = file({
      axes: { LeftHandX: axis(5), LeftFootX: axis(111) },
      delays_ms: { LeftHand: 50 },
    });
    const merged = withOwnChanges(start, mine, theirs);
    expect(differences(theirs, merged).map(({ path }) => path.join("."))).toEqual([
      "delays_ms.LeftHand",
      "axes.LeftFootX.kp_nm_per_rad",
    ]);
    expect(merged.compliance).toEqual(theirs.compliance);
    expect(changedByBoth(start, mine, theirs)).toEqual([]);
  });

  it("count where both changed a value, and are named as such", () => {
    const mine = file({
      total_mass_kg: 80,
      compliance: { left_leg: { stiffness_percent: 40, targets: "joint" } },
    });
    const merged = withOwnChanges(start, mine, theirs);
    expect(merged.total_mass_kg).toBe(80);
    expect(valueAt(merged, ["compliance", "left_leg", "stiffness_percent"])).toBe(40);
    expect(valueAt(merged, ["axes", "LeftHandX", "kp_nm_per_rad"])).toBe(50);
    expect(changedByBoth(start, mine, theirs)).toHaveLength(2);
  });

  it("leave a file without compliance as it is", () => {
    const mine = file({ total_mass_kg: 80 });
    expect(withOwnChanges(start, mine, start)).toEqual(mine);
  });
});
