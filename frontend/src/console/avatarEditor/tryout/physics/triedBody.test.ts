import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { loadMujoco, type Mujoco } from "@shared/avatar/mujoco";
import { SimulationError } from "@shared/avatar/physics/modelTable";
import type { AxisFile, ConfigurationFile, TargetSpace } from "@shared/avatar/physics/settings";
import { beforeAll, describe, expect, it } from "vitest";
import { type Command, waveAt } from "./commands";
import { shapesOf } from "./shapes";
import { COLUMNS, TriedBody } from "./triedBody";

const VECTORS = resolve(import.meta.dirname, "../../../../../../tests/vectors/avatar");
const textOf = (name: string) => readFileSync(resolve(VECTORS, name), "utf8");

/** `tests/vectors/avatar/README.md` describes the file. */
interface Vector {
  readonly box: string;
  readonly floor: readonly [string, string];
  readonly configuration: ConfigurationFile;
  readonly ticks: number;
  readonly every: number;
  readonly cases: readonly {
    readonly name: string;
    readonly target_space: TargetSpace;
    readonly compliance?: ConfigurationFile["compliance"];
    /** What this body's model has instead, such as the motors of a soft leg. */
    readonly replaced?: readonly (readonly [before: string, after: string])[];
    readonly watched: string;
    readonly events: readonly { readonly tick: number; readonly command: Command }[];
    readonly samples: readonly { readonly torque_nm: number; readonly qpos: readonly number[] }[];
  }[];
}

const vector: Vector = JSON.parse(textOf("tried.json"));
const mjcf = textOf("body.xml")
  .replace(...vector.floor)
  .replace("  </worldbody>", `${vector.box}  </worldbody>`);
const ALIKE = 1e-9;
/** A torque is a difference of angles times a gain of up to some hundreds. */
const TORQUES_ALIKE = 1e-6;

let mujoco: Mujoco;
beforeAll(async () => {
  mujoco = await loadMujoco();
});
const body = (changed: Partial<ConfigurationFile> = {}, model = mjcf) =>
  new TriedBody(mujoco, {
    mjcf: model,
    configuration: { ...vector.configuration, ...changed },
  });

describe("a body that is tried in the page moves as the server's", () => {
  it.each(vector.cases)("with $name", (one) => {
    const { target_space, compliance = null, replaced = [] } = one;
    const model = replaced.reduce((text, [before, after]) => text.replace(before, after), mjcf);
    const tried = body({ target_space, compliance }, model);
    const reading = new Float64Array(3);
    let apart = 0;
    let torqueApart = 0;
    for (let tick = 0; tick < vector.ticks; tick++) {
      for (const event of one.events) if (event.tick === tick) tried.obey(event.command);
      tried.tick();
      if ((tick + 1) % vector.every !== 0) continue;
      const sample = one.samples[(tick + 1) / vector.every - 1];
      tried.avatar.views.qpos.forEach((value, at) => {
        apart = Math.max(apart, Math.abs(value - (sample?.qpos[at] ?? Number.POSITIVE_INFINITY)));
      });
      tried.writeReading(COLUMNS.get(one.watched) ?? -1, reading, 0);
      torqueApart = Math.max(
        torqueApart,
        Math.abs((reading[2] as number) - (sample?.torque_nm ?? Number.POSITIVE_INFINITY)),
      );
    }
    expect(apart).toBeLessThanOrEqual(ALIKE);
    expect(torqueApart).toBeLessThanOrEqual(TORQUES_ALIKE);
    expect(tried.health).toMatchObject({ restored: 0, resets: 0 });
    tried.dispose();
  });
});

describe("a body that is tried", () => {
  it("does the same again after a reset, to the bit", () => {
    const tried = body();
    const run = () => {
      tried.obey({
        kind: "drive",
        drive: {
          axis: "LeftUpperArmZ",
          wave: { kind: "sine", centerRad: -0.4, amplitudeRad: 0.4, periodS: 0.7 },
        },
      });
      tried.obey({ kind: "reset" });
      for (let tick = 0; tick < 30; tick++) tried.tick();
      return [...tried.avatar.views.qpos];
    };
    const first = run();
    tried.obey({ kind: "drop", centerM: [0, 2, 0] });
    for (let tick = 0; tick < 40; tick++) tried.tick();
    expect(run()).toEqual(first);
    tried.dispose();
  });

  it("lets a box begin to fall above the body, and does not disturb it before they meet", () => {
    const tried = body();
    tried.tick();
    const { views } = tried.avatar;
    const hips = tried.avatar.table.bodies.get("Hips") as number;
    const places = () => Array.from(views.renewed().xpos);
    const before = places();
    const at = (part: number) => before.slice(3 * part, 3 * part + 3) as [number, number, number];
    tried.obey({ kind: "drop", centerM: at(hips) });
    for (let tick = 0; tick < 5; tick++) tried.tick();
    const after = places();
    const box = 3 * (views.bodyGravcomp.length - 1);
    expect(after[box + 1]).toBeGreaterThan(Math.max(...at(hips)) + 0.3);
    expect(
      Math.hypot((after[box] as number) - at(hips)[0], (after[box + 2] as number) - at(hips)[2]),
    ).toBeLessThan(1e-3);
    const moved = after.map((value, row) => Math.abs(value - (before[row] as number)));
    moved.splice(box, 3);
    expect(Math.max(...moved)).toBeLessThan(0.01);
    tried.dispose();
  });

  it("gives way to a push in its direction, and comes back when it ends", () => {
    const tried = body();
    const shin = tried.avatar.table.bodies.get("LeftLowerLeg") as number;
    const ahead = () => tried.avatar.views.renewed().xpos[3 * (shin + 1) + 2] as number;
    const atRest = ahead();
    const push = {
      part: "LeftLowerLeg",
      pointM: [0, -0.3, 0],
      forceN: [0, 0, 100],
      forS: 0.2,
    } as const;
    tried.obey({ kind: "push", push });
    for (let tick = 0; tick < 20; tick++) tried.tick();
    const pushed = ahead();
    expect(pushed).toBeGreaterThan(atRest + 0.005);
    expect(tried.pushedAt()).not.toBeNull();
    for (let tick = 0; tick < 150; tick++) tried.tick();
    expect(tried.pushedAt()).toBeNull();
    expect(Math.abs(ahead() - atRest)).toBeLessThan(0.1 * (pushed - atRest));
    tried.dispose();
  });

  it("names the motors that a push takes to their torque limit, as long as it does", () => {
    const knee = { ...(vector.configuration.axes.LeftLowerLegX as AxisFile), max_torque_nm: 10 };
    const axes = { ...vector.configuration.axes, LeftLowerLegX: knee };
    const weak = mjcf.replace(
      /(name="LeftLowerLegX" joint.*)forcerange="\S+ \S+"/,
      '$1forcerange="-10 10"',
    );
    const tried = body({ axes }, weak);
    tried.tick();
    expect(tried.following.saturated).toEqual([]);
    const push = { part: "LeftLowerLeg", pointM: null, forceN: [0, 0, 100], forS: 0.1 } as const;
    tried.obey({ kind: "push", push });
    for (let tick = 0; tick < 10; tick++) tried.tick();
    expect(tried.following.saturated).toEqual(["LeftLowerLegX"]);
    for (let tick = 0; tick < 190; tick++) tried.tick();
    expect(tried.following.saturated).toEqual([]);
    tried.dispose();
  });

  it("says what it cannot do, and goes on", () => {
    const tried = body();
    expect(() => tried.obey({ kind: "latency", latencyS: 9 })).toThrow(SimulationError);
    const push = { part: "Tail", pointM: [0, 0, 0], forceN: [1, 0, 0], forS: null } as const;
    expect(() => tried.obey({ kind: "push", push })).toThrow("no Tail");
    tried.tick();
    expect(tried.isFinite).toBe(true);
    tried.dispose();
  });

  it("is restored, and counts it, when a force breaks the simulation", () => {
    const tried = body();
    const push = {
      part: "LeftHand",
      pointM: [0, 0, 0],
      forceN: [1e15, 0, 0],
      forS: 0.05,
    } as const;
    tried.obey({ kind: "push", push });
    for (let tick = 0; tick < 20; tick++) tried.tick();
    expect(tried.health.restored).toBeGreaterThan(0);
    expect(tried.isFinite).toBe(true);
    expect(Math.abs(tried.avatar.views.qpos[0] as number)).toBeLessThan(4);
    tried.dispose();
  });

  it("is drawn with the shapes that collide, every part and the box", () => {
    const tried = body();
    const shapes = shapesOf(mujoco, tried.avatar.model, tried.avatar.table);
    expect(new Set(shapes.map(({ part }) => part))).toEqual(
      new Set([...tried.avatar.table.bodies.keys(), "box"]),
    );
    expect(shapes.every(({ collides }) => collides)).toBe(true);
    tried.dispose();
  });
});

describe("a wave", () => {
  it("steps at half its period and swings about its centre", () => {
    const shape = { centerRad: 0.5, amplitudeRad: 0.2, periodS: 2 } as const;
    const steps = [0, 0.9, 1, 1.9, 2].map((t) => waveAt({ kind: "step", ...shape }, t));
    expect(steps).toEqual([0.3, 0.3, 0.7, 0.7, 0.3]);
    const swings = [0, 0.5, 1.5].map((t) => waveAt({ kind: "sine", ...shape }, t));
    expect(swings.map((one) => Number(one.toFixed(12)))).toEqual([0.5, 0.7, 0.3]);
    expect(waveAt({ kind: "hold", angleRad: 1.5 }, 7)).toBe(1.5);
  });
});
