/**
 * Runs a phase at the boxes from frames and commands: contacts, rules and intervals in one place.
 * The server's `app/science/tasks/run.py`, without the check of a stored record, which it makes.
 */
import type { Touches } from "./contacts";
import { advance } from "./rules";
import type { Command, CommandKind, ContactChange, TaskEvent, TaskRules, TaskState } from "./state";
import { type ContactInterval, ContactTracker } from "./tracker";

/** Inputs must come in order of time; a rejected one (TaskRuleError) changes nothing. */
export class TaskRun {
  /** Everything so far. */
  readonly events: TaskEvent[] = [];
  readonly intervals: ContactInterval[] = [];
  readonly #tracker: ContactTracker;
  #state: TaskState;

  constructor(rules: TaskRules, parts: readonly string[], state = rules.initial()) {
    this.#state = state;
    const surfaces = rules.layout.surfaces.map(({ key }) => key);
    this.#tracker = new ContactTracker(surfaces, parts);
  }

  get state(): TaskState {
    return this.#state;
  }

  command(command: CommandKind, timeS: number): void {
    this.apply({ command, timeS });
  }

  /** Apply the contacts of one frame; without a change nothing is allocated. */
  frame(timeS: number, touches: Touches): void {
    const change = this.#tracker.observe(timeS, touches);
    if (change !== null) this.apply(change);
  }

  apply(step: ContactChange | Command): void {
    const { state, events } = advance(this.#state, step);
    this.#state = state;
    this.intervals.push(...this.#tracker.settle(state));
    this.events.push(...events);
  }
}

/** One completed task of a phase. */
export interface Completion {
  readonly number: number;
  readonly completedS: number;
  readonly completedActiveS: number;
  /** Active time since the completion before, or since the start. */
  readonly durationS: number;
  /** Panel keys as they turned green. */
  readonly order: readonly string[];
  /** Mistakes made during this task. */
  readonly outOfOrder: number;
  readonly wrongPart: number;
  readonly targetEarly: number;
}

/** The completed tasks of a phase, in order. */
export function completionsOf(events: readonly TaskEvent[]): readonly Completion[] {
  const found: Completion[] = [];
  let sinceS = 0;
  let task: TaskEvent[] = [];
  for (const event of events) {
    task.push(event);
    if (event.kind !== "task_completed") continue;
    const count = (kind: TaskEvent["kind"]) => task.filter((one) => one.kind === kind).length;
    found.push({
      number: found.length + 1,
      completedS: event.timeS,
      completedActiveS: event.activeS,
      durationS: event.activeS - sinceS,
      order: task.flatMap(({ kind, surface }) => (kind === "panel_green" && surface) || []),
      outOfOrder: count("out_of_order"),
      wrongPart: count("wrong_part"),
      targetEarly: count("target_early"),
    });
    sinceS = event.activeS;
    task = [];
  }
  return found;
}
