import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { AXES } from "../anatomy.generated";
import { LimbYield } from "./limbYield";
import { asConfigured, type ConfigurationFile, worldLimbs } from "./settings";

/** `tests/vectors/avatar/README.md` describes the file. */
interface Vector {
  readonly axes: readonly string[];
  readonly frames: readonly {
    readonly elapsed_s: number;
    readonly targets_rad: readonly number[];
    readonly actual_rad: readonly (number | null)[];
  }[];
  readonly cases: readonly {
    readonly limbs: readonly string[];
    readonly commands_rad: readonly (readonly number[])[];
  }[];
}

const FILE = resolve(import.meta.dirname, "../../../../../tests/vectors/avatar/limb_yield.json");
const vector: Vector = JSON.parse(readFileSync(FILE, "utf8"));
const ALIKE = 1e-12;
const columns = vector.axes.map((name) => AXES.findIndex((axis) => axis.name === name));

describe("limbs with world targets give way as on the server", () => {
  it.each(vector.cases)("with $limbs", ({ limbs, commands_rad }) => {
    const rule = new LimbYield(limbs);
    const targets = new Float64Array(AXES.length);
    const actual = new Float64Array(AXES.length);
    vector.frames.forEach((frame, index) => {
      columns.forEach((column, axis) => {
        targets[column] = frame.targets_rad[axis] as number;
        actual[column] = frame.actual_rad[axis] ?? Number.NaN;
      });
      const commands = rule.commands(targets);
      const apart = columns.map((column, axis) =>
        Math.abs((commands[column] as number) - (commands_rad[index]?.[axis] as number)),
      );
      expect(Math.max(...apart)).toBeLessThanOrEqual(ALIKE);
      rule.note(targets, actual, frame.elapsed_s);
    });
    rule.forget();
    expect([...rule.commands(targets)]).toEqual([...targets]);
  });
});

const axis = {
  kp_nm_per_rad: 300,
  kd_nm_s_per_rad: 20,
  max_torque_nm: 90,
  low_deg: -10,
  high_deg: 40,
};
const file: ConfigurationFile = {
  gravity: true,
  self_collision: true,
  target_space: "local",
  colliders: "simple",
  part_colliders: {},
  compliance: {
    left_leg: { stiffness_percent: 10, targets: "world" },
    right_leg: { stiffness_percent: 25, targets: "joint" },
  },
  locked_groups: [],
  held_deg: {},
  axes: { LeftUpperLegX: axis, RightUpperLegX: axis, LeftUpperArmX: axis },
};

describe("a compliant group", () => {
  it("has a share of its stiffness and keeps its damping ratio and its torque limit", () => {
    const { motors } = asConfigured(file);
    expect(motors.get("LeftUpperLegX")).toEqual({
      kp: 30,
      kd: Math.sqrt(0.1) * 20,
      maxTorqueNm: 90,
    });
    expect(motors.get("RightUpperLegX")).toEqual({ kp: 75, kd: 10, maxTorqueNm: 90 });
    expect(motors.get("LeftUpperArmX")).toEqual({ kp: 300, kd: 20, maxTorqueNm: 90 });
    expect(worldLimbs(file)).toEqual(["left_leg"]);
    expect(worldLimbs({ ...file, compliance: null })).toEqual([]);
  });
});
