/** Bodies computed in the page's own thread: nothing is added to the latency. */
import { loadMujoco } from "@shared/avatar/mujoco";
import type { AvatarOrder } from "../telemetry/wire/fromServer";
import { type Bodies, type BodiesFrame, type BodiesInput, CannotChange } from "./bodies";
import { BodiesEngine } from "./engine";
import { partsOf } from "./parts";
import type { BodiesSetup } from "./setup";

/** Make the bodies; the page's policy must allow `'unsafe-eval'` (tests, benchmarks). */
export async function openBodiesInPage(setup: BodiesSetup): Promise<Bodies> {
  return new BodiesInPage(new BodiesEngine(await loadMujoco(), setup), partsOf(setup));
}

/** The mutable frame that is shown again and again. */
type Shown = { -readonly [Key in keyof BodiesFrame]: BodiesFrame[Key] };

class BodiesInPage implements Bodies {
  readonly addedS = 0;
  private readonly shown: Shown;
  private hasFrame = false;

  constructor(
    private readonly engine: BodiesEngine,
    readonly touchingParts: readonly string[],
  ) {
    const { own, worn } = engine;
    this.shown = {
      timeS: 0,
      local: own.pose,
      remote: worn.pose,
      localFingers: null,
      remoteFingers: null,
      goalErrorsM: own.goalErrorsM,
      touched: worn.touched,
      near: worn.near,
      tookMs: 0,
      ikMs: 0,
      health: worn.health,
    };
  }

  get skippedGaps(): number {
    return this.engine.skippedGaps;
  }

  wear(body: string | null): void {
    this.engine.wear(body);
  }

  setLatency(orderedS: number): void {
    this.engine.setLatency(orderedS);
  }

  showSurfaces(keys: readonly string[]): void {
    this.engine.showSurfaces(keys);
  }

  change(order: AvatarOrder): Promise<Readonly<Record<string, number>>> {
    return new Promise((resolve, reject) => {
      this.engine.change(order, {
        onHeld: resolve,
        onProblem: (problem) => reject(new CannotChange(problem)),
      });
    });
  }

  step({ timeS, goals, fingers }: BodiesInput): void {
    const { engine, shown } = this;
    engine.frame(timeS, goals, fingers);
    const { worn } = engine;
    shown.timeS = timeS;
    shown.remote = worn.pose;
    shown.localFingers = worn.fingers === null ? null : fingers;
    shown.remoteFingers = worn.fingers;
    shown.touched = worn.touched;
    shown.near = worn.near;
    shown.ikMs = engine.ikMs;
    shown.tookMs = engine.ikMs + engine.remoteMs;
    shown.health = worn.health;
    this.hasFrame = true;
  }

  latest(): BodiesFrame | null {
    return this.hasFrame ? this.shown : null;
  }

  dispose(): void {
    this.engine.dispose();
  }
}
