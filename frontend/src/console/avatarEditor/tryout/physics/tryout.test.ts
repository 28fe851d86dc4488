import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { loadMujoco, type Mujoco } from "@shared/avatar/mujoco";
import type { ConfigurationFile } from "@shared/avatar/physics/settings";
import { beforeAll, describe, expect, it } from "vitest";
import type { Direction } from "../pulling";
import { FIRST_PUSH, pushCommand } from "../settings";
import type { Command } from "./commands";
import { Tryout } from "./tryout";

const VECTORS = resolve(import.meta.dirname, "../../../../../../tests/vectors/avatar");
const textOf = (name: string) => readFileSync(resolve(VECTORS, name), "utf8");
const vector: { box: string; floor: [string, string]; configuration: ConfigurationFile } =
  JSON.parse(textOf("tried.json"));
const mjcf = textOf("body.xml")
  .replace(...vector.floor)
  .replace("  </worldbody>", `${vector.box}  </worldbody>`);
const own = { mjcf, configuration: vector.configuration };
const weak = { ...own, mjcf: mjcf.replaceAll(/forcerange="[^"]*"/g, 'forcerange="-2 2"') };
const AXIS = "LeftUpperArmZ";
const SINE: Command = {
  kind: "drive",
  drive: {
    axis: AXIS,
    wave: { kind: "sine", centerRad: -0.4, amplitudeRad: 0.4, periodS: 0.7 },
  },
};

let mujoco: Mujoco;
beforeAll(async () => {
  mujoco = await loadMujoco();
});

describe("a body beside another", () => {
  it("joins at rest, at the same time; the one that was there is not disturbed", () => {
    const alone = new Tryout(mujoco, [own]);
    const tried = new Tryout(mujoco, [own]);
    for (const one of [alone, tried]) {
      one.obey(SINE);
      one.advance(30, AXIS);
    }
    // Another text of the same body, as it comes from the page.
    expect(tried.change([structuredClone(own), weak], [SINE])).toEqual([]);
    expect(tried.timeS).toBeCloseTo(0.3, 12);
    const [expected] = alone.advance(20, AXIS);
    const [first, second] = tried.advance(20, AXIS);
    expect(first?.readings).toEqual(expected?.readings);
    for (let at = 0; at < 60; at += 3) expect(second?.readings[at]).toBe(first?.readings[at]);
    expect(first?.limitNm).toBeGreaterThan(2);
    expect(second?.limitNm).toBe(2);
    tried.obey({ kind: "reset" });
    expect(tried.timeS).toBe(0);
    tried.change([weak], [SINE]);
    expect(tried.bodies).toHaveLength(1);
    alone.dispose();
    tried.dispose();
  });

  it("says what it cannot obey, and joins all the same", () => {
    const tried = new Tryout(mujoco, [own]);
    const problems = tried.change([own, weak], [{ kind: "latency", latencyS: 9 }]);
    expect(problems.map(String)).toEqual([expect.stringContaining("9")]);
    expect(tried.bodies).toHaveLength(2);
    tried.dispose();
  });
});

describe("a push against a stop", () => {
  const PART = "LeftLowerLeg";
  const push = (direction: Direction): Command =>
    pushCommand({ ...FIRST_PUSH, part: PART, direction });

  it("is foretold by the limit of the joint that it would turn, and its opposite gives way", () => {
    const tried = new Tryout(mujoco, [own]);
    const stops = tried.advance(20, AXIS, PART)[0]?.stops;
    expect(stops?.by.forward).toEqual({ axis: "LeftLowerLegX", end: "low" });
    expect(stops?.by.backward).toBeNull();
    expect(stops?.by[FIRST_PUSH.direction]).toBeNull();
    const peaks = (["forward", "backward"] as const).map((direction) => {
      tried.obey({ kind: "reset" });
      tried.obey(push(direction));
      return tried.advance(60, AXIS, PART)[0]?.push?.peakRad ?? 0;
    });
    expect(peaks[1]).toBeGreaterThan(1.5 * (peaks[0] as number));
    expect(tried.advance(1, AXIS)[0]?.stops).toBeNull();
    tried.dispose();
  });
});

describe("a push", () => {
  const push = (forceN: number, forS: number | null): Command => ({
    kind: "push",
    push: { part: "LeftHand", pointM: null, forceN: [0, 0, forceN], forS },
  });

  it("is watched from its beginning until some time after its end", () => {
    const tried = new Tryout(mujoco, [own]);
    tried.advance(20, AXIS);
    tried.obey(push(100, 0.2));
    const pushed = tried.advance(20, AXIS)[0]?.push;
    expect(pushed).toMatchObject({ part: "LeftHand", phase: "pushed" });
    expect(pushed?.peakRad).toBeGreaterThan(0.05);
    expect(tried.advance(1, AXIS)[0]?.push?.phase).toBe("watched");
    const after = tried.advance(230, AXIS)[0]?.push;
    expect(after?.phase).toBe("over");
    expect(after?.returnS).toBeGreaterThan(0);
    expect(after?.isAlone).toBe(true);
    // Not of the push alone: the target moves, or it begins to.
    tried.obey(SINE);
    expect(tried.advance(1, AXIS)[0]?.push?.isAlone).toBe(true);
    tried.obey(push(100, 0.2));
    expect(tried.advance(1, AXIS)[0]?.push?.isAlone).toBe(false);
    tried.obey({ kind: "reset" });
    expect(tried.advance(1, AXIS)[0]?.push).toBeNull();
    tried.dispose();
  });

  it("is one while somebody pulls, with whatever force", () => {
    const tried = new Tryout(mujoco, [own]);
    let peak = 0;
    for (const forceN of [100, 60, 20]) {
      tried.obey(push(forceN, null));
      const found = tried.advance(15, AXIS)[0]?.push;
      expect(found?.phase).toBe("pushed");
      expect(found?.peakRad).toBeGreaterThanOrEqual(peak);
      peak = found?.peakRad ?? 0;
    }
    tried.obey({ kind: "push", push: null });
    expect(tried.advance(5, AXIS)[0]?.push?.phase).toBe("watched");
    tried.dispose();
  });
});
