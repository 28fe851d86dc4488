/**
 * A scripted participant who wears the emulated headset, on the page that is shipped: for browser
 * tests and benchmarks. It is injected into `/vr` before the page's own scripts.
 *
 * The test steps the clock; each frame the person moves, the devices are placed on the person, and
 * the page draws its frame. Where the bodies are computed in a worker, a step ends when the worker
 * has answered, so that the same journey gives the same frames on any machine.
 */
import type { Place } from "@shared/avatar/hips";
import { minus, type Vector } from "@shared/rotations";
import type {} from "../selftest";
import type {} from "../session/inspection";
import type { BoxRun, RoadRun } from "../tasks";
import { currentGoal } from "../tasks/views";
import { rotationTo } from "../tracking/places";
import {
  type ArmPose,
  goalOn,
  marchingStep,
  type ScriptedGoal,
  ScriptedPerson,
  type Traits,
  WornDevices,
} from "../tracking/script";
import { unit } from "../tracking/script/movements";
import type { GoalPart } from "../tracking/tracked";
import { EmulatedHeadset, type EmulatedOptions, type Side } from "./emulatedHeadset";
import { PromptedPerson } from "./promptedPerson";
import { RuleLedger, type RuleRecord } from "./ruleLedger";
import { installVirtualClock } from "./virtualClock";

interface PersonWish {
  readonly statureM: number;
  /** From finger tip to finger tip; the product's usual skeleton has longer arms than most people. */
  readonly spanM?: number;
  readonly seed: number;
  readonly footedness?: "left" | "right";
  /** How the person moves; drawn from the seed if it is left out. */
  readonly traits?: Traits;
}

/** Longer than a new screen takes no press. */
const AIM_FRAMES = 16;
/** A press and the pause after it are each longer than what counts as trembling. */
const HOLD_FRAMES = 18;
const FORWARDS: Vector = [0, 0, -1];

class Journey {
  readonly clock = installVirtualClock();
  readonly headset: EmulatedHeadset;
  person: ScriptedPerson;
  /** Real milliseconds that the page took for each frame. */
  readonly tookMs: number[] = [];
  isBodySolid = true;
  /** Whether the person does the task; else it only stands. */
  isWilling = true;
  /**
   * Whether the person steps on the spot instead of doing the foot task: boxes hold the delayed feet
   * of a solid body back, and then no lag fits what it does.
   */
  isMarching = false;
  readonly #aims: Record<Side, Vector | null> = { left: null, right: null };
  #hasHands = false;
  #devices: WornDevices;
  #prompted: PromptedPerson;
  #leadingFoot: "left" | "right" = "right";
  #hasShins = true;
  readonly #ledger = new RuleLedger();

  constructor(options: EmulatedOptions) {
    this.headset = new EmulatedHeadset(options);
    clearOnlyWhatIsDrawn();
    this.person = new ScriptedPerson({ statureM: 1.75, seed: 1 });
    this.#devices = new WornDevices(this.person);
    this.#prompted = new PromptedPerson(this.person);
  }

  /** Let somebody else wear the headset. */
  wear({ footedness = "right", ...person }: PersonWish): void {
    this.person = new ScriptedPerson(person);
    this.#devices = new WornDevices(this.person);
    this.#prompted = new PromptedPerson(this.person);
    this.#leadingFoot = footedness;
  }

  /** What the page has handed to the task rules so far. */
  get rules(): readonly RuleRecord[] {
    return this.#ledger.records;
  }

  pose(arms: ArmPose): void {
    this.person.take(arms);
  }

  grip(isPressed: boolean): void {
    for (const side of ["left", "right"] as const) this.headset.press(side, "squeeze", isPressed);
  }

  /** Take the trackers off the shins. */
  takeShinsOff(): void {
    this.#hasShins = false;
    for (const side of ["left", "right"] as const) this.headset.setTrackedSource(side, null);
  }

  /** Put the controllers down and show the hands, or the other way round. */
  useHands(isHands: boolean): void {
    this.#hasHands = isHands;
    this.headset.useHands(isHands);
  }

  /** Point at a point of the room; null: no longer. */
  aim(side: Side, pointM: Vector | null): void {
    this.#aims[side] = pointM;
  }

  /**
   * Point at something on the panel and press it by trigger or pinch; resolves to the time of the
   * press, s.
   */
  async press(target: string, side: Side = "right"): Promise<number> {
    const targets = (globalThis.reembodyTest ?? globalThis.reembody)?.panel.targetsM ?? [];
    const found = targets.find((one) => one.target === target);
    if (found === undefined) {
      throw new Error(`no ${target} among ${targets.map((one) => one.target).join(", ")}`);
    }
    this.aim(side, found.atM);
    await this.step(AIM_FRAMES);
    this.headset.press(side, "select", true);
    const pressedS = await this.step(1);
    await this.step(HOLD_FRAMES);
    this.headset.press(side, "select", false);
    await this.step(HOLD_FRAMES);
    return pressedS;
  }

  /** Draw so many frames, at the device's rate or `frameMs` apart; resolves to the last's time, s. */
  async step(frames: number, frameMs: number | null = null): Promise<number> {
    const stepMs = frameMs ?? this.clock.frameMs;
    for (let frame = 0; frame < frames; frame++) {
      this.#move(stepMs);
      const beforeMs = this.clock.realNowMs();
      this.clock.step(stepMs);
      this.tookMs.push(this.clock.realNowMs() - beforeMs);
      const page = globalThis.reembody;
      if (page !== undefined) this.#ledger.watch(page.run, page.epoch, page.touchingParts);
      await this.#answered();
    }
    return this.clock.nowMs / 1000;
  }

  /**
   * Draw frames as somebody who presses both grips while the figure waits to be stepped into; ends
   * early when the session has changed, which may call for the operator. Resolves to how many
   * were drawn.
   */
  async act(frames: number): Promise<number> {
    const page = globalThis.reembody;
    const stage = stageOf(page);
    this.grip(page?.place === "stepping_in");
    let drawn = 0;
    while (drawn < frames && stageOf(page) === stage) {
      await this.step(1);
      drawn++;
    }
    return drawn;
  }

  /** Let go of what was kept about the frames so far, so that only what the page keeps is left. */
  forget(): void {
    this.tookMs.length = 0;
    this.#ledger.forget();
  }

  /** The device sleeps: time passes without frames. */
  sleep(seconds: number): void {
    this.clock.sleep(seconds);
  }

  #move(stepMs: number): void {
    const { person, headset } = this;
    const timeS = (this.clock.nowMs + stepMs) / 1000;
    const asked = globalThis.reembody?.calibration ?? null;
    if (asked === null) this.#prompted.rest();
    else this.#prompted.follow(asked.step, timeS);
    person.pursue(this.isWilling && asked === null ? this.#goal(timeS) : null);
    person.advance(timeS);
    const at = (part: GoalPart): Place => this.#devices.place(part);
    headset.setEyes(at("Head"));
    this.#moveHand("left", at("LeftHand"));
    this.#moveHand("right", at("RightHand"));
    if (!this.#hasShins) return;
    headset.setTrackedSource("left", at("LeftLowerLeg"));
    headset.setTrackedSource("right", at("RightLowerLeg"));
  }

  #moveHand(side: Side, place: Place): void {
    const { headset } = this;
    const aimedM = this.#aims[side];
    if (this.#hasHands) {
      const way = aimedM === null ? FORWARDS : unit(minus(aimedM, place.positionM), FORWARDS);
      headset.setHandRay(side, { ...place, rotation: rotationTo(FORWARDS, way) });
      return;
    }
    headset.setController(side, aimedM === null ? place : headset.aimed(side, place, aimedM));
  }

  /** What the task's rules expect next, as the person sees it in the room. */
  #goal(timeS: number) {
    const run = globalThis.reembody?.run as BoxRun | RoadRun | null | undefined;
    if (run == null) return null;
    this.person.latencyS = run.order.latency_ms / 1000;
    // The page's classes are not those of this script.
    if ("wayAcrossM" in run) return acrossOn(run);
    const { state } = run;
    if (state === undefined) return null;
    const { layout, writingHand } = state.rules;
    if (this.isMarching && layout.limb === "foot") return marchingStep(timeS);
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

  /**
   * Wait until the bodies of this frame are computed, and let the page's messages be handled. The
   * page sleeps meanwhile: on a busy machine the worker needs its processor.
   */
  async #answered(): Promise<void> {
    await nextTask();
    await (globalThis.reembodyTest ?? globalThis.reembody)?.idle();
  }
}

/** Where the session stands, and the phase by the page itself, of which the server hears later. */
function stageOf(page: typeof globalThis.reembody): string {
  const run = page?.run;
  return [page?.state.version, run?.clockRuns, run?.isFrozen].join();
}

/** On the road the person goes to the start, and walks across without looking, there and back. */
function acrossOn(run: RoadRun): ScriptedGoal | null {
  const goesToStart = run.awaits === "start";
  if (!run.clockRuns && !goesToStart) return null;
  const zM = run.completed % 2 === 0 && !goesToStart ? -run.wayAcrossM : 0;
  return { kind: "walk_to", limb: null, targetM: [0, 0, zM], nearM: 0.2, approachM: [0, 0.1, 0] };
}

/**
 * iwer clears the canvas before every frame; where nothing is drawn, that is most of what the
 * machine's imitation of a graphics card would do.
 */
function clearOnlyWhatIsDrawn(): void {
  const { clear } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.clear = function (this: WebGL2RenderingContext, mask) {
    const page = globalThis.reembodyTest ?? globalThis.reembody;
    if (page?.isRendering !== false) clear.call(this, mask);
  };
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
