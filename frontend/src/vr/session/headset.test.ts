import { describe, expect, it } from "vitest";
import type { RoadLink } from "../road";
import type { Road } from "../telemetry";
import { Headset } from "./headset";
import type { View } from "./ports";
import { FakeBodies, FakeSource, FakeTelemetry, Kept, ORDER, STATE } from "./testing";

const RATE_HZ = 90;
/** WebXR's frames are told apart from a screen's by being there. */
const XR = {} as XRFrame;

const ROAD: Road = {
  road: { half_length_m: 100, lane_width_m: 2.5, pavement_width_m: 2, crossing_width_m: 4 },
  kerb_height_m: 0.12,
  starts_behind_kerb_m: 0.8,
  step_s: 0.02,
};

/** A scene of the road that a test lets drive or break off. */
class FakeScene {
  hasTraffic = false;
  problem: string | null = null;
  isClosed = false;
  readonly others = { activeS: 0, actors: [] };

  constructor(readonly activeS: number) {}

  say(): void {}

  close(): void {
    this.isClosed = true;
  }
}

async function worn({ lateBy = 0, state = STATE, source = new FakeSource() } = {}) {
  const telemetry = new FakeTelemetry();
  Object.assign(telemetry.welcome, { road: ROAD });
  const scenes: FakeScene[] = [];
  telemetry.state = state;
  const bodies = new FakeBodies(lateBy);
  const views: View[] = [];
  const headset = new Headset({
    telemetry: telemetry.client,
    source,
    keep: new Kept(),
    onSquare: () => undefined,
    prepareBodies: async () => bodies,
    openRoad: (_, activeS) => {
      const scene = new FakeScene(activeS);
      scenes.push(scene);
      return scene as unknown as RoadLink;
    },
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
  const nowS = () => frame / RATE_HZ;
  return { telemetry, bodies, source, views, headset, draw, sleep, scenes, nowS };
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
    const source = new FakeSource({ statureM: 1.75, spanM: 1.8 });
    const { telemetry, draw, views } = await worn({ state, source });
    draw(1);
    // Nobody wears anything that could be calibrated, and that is said.
    expect(telemetry.reports).toEqual([
      expect.objectContaining({ kind: "calibration", cause: "first", notices: ["nothing_worn"] }),
    ]);
    expect(views.at(-1)?.place).toBe("stepping_in");
    source.areGripsPressed = true;
    draw(0.5);
    expect(telemetry.reports.at(-1)?.kind).toBe("materialised");
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

  it("leaves a request to resume pending until the scene is looked at again", async () => {
    const { telemetry, draw, headset, nowS } = await worn();
    telemetry.state = { ...STATE, phase: ORDER };
    draw(1.5);
    const lastS = nowS();
    headset.leave("asleep");
    const paused = phases(telemetry).at(-1);
    expect(paused).toMatchObject({ what: "paused", cause: "asleep", t_s: lastS });
    const active_s = paused?.active_s ?? Number.NaN;
    // Frames go on behind the device's own menu.
    telemetry.state = {
      ...STATE,
      phase: { ...ORDER, status: "paused", active_s, resuming: true },
    };
    draw(2);
    expect(phases(telemetry).at(-1)).toBe(paused);
    expect(headset.run?.activeS(nowS())).toBe(active_s);
    headset.lookAgain();
    draw(1 / RATE_HZ);
    expect(phases(telemetry).at(-1)).toMatchObject({ what: "resumed", t_s: nowS(), active_s });
  });

  it("prepares a phase only while it is looked at", async () => {
    const { telemetry, draw, headset } = await worn();
    telemetry.state = { ...STATE, phase: ORDER };
    draw(ORDER.preparation_s / 2);
    headset.leave("asleep");
    draw(10);
    expect(phases(telemetry)).toEqual([]);
    headset.lookAgain();
    draw(0.4 * ORDER.preparation_s);
    expect(phases(telemetry)).toEqual([]);
    draw(0.2 * ORDER.preparation_s);
    expect(phases(telemetry)).toEqual([expect.objectContaining({ what: "started", active_s: 0 })]);
  });

  it("does not resume while nobody's head is measured, as in a headset that was taken off", async () => {
    const source = new FakeSource();
    const { telemetry, draw, nowS } = await worn({ source });
    telemetry.state = { ...STATE, phase: { ...ORDER, duration_s: 60 } };
    draw(1);
    source.headStillAtM = 0.5;
    draw(3);
    const paused = phases(telemetry).at(-1);
    expect(paused).toMatchObject({ what: "paused", cause: "asleep" });
    const active_s = paused?.active_s ?? Number.NaN;
    telemetry.state = {
      ...STATE,
      phase: { ...ORDER, duration_s: 60, status: "paused", active_s, resuming: true },
    };
    draw(1);
    expect(phases(telemetry).at(-1)).toBe(paused);
    source.headStillAtM = null;
    draw(1 / RATE_HZ);
    expect(phases(telemetry).at(-1)).toMatchObject({ what: "resumed", t_s: nowS() });
  });

  it("does not resume after the participant asked to stop, whatever state is older than that", async () => {
    const { telemetry, draw, headset } = await worn();
    telemetry.state = { ...STATE, phase: ORDER };
    draw(1);
    headset.stop("recentred");
    draw(1 / RATE_HZ);
    const paused = phases(telemetry).at(-1);
    const order = { ...ORDER, status: "paused", active_s: paused?.active_s ?? Number.NaN };
    // The operator's request and the participant's call are on their way at the same time.
    headset.call("stop");
    telemetry.settled = false;
    telemetry.state = { ...STATE, phase: { ...order, resuming: true } };
    draw(0.5);
    // The state that includes the call comes before its acknowledgement.
    telemetry.state = { ...STATE, phase: order };
    telemetry.settled = true;
    draw(0.5);
    expect(phases(telemetry).at(-1)).toBe(paused);
  });

  it("stops its clock when the road's scene breaks off, and begins another when it goes on", async () => {
    const { telemetry, draw, scenes } = await worn();
    const crossing = { ...ORDER, has_road: true, preparation_s: 0.1, duration_s: 60 };
    telemetry.state = { ...STATE, phase: crossing };
    draw(0.3);
    expect(phases(telemetry)).toEqual([]);
    const [first] = scenes as [FakeScene];
    first.hasTraffic = true;
    draw(1);
    expect(phases(telemetry).map(({ what }) => what)).toEqual(["started"]);
    Object.assign(first, { hasTraffic: false, problem: "'cars' has closed its connection." });
    draw(0.1);
    const paused = phases(telemetry).at(-1);
    expect(paused).toMatchObject({ what: "paused", cause: "road" });
    const active_s = paused?.active_s ?? Number.NaN;
    draw(6);
    expect(scenes).toHaveLength(1);
    const resuming = { ...crossing, status: "paused", active_s, resuming: true } as const;
    telemetry.state = { ...STATE, phase: resuming };
    draw(1);
    expect([first.isClosed, scenes.length, scenes[1]?.activeS]).toEqual([true, 2, active_s]);
    expect(phases(telemetry).at(-1)).toBe(paused);
    Object.assign(scenes[1] ?? {}, { hasTraffic: true });
    draw(2 / RATE_HZ);
    expect(phases(telemetry).at(-1)).toMatchObject({ what: "resumed", active_s });
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
