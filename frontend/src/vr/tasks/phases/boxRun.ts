/**
 * A hand or foot phase on the headset: the task rules applied to the avatar's touches, and reports of
 * what came of them. The server's `app/rehearsal/task_run.py`.
 */
import type { PhaseOrder, ReportBody } from "../../telemetry";
import type { ActiveClock } from "../clock";
import type { Touches } from "../contacts";
import type { SurfaceKind } from "../layout";
import { completionsOf, TaskRun } from "../run";
import type { CommandKind, EventKind, TaskEvent, TaskRules, TaskState } from "../state";
import type { ContactInterval } from "../tracker";
import { NOTHING, type Reports, TimedRun } from "./timedRun";

const EFFECTS: Readonly<Partial<Record<EventKind, string>>> = {
  panel_green: "green",
  out_of_order: "out_of_order",
  wrong_part: "wrong_part",
  target_early: "early",
  task_completed: "completed",
};

const WALKS_BACK = {
  walk_back_begun: "walk_back_started",
  walk_back_ended: "walk_back_ended",
} as const;

/** One phase at the boxes: contact intervals and completions become reports. */
export class BoxRun extends TimedRun {
  readonly #run: TaskRun;
  readonly #completedBefore: number;
  #reportedEvents = 0;
  #reportedIntervals = 0;
  #reportedCompletions = 0;

  /** @param parts the parts of the avatar whose touches are given, in their order */
  constructor(order: PhaseOrder, rules: TaskRules, parts: readonly string[], timeS: number) {
    super(order, timeS);
    const initial = rules.initial();
    // An earlier run of the client has already reversed the order.
    const isReversed = rules.layout.reverseAfterTask && order.completions % 2 === 1;
    const state = isReversed ? { ...initial, order: initial.order.toReversed() } : initial;
    this.#run = new TaskRun(rules, parts, state);
    this.#completedBefore = order.completions;
  }

  get state(): TaskState {
    return this.#run.state;
  }

  get clock(): ActiveClock {
    return this.#run.state.clock;
  }

  /** Tasks completed in this phase, with those of earlier runs of the client. */
  get completed(): number {
    return this.#completedBefore + this.state.completed;
  }

  override get endsEarly(): boolean {
    const required = this.order.until_completions;
    const done = this.#completedBefore + this.#reportedCompletions;
    return required !== null && this.clockRuns && done >= required;
  }

  protected command(kind: CommandKind, timeS: number): void {
    this.#run.command(kind, timeS);
  }

  protected touch(timeS: number, touches: Touches): void {
    this.#run.frame(timeS, touches);
  }

  protected news(): Reports {
    const { events, intervals } = this.#run;
    if (events.length === this.#reportedEvents && intervals.length === this.#reportedIntervals) {
      return NOTHING;
    }
    const newEvents = events.slice(this.#reportedEvents);
    const reports = intervals.slice(this.#reportedIntervals).map((one) => this.#contact(one));
    this.#reportedEvents = events.length;
    this.#reportedIntervals = intervals.length;
    if (newEvents.some(({ kind }) => kind === "task_completed")) {
      reports.push(...this.#newCompletions());
    }
    reports.push(...this.#walksBack(newEvents));
    return reports;
  }

  #walksBack(events: readonly TaskEvent[]): Reports {
    return events.flatMap(({ kind, timeS }) =>
      kind === "walk_back_begun" || kind === "walk_back_ended"
        ? [this.report(WALKS_BACK[kind], timeS)]
        : [],
    );
  }

  #newCompletions(): Reports {
    const done = completionsOf(this.#run.events);
    const fresh = done.slice(this.#reportedCompletions);
    this.#reportedCompletions = done.length;
    const { byKey } = this.state.rules.layout;
    return fresh.map((one) => ({
      kind: "completion",
      phase_id: this.order.phase_id,
      number: this.#completedBefore + one.number,
      t_s: one.completedS,
      active_s: this.spentS + one.completedActiveS,
      duration_s: one.durationS,
      order: one.order.map((key) => byKey.get(key)?.box ?? 0),
      out_of_order_touches: one.outOfOrder,
    }));
  }

  #contact(interval: ContactInterval): ReportBody {
    const surface = this.state.rules.layout.byKey.get(interval.surface);
    const { kind = "side", box = null, side = null } = surface ?? {};
    return {
      kind: "contact",
      phase_id: this.order.phase_id,
      surface: interval.surface,
      surface_kind: kind,
      box,
      side,
      body_part: interval.part,
      begin_s: interval.beginS,
      end_s: interval.endS,
      begin_active_s: this.spentS + interval.beginActiveS,
      end_active_s: this.spentS + interval.endActiveS,
      effect: this.#effect(interval, kind),
    };
  }

  /** How the task counted the touch that began the interval. */
  #effect({ surface, part, beginS }: ContactInterval, kind: SurfaceKind): string {
    if (kind === "side" || kind === "start") return kind;
    const { events } = this.#run;
    for (let at = events.length - 1; at >= 0; at--) {
      const event = events[at] as TaskEvent;
      if (event.timeS < beginS) break;
      const effect = EFFECTS[event.kind];
      const isSame = event.surface === surface && event.part === part && event.timeS === beginS;
      if (isSame && effect !== undefined) return effect;
    }
    return "none";
  }
}
