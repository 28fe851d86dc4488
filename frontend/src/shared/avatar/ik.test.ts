import { readdirSync, readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import type { MjModel } from "@mujoco/mujoco";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { boundedStep } from "./boundedStep";
import { type Goals, IkError, NO_GOALS } from "./goals";
import { InverseKinematics } from "./ik";
import { loadMujoco, type Mujoco, modelFrom } from "./mujoco";

const SOURCE = resolve(import.meta.dirname, "../..");
const BODY = resolve(SOURCE, "../../tests/vectors/avatar/body.xml");

describe("the best step within bounds", () => {
  const hessian = Float64Array.of(2, 1, 1, 2);

  it("solves the equations if the solution is within the bounds", () => {
    const step = boundedStep(hessian, Float64Array.of(3, 3), box(-5), box(5));
    expect(step[0]).toBeCloseTo(1, 12);
    expect(step[1]).toBeCloseTo(1, 12);
  });

  it("holds one unknown at its bound and adjusts the other for it", () => {
    const step = boundedStep(hessian, Float64Array.of(3, 3), box(-5), Float64Array.of(0.5, 5));
    expect(step[0]).toBe(0.5);
    expect(step[1]).toBeCloseTo(1.25, 12);
  });

  it("frees an unknown once the others no longer push it past its bound", () => {
    // Unbounded (-0.8, 1.6): both leave [-0.5, 0.5]; with the second held, the first becomes -0.25.
    const step = boundedStep(
      Float64Array.of(2, 1, 1, 3),
      Float64Array.of(0, 4),
      box(-0.5),
      box(0.5),
    );
    expect(step[0]).toBeCloseTo(-0.25, 12);
    expect(step[1]).toBe(0.5);
  });
});

describe("inverse kinematics", () => {
  let mujoco: Mujoco;
  let model: MjModel;
  beforeAll(async () => {
    mujoco = await loadMujoco();
    model = modelFrom(mujoco, readFileSync(BODY, "utf8"));
  });
  afterAll(() => model.delete());

  it("stays in the bent rest pose while nothing is tracked", () => {
    const solver = new InverseKinematics(mujoco, model);
    const { anglesRad, positionErrorsM } = solver.solve(NO_GOALS);
    const bent = solver.axisNames.filter((_, at) => anglesRad[at] !== 0);
    expect(bent.toSorted()).toEqual(
      ["LeftLowerArmY", "LeftLowerLegX", "RightLowerArmY", "RightLowerLegX"].toSorted(),
    );
    expect([...positionErrorsM].every(Number.isNaN)).toBe(true);
    solver.delete();
  });

  it("treats hips that are a free body like hips on a carrier", () => {
    const free = readFileSync(BODY, "utf8")
      .replace('<body name="Hips" mocap="true"', '<body name="Hips"')
      .replace(/(<body name="Hips"[^>]*>)/, '$1<freejoint name="Hips"/>');
    const other = modelFrom(mujoco, free);
    expect(other.nq).toBe(model.nq + 7);
    const solvers = [model, other].map((one) => new InverseKinematics(mujoco, one));
    const [carried, welded] = solvers.map((solver) => {
      solver.solve(headAt(1.4));
      return solver.solve(headAt(1.3)).anglesRad;
    });
    carried?.forEach((angle, at) => {
      expect(welded?.[at]).toBeCloseTo(angle, 9);
    });
    for (const owned of [...solvers, other]) owned.delete();
  });

  it("starts from the rest pose after a reset", () => {
    const solver = new InverseKinematics(mujoco, model);
    const first = solver.solve(headAt(1.5)).anglesRad.slice();
    solver.solve(headAt(1.2));
    solver.reset();
    expect(solver.solve(headAt(1.5)).anglesRad).toEqual(first);
    solver.delete();
  });

  it("rejects positions that are not finite and invalid rotations, and names the part", () => {
    const solver = new InverseKinematics(mujoco, model);
    expect(() => solver.solve(headAt(Number.NaN))).toThrow(/Head lies at/);
    const flat = { positionM: [0, 1.6, 0], rotation: [0, 0, 0, 0] } as const;
    expect(() => solver.solve({ ...NO_GOALS, Head: flat })).toThrow(
      /Head is not a unit quaternion/,
    );
    solver.delete();
  });

  it("rejects a model that is not an avatar's", () => {
    const ball = modelFrom(
      mujoco,
      "<mujoco><worldbody><body name='Hips'><geom size='1'/></body></worldbody></mujoco>",
    );
    expect(() => new InverseKinematics(mujoco, ball)).toThrow(IkError);
    ball.delete();
  });
});

describe("MuJoCo's ten megabytes", () => {
  const files = readdirSync(SOURCE, { recursive: true, encoding: "utf8" })
    .filter((name) => /\.tsx?$/.test(name) && !name.includes(".test."))
    .map((name) => ({ name, text: readFileSync(join(SOURCE, name), "utf8") }));

  it("are imported dynamically, in one module only, and by the workers that run them", () => {
    const statically = /^import (?!type\b)[^;]*"@mujoco\/mujoco"/m;
    expect(
      files
        .filter(({ text }) => statically.test(text))
        .map(({ name }) => name)
        .toSorted(),
    ).toEqual([
      join("console", "avatarEditor", "tryout", "worker", "tryoutWorker.ts"),
      join("vr", "bodies", "worker", "bodiesWorker.ts"),
    ]);
    const lazily = files.filter(({ text }) => text.includes('import("@mujoco/mujoco")'));
    expect(lazily.map(({ name }) => name)).toEqual([join("shared", "avatar", "mujoco.ts")]);
  });

  it("are not loaded by the console or the tablet", () => {
    const pages = files.filter(({ name }) => /^(console|tablet)\b/.test(name));
    expect(pages.length).toBeGreaterThan(50);
    // The names of the axes come without MuJoCo; what computes with it runs in a worker.
    const computing = pages.filter(({ text }) => /shared\/avatar\/(?!anatomy)/.test(text));
    const trying = join("console", "avatarEditor", "tryout");
    expect(computing.map(({ name }) => name).filter((one) => !one.startsWith(trying))).toEqual([]);
  });
});

const box = (value: number): Float64Array => Float64Array.of(value, value);

const headAt = (height: number): Goals => ({
  ...NO_GOALS,
  Head: { positionM: [0, height, 0], rotation: [1, 0, 0, 0] },
});
