/**
 * The phases of a session, one after the other, as the server's state orders them: which one runs,
 * when it is entered and left, and what it reports (`app/rehearsal/headset.py` does the same).
 */
import type { HeadsetState, PhaseOrder, Road } from "../../telemetry";
import type { Touches } from "../contacts";
import type { Limb, TaskLayout } from "../layout";
import { TaskRules } from "../state";
import { BoxRun } from "./boxRun";
import { RoadRun } from "./roadRun";
import { FreeRun, type Reports, type TimedRun } from "./timedRun";

/** What the phases need of the headset around them. */
export interface PhaseSurroundings {
  /** Send reports; the frames that led to them first. Never called without any. */
  report(reports: Reports): void;
  /**
   * A phase begins: send the frames so far, wear its body, set its latency, show its boxes (null:
   * none).
   */
  enter(order: PhaseOrder, layout: TaskLayout | null): void;
  /** The phase has ended or was voided: send its frames, remove latency and boxes. */
  leave(order: PhaseOrder): void;
  /** The parts of the avatar whose touches are given, in their order. */
  touchingParts(): readonly string[];
}

export class Phases {
  #run: TimedRun | null = null;
  #lastPhaseId = 0;

  constructor(
    private readonly layouts: ReadonlyMap<Limb, TaskLayout>,
    private readonly around: PhaseSurroundings,
    /** The study's road, if it has one. */
    private readonly road: Road | null = null,
  ) {}

  /** The phase that runs; null between phases. */
  get run(): TimedRun | null {
    return this.#run;
  }

  /** The id of the running phase, 0 between phases: as batches of frames carry it. */
  get phaseId(): number {
    return this.#run === null ? 0 : this.#lastPhaseId;
  }

  /**
   * Bring the headset in line with the session's state.
   *
   * `isSettled`: all reports are acknowledged. The state of a running phase is acted on only then,
   * since an earlier one may not include them.
   */
  follow(state: HeadsetState, isSettled: boolean, timeS: number): void {
    const order = state.phase;
    const run = this.#run;
    if (run !== null && run.order.phase_id === order?.phase_id) {
      if (isSettled) this.#report(run.follow(order, timeS));
      return;
    }
    // Another phase was started, or this one is gone: it was voided.
    if (run !== null) this.#leave(run);
    // An order may be older than our own report that its phase has ended.
    if (order !== null && order.phase_id > this.#lastPhaseId) {
      this.#enter(order, state.participant.handedness, timeS);
    }
  }

  /** Advance the running phase by the frame that is shown now. */
  frame(timeS: number, touches: Touches | null, isConnected: boolean): void {
    const run = this.#run;
    if (run === null) return;
    this.#report(run.frame(timeS, touches, isConnected));
    if (run.hasEnded) this.#leave(run);
  }

  /** Stop the clock for a reason of the headset's own; the operator resumes. */
  stop(timeS: number, cause: string): void {
    if (this.#run !== null) this.#report(this.#run.stop(timeS, cause));
  }

  /** Call before the first frame after a gap of half a second or more: the device was asleep. */
  wake(lastFrameS: number, nowS: number): void {
    if (this.#run !== null) this.#report(this.#run.wake(lastFrameS, nowS));
  }

  #enter(order: PhaseOrder, handedness: string | null, timeS: number): void {
    const layout = layoutFor(order, this.layouts);
    this.#lastPhaseId = order.phase_id;
    this.around.enter(order, layout);
    if (layout === null) {
      const onRoad = order.has_road === true && this.road !== null;
      this.#run = onRoad ? new RoadRun(order, this.road, timeS) : new FreeRun(order, timeS);
      return;
    }
    // As the server assumes, which derives the completions again.
    const rules = new TaskRules(layout, handedness === "left" ? "left" : "right");
    this.#run = new BoxRun(order, rules, this.around.touchingParts(), timeS);
  }

  #leave(run: TimedRun): void {
    this.around.leave(run.order);
    this.#run = null;
  }

  #report(reports: Reports): void {
    if (reports.length > 0) this.around.report(reports);
  }
}

function layoutFor(
  { limb, phase_id }: PhaseOrder,
  layouts: ReadonlyMap<Limb, TaskLayout>,
): TaskLayout | null {
  if (limb === null) return null;
  const layout = limb === "hand" || limb === "foot" ? layouts.get(limb) : undefined;
  if (layout === undefined) {
    throw new Error(
      `Phase ${phase_id} is a task for the ${limb}, and the study's tasks have ` +
        `${[...layouts.keys()].join(" and ") || "none"}. Load the page again.`,
    );
  }
  return layout;
}
