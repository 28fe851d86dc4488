/**
 * A page for tests and benchmarks in a browser: runs frames of a moving person and times them. Set
 * as `globalThis.bodiesBench`; the server ships no such page.
 */
import { loadMujoco } from "@shared/avatar/mujoco";
import type { Bodies } from "../bodies";
import { openBodiesInPage } from "../inPage";
import { BodiesInWorker, openBodiesInWorker } from "../inWorker";
import type { AvatarAnswer } from "../setup";
import { goalsAt } from "./movement";
import { PlainLoop } from "./plainLoop";

const RATE_HZ = 90;

/** Milliseconds of every frame, by part. */
export interface Times {
  readonly ik: readonly number[];
  readonly remote: readonly number[];
  /** What the frame loop itself waits for. */
  readonly page: readonly number[];
}

interface Outcome {
  readonly times: Times;
  readonly addedS: number;
  readonly skippedGaps: number;
  /** Whether the thread and its page share memory. */
  readonly isIsolated: boolean;
  readonly lastPose: readonly number[];
}

const bench = {
  /** Frames of the product's bodies, in the page or in the worker, one after another. */
  async frames(answer: AvatarAnswer, where: "page" | "worker", count: number): Promise<Outcome> {
    const open = where === "page" ? openBodiesInPage : openBodiesInWorker;
    const bodies: Bodies = await open({ avatar: "physics", withFingers: false, bodies: [answer] });
    const times = { ik: [] as number[], remote: [] as number[], page: [] as number[] };
    for (let frame = 0; frame < count; frame++) {
      const timeS = frame / RATE_HZ;
      const goals = goalsAt(timeS);
      const begin = performance.now();
      bodies.step({ timeS, goals, fingers: null });
      const shown = bodies.latest();
      times.page.push(performance.now() - begin);
      if (shown !== null) {
        times.ik.push(shown.ikMs);
        times.remote.push(shown.tookMs - shown.ikMs);
      }
      if (bodies instanceof BodiesInWorker) await bodies.idle();
      else if (frame % RATE_HZ === 0) await new Promise((resolve) => setTimeout(resolve, 0));
    }
    const { addedS, skippedGaps } = bodies;
    const lastPose = [...(bodies.latest()?.remote ?? [])];
    bodies.dispose();
    return { times, addedS, skippedGaps, isIsolated: globalThis.crossOriginIsolated, lastPose };
  },

  /** Frames of the plainest loop, on the page's thread, to compare with. */
  async plain(answer: AvatarAnswer, count: number): Promise<Times> {
    const loop = new PlainLoop(await loadMujoco(), answer.mjcf);
    const times = { ik: [] as number[], remote: [] as number[], page: [] as number[] };
    for (let frame = 0; frame < count; frame++) {
      const goals = goalsAt(frame / RATE_HZ);
      const begin = performance.now();
      loop.frame(frame / RATE_HZ, goals);
      times.page.push(performance.now() - begin);
      times.ik.push(loop.ikMs);
      times.remote.push(loop.remoteMs);
      if (frame % RATE_HZ === 0) await new Promise((resolve) => setTimeout(resolve, 0));
    }
    loop.dispose();
    return times;
  },
};

declare global {
  var bodiesBench: typeof bench;
}
globalThis.bodiesBench = bench;
