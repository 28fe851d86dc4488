/** Tests of the road's ground, its socket, and a phase on it. */
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { NO_GOALS } from "@shared/avatar/goals";
import { describe, expect, it } from "vitest";
import { phaseOf } from "../session/panels/visitPanels";
import { RoadRun } from "../tasks";
import { ORDER } from "../tasks/testing/orders";
import type { Road } from "../telemetry";
import { RoadGround } from "./ground";
import { RoadLink } from "./link";

const ROAD: Road = {
  road: { half_length_m: 100, lane_width_m: 2.5, pavement_width_m: 2, crossing_width_m: 4 },
  kerb_height_m: 0.12,
  starts_behind_kerb_m: 0.8,
  step_s: 0.02,
};
const FACING: readonly [number, number, number, number] = [1, 0, 0, 0];

describe("the ground", () => {
  const ground = new RoadGround(ROAD);

  it("is a kerb high on both pavements and level on the carriageway", () => {
    expect(ground.kerbsZM).toEqual([-0.8, -5.8]);
    expect([0, -3.3, -6.6].map((z) => ground.sunkM(z))).toEqual([0.12, 0, 0.12]);
    expect(ground.sunkM(-0.8)).toBeCloseTo(0.06, 12);
  });

  it("is that of the rehearsal's participant", () => {
    const file = resolve(import.meta.dirname, "../../../../tests/vectors/road/ground.json");
    const { road, rows } = JSON.parse(readFileSync(file, "utf8"));
    const same = new RoadGround(road);
    expect(rows.length).toBeGreaterThan(400);
    for (const [hipsZM, ankleZM, sunkM, liftM] of rows) {
      expect(same.sunkM(hipsZM)).toBeCloseTo(sunkM, 12);
      expect(same.liftM(ankleZM, hipsZM)).toBeCloseTo(liftM, 12);
    }
  });

  it("sets a foot by where its ankle is, not its knee", () => {
    // The knee is ahead, over the carriageway; the shin leads back to a foot on the pavement.
    const rotation = [Math.cos(-0.4), Math.sin(-0.4), 0, 0] as const;
    const knee = { positionM: [0, 0.45, -0.95] as const, rotation };
    const { LeftLowerLeg } = ground.carried({ ...NO_GOALS, LeftLowerLeg: knee }, -2, 1.7);
    expect(LeftLowerLeg?.positionM[1]).toBeCloseTo(0.45 + 0.12, 3);
  });

  it("sets each foot on the ground where it is, and moves neither head nor hands", () => {
    const at = (z: number) => ({ positionM: [0, 0.45, z] as const, rotation: FACING });
    const goals = { ...NO_GOALS, Head: at(-0.6), LeftLowerLeg: at(-1.2), RightLowerLeg: at(-0.4) };
    // The hips are still over the pavement: the foot ahead goes down by the whole kerb.
    const before = ground.carried(goals, -0.3, 1.7);
    expect(before.LeftLowerLeg?.positionM[1]).toBeCloseTo(0.45 - 0.12, 12);
    expect(before.RightLowerLeg?.positionM[1]).toBeCloseTo(0.45, 12);
    expect(before.Head).toBe(goals.Head);
    // The hips are over the carriageway: the foot behind still stands a kerb higher.
    const after = ground.carried(goals, -2, 1.7);
    expect(after.LeftLowerLeg?.positionM[1]).toBeCloseTo(0.45, 12);
    expect(after.RightLowerLeg?.positionM[1]).toBeCloseTo(0.45 + 0.12, 12);
    expect(ground.carried(NO_GOALS, 0, 1.7)).toEqual(NO_GOALS);
  });
});

describe("a phase on the road", () => {
  const order = { ...ORDER, limb: null, preparation_s: 1, duration_s: 60, until_completions: 2 };
  const started = () => {
    const run = new RoadRun({ ...order, has_road: true }, ROAD, 0);
    run.walk(0, 0, 0);
    run.frame(1, null, true);
    return run;
  };

  it("says where the participant was at every step, interpolated between frames", () => {
    const run = started();
    // The frame in which the clock starts is step 0.
    expect(run.walk(1, 0, 0)).toEqual([[0, -3.3, Math.PI / 2, 0]]);
    const places = run.walk(1.05, 0, -0.05);
    expect(places.map(([, y]) => y)).toEqual([expect.closeTo(-3.28, 9), expect.closeTo(-3.26, 9)]);
    expect(places[0]?.[3]).toBeCloseTo(1, 9);
    expect(run.walk(1.055, 0, -0.055)).toEqual([]);
    expect(run.walk(1.06, 0, -0.06)).toHaveLength(1);
  });

  it("reports a crossing behind the other kerb, not one who turned back, and ends after two", () => {
    const run = started();
    let timeS = 1;
    const walk = (zM: number) => {
      timeS += 0.5;
      run.walk(timeS, 0, zM);
      return run.frame(timeS, null, true).map((one) => one.kind);
    };
    expect([0, -3, 0].flatMap(walk)).toEqual([]);
    expect([-3, -6, -6.2].flatMap(walk)).toEqual(["completion"]);
    expect(run.completed).toBe(1);
    expect([-3, 0].flatMap(walk)).toEqual(["completion", "phase"]);
    expect(run.isFrozen).toBe(true);
  });

  it("begins on the start square, once cars drive, with the whole preparation", () => {
    const run = new RoadRun({ ...order, has_road: true }, ROAD, 0);
    const said = (timeS: number) => run.frame(timeS, null, true).map((one) => one.kind);
    run.walk(0, 0, -6.6);
    expect([run.awaits, said(3)]).toEqual(["start", []]);
    run.walk(3, 0.1, 0);
    run.followTraffic(false);
    expect([run.awaits, run.preparationLeftS(3)]).toEqual(["traffic", 1]);
    expect(said(5)).toEqual([]);
    run.followTraffic(true);
    expect([run.awaits, said(5.1)]).toEqual([null, ["phase"]]);
    run.walk(5.2, 0.1, 0);
    run.walk(5.3, 0.1, -0.1);
    expect(run.completed).toBe(0);
  });

  it("sends whoever has not crossed yet to the start, and praises only the others", () => {
    const run = new RoadRun({ ...order, has_road: true }, ROAD, 0);
    run.walk(0, 0, -6.6);
    expect([phaseOf(run, 0, false), phaseOf(run, 0, true)]).toEqual(["to_start", "walk_back"]);
    run.walk(1, 0, 0);
    expect(phaseOf(run, 1, false)).toBe("preparing");
  });

  it("goes on after a pause only with cars; another scene's steps count from there", () => {
    const run = started();
    run.walk(1.5, 0, 0);
    run.stop(2, "road");
    run.followTraffic(false);
    const resuming = { ...run.order, status: "paused", resuming: true } as const;
    expect(run.follow(resuming, 3)).toEqual([]);
    expect(run.enterScene(3, 0, -1)).toEqual([0, -2.3, Math.PI / 2, 0]);
    run.followTraffic(true);
    expect(run.follow(resuming, 4)).toHaveLength(1);
    // Step 0 of the new scene is where and when it began.
    expect(run.walk(4, 0, -1)).toEqual([[0, -2.3, Math.PI / 2, 0]]);
    expect(run.walk(4.041, 0, -1)).toHaveLength(2);
  });

  it("says no place while its clock stands", () => {
    const run = started();
    run.walk(1, 0, 0);
    run.stop(1.1, "test");
    expect(run.walk(1.5, 0, -0.5)).toEqual([]);
  });
});

describe("the socket", () => {
  class Socket {
    readyState = 1;
    readonly sent: unknown[] = [];
    onopen: (() => void) | null = null;
    onmessage: ((event: { data: string }) => void) | null = null;
    onclose: ((event: { code: number }) => void) | null = null;
    send(text: string): void {
      this.sent.push(JSON.parse(text));
    }
    hears(message: object): void {
      this.onmessage?.({ data: JSON.stringify(message) });
    }
    close(): void {}
  }
  const welcome = { type: "welcome", run: "r", phase_id: 4, begins_at_s: 0, step_s: 0.02 };
  const place = [0, -3.3, 1.57, 0] as const;

  it("sends every place once it is welcome, and again what a lost connection did not bring", () => {
    const sockets: Socket[] = [];
    const make = () => {
      const socket = new Socket();
      sockets.push(socket);
      return socket as unknown as WebSocket;
    };
    const link = new RoadLink({
      ...{ url: "ws://lab/api/vr/road", token: "t", phaseId: 4, activeS: 0, place },
      makeSocket: make,
    });
    const [first] = sockets as [Socket];
    first.onopen?.();
    link.say([place, place], true);
    expect(first.sent).toEqual([{ type: "hello", phase_id: 4, active_s: 0, place, run: null }]);
    first.hears({ ...welcome, next_step: 0 });
    expect(first.sent.slice(1)).toEqual([
      { type: "clock", running: true },
      { type: "places", first_step: 0, places: [place, place] },
    ]);
    expect(link.hasTraffic).toBe(false);
    first.hears({ type: "actors", step: 0, active_s: 0, actors: [] });
    expect(link.hasTraffic).toBe(true);
    first.hears({ type: "ended", problem: "SUMO stopped" });
    expect([link.problem, link.hasTraffic]).toEqual(["SUMO stopped", false]);
    link.close();
    expect(first.sent.at(-1)).toEqual({ type: "end" });
  });
});
