/**
 * The inputs of the task rules, their outputs, and the state of a phase: the server's
 * `app/science/tasks/state.py`. All values are immutable; times are seconds of one monotonic clock.
 */
import { ActiveClock } from "./clock";
import type { Laterality, TaskLayout } from "./layout";

/** An input that is not valid in this state; the message says what is. */
export class TaskRuleError extends Error {
  override name = "TaskRuleError";
}

/** One body part (by its name in Unity's HumanBodyBones) on one surface (by its key). */
export interface Contact {
  readonly surface: string;
  readonly part: string;
}

/** A name for a contact; names sort by surface, then by part. */
export const contactName = ({ surface, part }: Contact): string => `${surface}\u0000${part}`;

export type Contacts = ReadonlyMap<string, Contact>;

export type CommandKind = "start" | "pause" | "resume" | "freeze";

export interface Command {
  readonly timeS: number;
  readonly command: CommandKind;
}

/** The contacts that begin and end at one instant. */
export interface ContactChange {
  readonly timeS: number;
  readonly begins: readonly Contact[];
  readonly ends: readonly Contact[];
}

/** The kinds of event in a phase. Only `panel_green` and `task_completed` are progress. */
export type EventKind =
  | "started"
  | "paused"
  | "resumed"
  | "frozen"
  | "panel_green"
  | "task_completed"
  | "order_reversed"
  | "out_of_order"
  | "wrong_part"
  | "target_early"
  | "side_red"
  | "side_white"
  | "walk_back_begun"
  | "walk_back_ended";

export interface TaskEvent {
  readonly kind: EventKind;
  readonly timeS: number;
  readonly activeS: number;
  /** The running task, from 1; a completion has the number of the task it completes. */
  readonly task: number;
  /** For `side_red` and `side_white` the side's unit. */
  readonly surface: string | null;
  readonly part: string | null;
}

const FINGERS = ["Thumb", "Index", "Middle", "Ring", "Little"];
const PHALANGES = ["Proximal", "Intermediate", "Distal"];
const PREFIX = { left: "Left", right: "Right" } as const;

/** A layout together with a participant's writing hand. */
export class TaskRules {
  /** The parts whose touches count: the writing hand with its fingers, or foot and toes. */
  readonly countingParts: ReadonlySet<string>;
  /** Box numbers in the order of the first task. */
  readonly firstOrder: readonly number[];

  constructor(
    readonly layout: TaskLayout,
    /** Determines the direction and, in hand tasks, which parts count. */
    readonly writingHand: Laterality,
  ) {
    this.countingParts = new Set(
      layout.limb === "hand" ? handParts(writingHand) : footParts(layout.countingFoot),
    );
    const startsLeft =
      layout.direction === "by_hand"
        ? writingHand === "left"
        : layout.direction === "left_to_right";
    const leftToRight = Array.from({ length: layout.boxCount }, (_, index) => index + 1);
    this.firstOrder = startsLeft ? leftToRight : leftToRight.reverse();
  }

  /** The state before the start. */
  initial(): TaskState {
    return {
      rules: this,
      order: this.firstOrder,
      greenCount: 0,
      completed: 0,
      goalSinceS: -Infinity,
      clock: ActiveClock.unstarted,
      contacts: new Map(),
      isPaused: false,
      walkBackSinceS: null,
      arrived: new Map(),
      isFrozen: false,
      lastS: -Infinity,
    };
  }
}

function handParts(hand: Laterality): readonly string[] {
  const fingers = FINGERS.flatMap((finger) => PHALANGES.map((phalanx) => finger + phalanx));
  return [...fingers, "Hand"].map((part) => PREFIX[hand] + part);
}

function footParts(foot: Laterality | null): readonly string[] {
  const feet: readonly Laterality[] = foot === null ? ["left", "right"] : [foot];
  return feet.flatMap((one) => [`${PREFIX[one]}Foot`, `${PREFIX[one]}Toes`]);
}

/** The state of a phase, computed from its inputs by `advance`. */
export interface TaskState {
  readonly rules: TaskRules;
  /** Box numbers in the current order; the first `greenCount` of them are green. */
  readonly order: readonly number[];
  readonly greenCount: number;
  readonly completed: number;
  /** When the current goal became current. */
  readonly goalSinceS: number;
  readonly clock: ActiveClock;
  /** Those that exist now, whether or not they count. */
  readonly contacts: Contacts;
  readonly isPaused: boolean;
  /** Null unless walking back. */
  readonly walkBackSinceS: number | null;
  /** Counting feet that stepped on the start square during this walk back and are still on it. */
  readonly arrived: Contacts;
  readonly isFrozen: boolean;
  readonly lastS: number;
}

export const hasStarted = (state: TaskState): boolean => state.clock.lastS !== null;

/** Whether contacts count now: started, and not paused, walking back or frozen. */
export const isActive = (state: TaskState): boolean => state.clock.runningSinceS !== null;

/** The sides that are red now, with the alphabetically first part touching each. */
export function redUnits(state: TaskState): ReadonlyMap<string, string> {
  const red = new Map<string, string>();
  if (!isActive(state)) return red;
  for (const { surface: key, part } of state.contacts.values()) {
    const surface = state.rules.layout.byKey.get(key);
    if (surface?.kind !== "side") continue;
    const first = red.get(surface.unit);
    if (first === undefined || part < first) red.set(surface.unit, part);
  }
  return red;
}
