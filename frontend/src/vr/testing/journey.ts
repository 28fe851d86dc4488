/**
 * A scripted participant who wears the emulated headset, on the page that is shipped: for browser
 * tests and benchmarks. It is injected into `/vr` before the page's own scripts.
 *
 * The test steps the clock; each frame the person moves, the devices are placed on the person, and
 * the page draws its frame. Where the bodies are computed in a worker, a step ends when the worker
 * has answered, so that the same journey gives the same frames on any machine.
 */
import type { Place } from "@shared/avatar/hips";
import type {} from "../session/inspection";
import type { BoxRun } from "../tasks";
import { currentGoal } from "../tasks/views";
import { type ArmPose, goalOn, ScriptedPerson, WornDevices } from "../tracking/script";
import type { GoalPart } from "../tracking/tracked";
import { EmulatedHeadset, type EmulatedOptions } from "./emulatedHeadset";
import { installVirtualClock } from "./virtualClock";

interface PersonWish {
  readonly statureM: number;
  readonly seed: number;
  readonly footedness?: "left" | "right";
}

/** Frames that may pass in a step before it lets the page's other work happen. */
const ANSWER_PATIENCE_MS = 2000;

class Journey {
  readonly clock = installVirtualClock();
  readonly headset: EmulatedHeadset;
  person: ScriptedPerson;
  /** Real milliseconds that the page took for each frame. */
  readonly tookMs: number[] = [];
  isBodySolid = true;
  /** Whether the person does the task; else it only stands. */
  isWilling = true;
  #devices: WornDevices;
  #leadingFoot: "left" | "right" = "right";
  #hasShins = true;

  constructor(options: EmulatedOptions) {
    this.headset = new EmulatedHeadset(options);
    this.person = new ScriptedPerson({ statureM: 1.75, seed: 1 });
    this.#devices = new WornDevices(this.person);
  }

  /** Let somebody else wear the headset. */
  wear({ statureM, seed, footedness = "right" }: PersonWish): void {
    this.person = new ScriptedPerson({ statureM, seed });
    this.#devices = new WornDevices(this.person);
    this.#leadingFoot = footedness;
  }

  pose(arms: ArmPose): void {
    this.person.take(arms);
  }

  grip(isPressed: boolean): void {
    for (const side of ["left", "right"] as const) this.headset.press(side, "squeeze", isPressed);
  }

  /** Draw so many frames; resolves to the time of the last, s. */
  async step(frames: number): Promise<number> {
    for (let frame = 0; frame < frames; frame++) {
      this.#move();
      const beforeMs = this.clock.realNowMs();
      this.clock.step();
      this.tookMs.push(this.clock.realNowMs() - beforeMs);
      await this.#answered();
    }
    return this.clock.nowMs / 1000;
  }

  /** The device sleeps: time passes without frames. */
  sleep(seconds: number): void {
    this.clock.sleep(seconds);
  }

  #move(): void {
    const { person, headset } = this;
    const timeS = (this.clock.nowMs + this.clock.frameMs) / 1000;
    person.pursue(this.isWilling ? this.#goal() : null);
    person.advance(timeS);
    const at = (part: GoalPart): Place => this.#devices.place(part);
    headset.setEyes(at("Head"));
    headset.setController("left", at("LeftHand"));
    headset.setController("right", at("RightHand"));
    if (!this.#hasShins) return;
    headset.setTrackedSource("left", at("LeftLowerLeg"));
    headset.setTrackedSource("right", at("RightLowerLeg"));
  }

  /** What the task's rules expect next, as the person sees it in the room. */
  #goal() {
    const run = globalThis.reembody?.run as BoxRun | null | undefined;
    const state = run?.state;
    if (run == null || state === undefined) return null;
    this.person.latencyS = run.order.latency_ms / 1000;
    const { layout, writingHand } = state.rules;
    const key = currentGoal(state);
    return goalOn(key === null ? null : (layout.byKey.get(key) ?? null), {
      limb: layout.limb,
      surfaces: layout.surfaces,
      writingHand,
      leadingFoot: this.#leadingFoot,
      countingFoot: layout.countingFoot,
      greenCount: state.greenCount,
      isSolid: this.isBodySolid,
    });
  }

  /** Wait until the bodies of this frame are computed, and let the page's messages be handled. */
  async #answered(): Promise<void> {
    const untilMs = this.clock.realNowMs() + ANSWER_PATIENCE_MS;
    do {
      await nextTask();
      if (globalThis.reembody?.isIdle ?? true) return;
    } while (this.clock.realNowMs() < untilMs);
  }
}

const channel = new MessageChannel();
const waiting: (() => void)[] = [];
channel.port1.onmessage = () => waiting.shift()?.();

/** Let everything that is due happen: timers are throttled to 4 ms, messages are not. */
function nextTask(): Promise<void> {
  return new Promise((resolve) => {
    waiting.push(resolve);
    channel.port2.postMessage(null);
  });
}

declare global {
  var journey: Journey;
  var journeyOptions: EmulatedOptions | undefined;
}

globalThis.journey = new Journey(
  globalThis.journeyOptions ?? { bodyTracking: false, trackedSources: true },
);
