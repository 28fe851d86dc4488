import { describe, expect, it } from "vitest";
import type { AvatarFile } from "./axes";
import { unfitting } from "./damping";

const file = (kp: number, kd: number, high = 140): AvatarFile =>
  ({
    axes: {
      LeftLowerLegX: {
        low_deg: 0,
        high_deg: high,
        kp_nm_per_rad: kp,
        kd_nm_s_per_rad: kd,
        max_torque_nm: 350,
      },
    },
  }) as unknown as AvatarFile;

describe("the damping that fits a changed stiffness", () => {
  it("goes with the square root of the stiffness, as critical damping does", () => {
    const axis = "LeftLowerLegX";
    expect(unfitting(file(1000, 32), file(250, 32))).toEqual([{ axis, damping: 16 }]);
    expect(unfitting(file(1000, 32), file(2000, 32))).toEqual([{ axis, damping: 45.25 }]);
  });

  it("is not asked for where damping was set as well, nothing changed, or the axis is locked", () => {
    expect(unfitting(file(1000, 32), file(250, 20))).toEqual([]);
    expect(unfitting(file(1000, 32), file(1000, 32))).toEqual([]);
    expect(unfitting(file(1000, 32), file(250, 32, 0))).toEqual([]);
  });
});
