import { loadMujoco, type Mujoco } from "@shared/avatar/mujoco";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { BodiesEngine } from "./engine";
import { goalsAt } from "./testing/movement";
import { physicsSetup } from "./testing/person";

const FRAME_S = 1 / 90;
let mujoco: Mujoco;
let engine: BodiesEngine;
beforeAll(async () => {
  mujoco = await loadMujoco();
  engine = new BodiesEngine(mujoco, physicsSetup());
});
afterAll(() => engine.dispose());

describe("the remote body", () => {
  it("follows the local one, which reaches its goals", () => {
    for (let frame = 0; frame < 180; frame++) engine.frame(frame * FRAME_S, goalsAt(0), null);
    expect(Math.max(...engine.own.goalErrorsM)).toBeLessThan(0.02);
    const { pose } = engine.worn;
    expect(pose.length).toBe(91);
    let apart = 0;
    for (let i = 0; i < 91; i++) {
      apart = Math.max(apart, Math.abs((pose[i] as number) - (engine.own.pose[i] as number)));
    }
    expect(apart).toBeLessThan(0.06);
    expect(engine.worn.health.restored).toBe(0);
  });
});
