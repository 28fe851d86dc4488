import { NO_GOALS } from "@shared/avatar/goals";
import { describe, expect, it } from "vitest";
import { Headset } from "./headset";
import type { View } from "./ports";
import { FakeBodies, FakeSource, FakeTelemetry, ORDER, STATE } from "./testing";

const RATE_HZ = 90;
/** WebXR's frames are told apart from a screen's by being there. */
const XR = {} as XRFrame;

async function worn({ lateBy = 0, state = STATE } = {}) {
  const telemetry = new FakeTelemetry();
  telemetry.state = state;
  const bodies = new FakeBodies(lateBy);
  const source = new FakeSource();
  const views: View[] = [];
  const headset = new Headset({
    telemetry: telemetry.client,
    source,
    calibrator: { statureM: null, goals: () => NO_GOALS },
    prepareBodies: async () => bodies,
    scenery: { show: (view) => views.push(view) },
    withFingers: false,
    onBodyWorn: () => undefined,
    onFailure: (error) => {
      throw error;
    },
  });
  let frame = 0;
  const draw = (seconds: number) => {
    const until = frame + Math.round(seconds * RATE_HZ);
    while (frame < until) headset.frame(++frame / RATE_HZ, XR);
  };
  draw(1 / RATE_HZ);
  // The bodies are prepared meanwhile.
  await Promise.resolve();
  await Promise.resolve();
  const sleep = (seconds: number) => {
    frame += Math.round(seconds * RATE_HZ);
  };
  return { telemetry, bodies, source, views, headset, draw, sleep, nowS: () => frame / RATE_HZ };
}

const phases = (telemetry: FakeTelemetry) =>
  telemetry.reports.flatMap((body) => (body.kind === "phase" ? [body] : []));

describe("the headset", () => {
  it("runs a phase from its order to its end, and records every frame once", async () => {
    const { telemetry, draw, headset } = await worn();
    telemetry.state = { ...STATE, phase: ORDER };
    draw(4);
    headset.leave("closed");
    expect(phases(telemetry).map(({ what }) => what)).toEqual(["started", "time_up", "ended"]);
    expect(phases(telemetry)[1]?.active_s).toBe(2);
    const times = telemetry.times("target");
    expect(times).toEqual(telemetry.times("actual"));
    expect(times).toEqual([...new Set(times)]);
    expect(times.length).toBe(4 * RATE_HZ);
    const active = telemetry.sent.flatMap((one) =>
      one.what === "frames" && one.stream === "target" ? [...one.frames.flags] : [],
    );
    expect(Math.abs(active.filter((flag) => flag === 1).length - 2 * RATE_HZ)).toBeLessThan(2);
  });

  it("says of every phase what its own computing adds, and what was taken off", async () => {
    const { telemetry, draw } = await worn({ lateBy: 1 });
    telemetry.state = { ...STATE, phase: { ...ORDER, latency_ms: 125 } };
    draw(0.2);
    const added = telemetry.reports.find(({ kind }) => kind === "added_latency");
    expect(added).toMatchObject({ added_s: 1 / 90, compensated_s: 1 / 90, runs_in: "worker" });
  });

  it("puts the body on when both grips are pressed, and not before", async () => {
    const state = { ...STATE, materialised: false, recording: false, step_kind: "materialise" };
    const { telemetry, source, draw, views } = await worn({ state });
    draw(1);
    expect(telemetry.reports).toEqual([]);
    expect(views.at(-1)?.place).toBe("stepping_in");
    source.areGripsPressed = true;
    draw(0.5);
    expect(telemetry.reports.map(({ kind }) => kind)).toEqual(["materialised"]);
    expect(views.at(-1)?.place).toBe("acting");
  });

  it("stops its clock at the last frame before it slept, and draws at once when it wakes", async () => {
    const { telemetry, draw, sleep, nowS, views } = await worn();
    telemetry.state = { ...STATE, phase: ORDER };
    draw(1.5);
    const lastS = nowS();
    const drawn = views.length;
    sleep(3);
    draw(2 / RATE_HZ);
    const paused = phases(telemetry).at(-1);
    expect(paused).toMatchObject({ what: "paused", cause: "asleep", t_s: lastS });
    expect(paused?.active_s).toBeLessThan(1.1);
    expect(views.length).toBe(drawn + 2);
  });

  it("reports how the goals are known at its first frame and whenever that changes", async () => {
    const { telemetry, draw, headset } = await worn();
    draw(0.1);
    const other = new FakeSource();
    Object.assign(other, { kind: "hands" });
    headset.trackBy(other);
    draw(0.1);
    const goals = telemetry.reports.flatMap((body) => (body.kind === "goals" ? [body] : []));
    expect(goals.map(({ source, frame_seq }) => [source, frame_seq])).toEqual([
      ["controllers", 0],
      ["hands", 9],
    ]);
    expect(goals[0]?.states.Hips).toBe("lost");
  });

  it("applies changes to the avatar once the body has moved, and reports the held angles", async () => {
    const { telemetry, draw } = await worn();
    const change = { revision: 3, gravity: null, self_collision: null, colliders: {}, layers: [] };
    telemetry.state = { ...STATE, avatar_changes: { ...change, held_rad: {}, motors: {} } };
    draw(0.1);
    await Promise.resolve();
    draw(0.1);
    expect(telemetry.reports.filter(({ kind }) => kind === "avatar_changes")).toEqual([
      expect.objectContaining({ revision: 3, applied: true, held_rad: { LeftLowerArmY: 0.5 } }),
    ]);
  });
});
