import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import type { MjModel } from "@mujoco/mujoco";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { GOAL_PARTS, type Goals } from "./goals";
import { InverseKinematics, type Solution } from "./ik";
import { loadMujoco, type Mujoco, modelFrom } from "./mujoco";

const FOLDER = resolve(import.meta.dirname, "../../../../tests/vectors/avatar");
const ALIKE = 1e-9;

/** The files are made by our own script; the README in their folder describes the format. */
const textOf = (name: string) => readFileSync(resolve(FOLDER, name), "utf8");
const ik: IkVector = JSON.parse(textOf("ik.json"));
const trajectory: TrajectoryVector = JSON.parse(textOf("trajectory.json"));

type Row = readonly number[];
type Rows = readonly Row[];
interface IkVector {
  readonly frames: readonly {
    readonly positions_m: Rows;
    readonly rotations: Rows;
    readonly tracked: readonly boolean[];
  }[];
  readonly cases: readonly IkCase[];
}
interface IkCase {
  readonly name: string;
  readonly waist: boolean;
  readonly axes: readonly string[];
  readonly angles_rad: Rows;
  readonly hips_m: Rows;
  readonly hips: Rows;
  readonly position_errors_m: readonly (readonly (number | null)[])[];
  readonly rotation_errors_rad: readonly (readonly (number | null)[])[];
}
interface TrajectoryVector {
  readonly key_s: number;
  readonly sample_s: number;
  readonly targets_rad: Rows;
  readonly hips_m: Rows;
  readonly samples: readonly { readonly ncon: number; readonly qpos: Row }[];
}

let mujoco: Mujoco;
let model: MjModel;
beforeAll(async () => {
  mujoco = await loadMujoco();
  model = modelFrom(mujoco, textOf("body.xml"));
});
afterAll(() => model.delete());

describe("inverse kinematics in the browser's MuJoCo", () => {
  it.each(ik.cases)("gives the server's angles, frame after frame, $name", (vector) => {
    const solver = new InverseKinematics(mujoco, model);
    const solved = ik.frames.map((_, index) =>
      structuredClone(solver.solve(goalsOf(index, vector.waist))),
    );
    const columns = vector.axes.map((name) => solver.axisNames.indexOf(name));
    const anglesOf = (one: Solution) => columns.map((at) => one.anglesRad[at] ?? Number.NaN);
    expect(greatestDifference(solved.map(anglesOf), vector.angles_rad)).toBeLessThanOrEqual(ALIKE);
    expect(
      greatestDifference(
        solved.map((one) => one.hips.positionM),
        vector.hips_m,
      ),
    ).toBeLessThanOrEqual(ALIKE);
    expect(
      greatestDifference(
        solved.map((one) => one.hips.rotation),
        vector.hips,
      ),
    ).toBeLessThanOrEqual(ALIKE);
    solver.delete();
  });

  it.each(ik.cases)("gives the server's goal errors, $name", (vector) => {
    const solver = new InverseKinematics(mujoco, model);
    const solved = ik.frames.map((_, index) =>
      structuredClone(solver.solve(goalsOf(index, vector.waist))),
    );
    const known = (values: Float64Array) => Array.from(values, (one) => (one >= 0 ? one : -1));
    const withoutNulls = (rows: IkCase["position_errors_m"]) =>
      rows.map((row) => row.map((x) => x ?? -1));
    expect(
      greatestDifference(
        solved.map((one) => known(one.positionErrorsM)),
        withoutNulls(vector.position_errors_m),
      ),
    ).toBeLessThanOrEqual(ALIKE);
    expect(
      greatestDifference(
        solved.map((one) => known(one.rotationErrorsRad)),
        withoutNulls(vector.rotation_errors_rad),
      ),
    ).toBeLessThanOrEqual(ALIKE);
    solver.delete();
  });
});

describe("MuJoCo's memory, when it grows,", () => {
  it("does not leave the solver with invalid arrays", () => {
    const solver = new InverseKinematics(mujoco, model);
    const vector = ik.cases[0];
    const data = new mujoco.MjData(model);
    const view: Float64Array = data.qpos;
    solver.solve(goalsOf(0, true));
    const large = new mujoco.DoubleBuffer(20_000_000);
    expect(view.length).toBe(0);
    const after = solver.solve(goalsOf(1, true));
    const angles = (vector?.axes ?? []).map(
      (name) => after.anglesRad[solver.axisNames.indexOf(name)] ?? Number.NaN,
    );
    expect(greatestDifference([angles], [vector?.angles_rad[1] ?? []])).toBeLessThanOrEqual(ALIKE);
    for (const owned of [large, data, solver]) owned.delete();
  });
});

describe("the simulated body in the browser's MuJoCo", () => {
  it("reproduces the server's angles and contacts for ten seconds", () => {
    const found = simulated(trajectory);
    expect(found.map(({ ncon }) => ncon)).toEqual(trajectory.samples.map(({ ncon }) => ncon));
    const expected = trajectory.samples.map(({ qpos }) => qpos);
    expect(
      greatestDifference(
        found.map(({ qpos }) => qpos),
        expected,
      ),
    ).toBeLessThanOrEqual(ALIKE);
  });
});

/** The greatest absolute difference; infinite if the two cannot be compared. */
function greatestDifference(found: Rows, expected: Rows): number {
  const gaps = expected.flatMap((row, i) =>
    row.map((value, j) => Math.abs(value - at(found, i, j))),
  );
  return gaps.reduce((most, gap) => (gap <= most ? most : gap), 0);
}

const at = (rows: Rows, i: number, j: number): number => rows[i]?.[j] ?? Number.POSITIVE_INFINITY;

function goalsOf(index: number, waist: boolean): Goals {
  const frame = ik.frames[index];
  const places = GOAL_PARTS.map((part, row) => {
    const [px = 0, py = 0, pz = 0] = frame?.positions_m[row] ?? [];
    const [w = 0, x = 0, y = 0, z = 0] = frame?.rotations[row] ?? [];
    const seen = frame?.tracked[row] === true && (row > 0 || waist);
    return [part, seen ? { positionM: [px, py, pz], rotation: [w, x, y, z] } : null] as const;
  });
  return Object.fromEntries(places) as unknown as Goals;
}

function simulated(vector: TrajectoryVector) {
  const data = new mujoco.MjData(model);
  const timestep: number = model.opt.timestep;
  const perKey = Math.round(vector.key_s / timestep);
  const perSample = Math.round(vector.sample_s / timestep);
  const found: { ncon: number; qpos: Row }[] = [];
  for (let step = 0; step < perKey * (vector.targets_rad.length - 1); step++) {
    const key = Math.floor(step / perKey);
    const fraction = (step % perKey) / perKey;
    const blend = fraction * fraction * (3 - 2 * fraction);
    const speed = (6 * fraction * (1 - fraction)) / vector.key_s;
    const ctrl: Float64Array = data.ctrl;
    vector.targets_rad[key]?.forEach((from, axis) => {
      const change = at(vector.targets_rad, key + 1, axis) - from;
      ctrl[2 * axis] = from + blend * change;
      ctrl[2 * axis + 1] = speed * change;
    });
    const mocap: Float64Array = data.mocap_pos;
    vector.hips_m[key]?.forEach((from, axis) => {
      mocap[axis] = from + blend * (at(vector.hips_m, key + 1, axis) - from);
    });
    mujoco.mj_step(model, data);
    if ((step + 1) % perSample === 0) found.push({ ncon: data.ncon, qpos: [...data.qpos] });
  }
  data.delete();
  return found;
}
