import { JOINTS } from "@shared/avatar/anatomy.generated";
import { loadMujoco, type Mujoco } from "@shared/avatar/mujoco";
import { beforeAll, describe, expect, it } from "vitest";
import type { AvatarOrder } from "../telemetry/wire/fromServer";
import { DelayedCopy } from "./delayedCopy";
import { FollowedBody } from "./followedBody";
import type { RemoteBody } from "./remoteBody";
import { answer } from "./testing/person";

const RATE_HZ = 90;
const FRAME_S = 1 / RATE_HZ;
const SWING_HZ = 0.5;
const ELBOW = 3 + 4 * JOINTS.indexOf("LeftLowerArm");

let mujoco: Mujoco;
beforeAll(async () => {
  mujoco = await loadMujoco();
});

const physics = () => new FollowedBody(mujoco, answer(), 1, false, JOINTS);
const copy = () => new DelayedCopy(1.75, false, []);
const WEIGHTLESS: AvatarOrder = {
  revision: 1,
  gravity: false,
  self_collision: null,
  colliders: {},
  layers: [],
  held_rad: {},
  motors: {},
};

/** A person who hovers in the T-pose, the left elbow bent by this angle. */
function bentBy(angleRad: number, hipsX = 0): Float64Array {
  const own = new Float64Array(3 + 4 * JOINTS.length);
  own.set([hipsX, 1.3, 0]);
  for (let at = 3; at < own.length; at += 4) own[at] = 1;
  own[ELBOW] = Math.cos(angleRad / 2);
  own[ELBOW + 2] = -Math.sin(angleRad / 2);
  return own;
}

const elbowRad = (pose: Float64Array): number =>
  2 * Math.atan2(-(pose[ELBOW + 2] as number), pose[ELBOW] as number);

const swing = (timeS: number): number => 1 - 0.6 * Math.cos(2 * Math.PI * SWING_HZ * timeS);

/** The delay of a swing between what was asked and what was shown, by its phase. */
function latencyS(body: RemoteBody, orderedS: number): number {
  body.setLatency(orderedS);
  const sums = { targetSine: 0, targetCosine: 0, sine: 0, cosine: 0 };
  const begin = 2 * RATE_HZ;
  for (let frame = 0; frame < begin + (2 * RATE_HZ) / SWING_HZ; frame++) {
    const timeS = frame * FRAME_S;
    body.frame(timeS, bentBy(swing(timeS)), null);
    if (frame < begin) continue;
    const phase = 2 * Math.PI * SWING_HZ * timeS;
    const shown = elbowRad(body.pose);
    sums.targetSine += swing(timeS) * Math.sin(phase);
    sums.targetCosine += swing(timeS) * Math.cos(phase);
    sums.sine += shown * Math.sin(phase);
    sums.cosine += shown * Math.cos(phase);
  }
  const turn = Math.atan2(sums.sine, sums.cosine) - Math.atan2(sums.targetSine, sums.targetCosine);
  const wrapped = turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI));
  return wrapped / (2 * Math.PI * SWING_HZ);
}

describe("the latency between what is asked and what is shown", () => {
  it.each([0, 0.125, 0.35])("is the ordered one, %f s, within a frame", (orderedS) => {
    for (const body of [physics(), copy()]) {
      expect(Math.abs(latencyS(body, orderedS) - orderedS)).toBeLessThan(FRAME_S);
      body.dispose();
    }
  });
});

describe("a gap of more than 100 ms between two frames", () => {
  it("is skipped and counted, and the body moves on gently", () => {
    const body = physics();
    for (let frame = 0; frame < RATE_HZ; frame++) body.frame(frame * FRAME_S, bentBy(0.2), null);
    const beforeS = body.avatar.timeS;
    const wakesS = 5;
    body.frame(wakesS, bentBy(2, 0.2), null);
    expect(body.skippedGaps).toBe(1);
    expect(body.avatar.timeS - beforeS).toBeLessThan(0.02);
    expect(body.pose[0]).toBeCloseTo(0.2, 9);
    expect(elbowRad(body.pose)).toBeLessThan(0.35);
    for (let frame = 1; frame < RATE_HZ; frame++) {
      body.frame(wakesS + frame * FRAME_S, bentBy(2, 0.2), null);
    }
    expect(Math.abs(elbowRad(body.pose) - 2)).toBeLessThan(0.1);
    expect(body.skippedGaps).toBe(1);
    expect(body.health).toMatchObject({ restored: 0, resets: 0 });
    body.dispose();
  });

  it("does not come from frames at 72 Hz or one that was late", () => {
    const body = physics();
    for (let frame = 0; frame < 72; frame++) body.frame(frame / 72, bentBy(0.2), null);
    body.frame(1.08, bentBy(0.2), null);
    expect(body.skippedGaps).toBe(0);
    body.dispose();
  });
});

describe("a body that is teleported", () => {
  it("stays whole, and every jump is counted", () => {
    const body = physics();
    for (let frame = 0; frame < 4 * RATE_HZ; frame++) {
      const isThere = Math.floor(frame / 20) % 2 === 1;
      body.frame(frame * FRAME_S, bentBy(0.3, isThere ? 3 : 0), null);
      expect(body.pose.every(Number.isFinite)).toBe(true);
    }
    expect(body.health).toMatchObject({ restored: 0, resets: 0 });
    expect(body.health.teleports).toBe(1 + 17);
    body.dispose();
  });
});

describe("a simulation that fails", () => {
  it("is restored, noticed and goes on", () => {
    const body = physics();
    for (let frame = 0; frame < 30; frame++) body.frame(frame * FRAME_S, bentBy(0.3), null);
    body.avatar.views.qvel.fill(Number.NaN);
    body.frame(30 * FRAME_S, bentBy(0.3), null);
    expect(body.health.restored).toBe(1);
    expect(body.pose.every(Number.isFinite)).toBe(true);
    for (let frame = 31; frame < 60; frame++) body.frame(frame * FRAME_S, bentBy(0.3), null);
    expect(body.health.restored).toBe(1);
    body.dispose();
  });

  it("and a clock that MuJoCo has set to zero by itself is noticed", () => {
    const body = physics();
    for (let frame = 0; frame < 30; frame++) body.frame(frame * FRAME_S, bentBy(0.3), null);
    mujoco.mj_resetData(body.avatar.model, body.avatar.data);
    body.frame(30 * FRAME_S, bentBy(0.3), null);
    expect(body.health).toMatchObject({ restored: 1, resets: 1 });
    expect(body.avatar.data.time).toBeCloseTo(body.avatar.timeS, 9);
    body.dispose();
  });
});

describe("memory", () => {
  it("may grow under a body that is simulated", () => {
    const [one, other] = [physics(), physics()];
    let large: { delete(): void } | null = null;
    for (let frame = 0; frame < 40; frame++) {
      for (const body of [one, other]) body.frame(frame * FRAME_S, bentBy(0.5), null);
      if (frame === 20) large = new mujoco.DoubleBuffer(20_000_000);
    }
    expect([...one.pose]).toEqual([...other.pose]);
    expect(Math.abs(elbowRad(one.pose) - 0.5)).toBeLessThan(0.1);
    large?.delete();
    for (const body of [one, other]) body.dispose();
  });

  it("is freed with the bodies, so that making them again does not take more", () => {
    const bytes = (): number => {
      const probe = new mujoco.DoubleBuffer(1);
      const { byteLength } = (probe.GetView() as Float64Array).buffer;
      probe.delete();
      return byteLength;
    };
    for (let round = 0; round < 2; round++) physics().dispose();
    const before = bytes();
    for (let round = 0; round < 12; round++) physics().dispose();
    expect(bytes()).toBe(before);
  });
});

describe("changes of a running body", () => {
  it("move a cast at 1.5 rad/s to its angle and hold it there", () => {
    const body = physics();
    body.frame(0, bentBy(0.2), null);
    const held = body.change({ ...WEIGHTLESS, held_rad: { LeftLowerArmY: 1.4 } });
    expect(held).toEqual({ LeftLowerArmY: 1.4 });
    for (let frame = 1; frame <= 36; frame++) body.frame(frame * FRAME_S, bentBy(0.2), null);
    expect(Math.abs(elbowRad(body.pose) - (0.2 + 1.5 * 0.4))).toBeLessThan(0.05);
    for (let frame = 37; frame < 120; frame++) body.frame(frame * FRAME_S, bentBy(0.2), null);
    expect(Math.abs(elbowRad(body.pose) - 1.4)).toBeLessThan(0.02);
    expect(() => body.change({ ...WEIGHTLESS, held_rad: { LeftLowerArmY: 9 } })).toThrow(
      /cannot be held/,
    );
    body.dispose();
  });

  it("are refused by a delayed copy", () => {
    expect(() => copy().change()).toThrow(/no motors/);
  });
});
