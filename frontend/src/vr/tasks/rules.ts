/**
 * The rules of the box task as a pure state machine: state + input -> state + events. The server's
 * `app/science/tasks/rules.py` states the rules in words; the vectors in `tests/vectors/tasks` hold
 * both to the same results.
 */
import {
  type Command,
  type CommandKind,
  type Contact,
  type ContactChange,
  type Contacts,
  contactName,
  type EventKind,
  hasStarted,
  isActive,
  redUnits,
  type TaskEvent,
  TaskRuleError,
  type TaskState,
} from "./state";

export interface Advanced {
  readonly state: TaskState;
  readonly events: readonly TaskEvent[];
}

/**
 * The state after one input, and the events that the input caused.
 *
 * Throws TaskRuleError for a command that is not valid in the state, an unknown surface, a contact
 * that both begins and ends in one change, and a time that goes back; the old state stays valid.
 */
export function advance(state: TaskState, step: ContactChange | Command): Advanced {
  if (!(Number.isFinite(step.timeS) && step.timeS >= state.lastS)) {
    throw new TaskRuleError(
      `Time went from ${state.lastS} s to ${step.timeS} s. ` +
        "Give finite times of one monotonic clock, in order.",
    );
  }
  const before = { ...state, lastS: step.timeS };
  const { state: after, events } =
    "command" in step ? COMMANDS[step.command](before, step.timeS) : changeContacts(before, step);
  return { state: after, events: [...events, ...sideEvents(state, after)] };
}

/** An event at the state's latest time, on both clocks. */
function eventOf(state: TaskState, kind: EventKind, contact?: Contact): TaskEvent {
  const activeS = hasStarted(state) ? state.clock.activeS(state.lastS) : 0;
  const { surface = null, part = null } = contact ?? {};
  return { kind, timeS: state.lastS, activeS, task: state.completed + 1, surface, part };
}

/** Sides that turned white, then those that turned red, in layout order. */
function sideEvents(before: TaskState, after: TaskState): readonly TaskEvent[] {
  const was = redUnits(before);
  const now = redUnits(after);
  if (was.size === 0 && now.size === 0) return [];
  const units = [...new Set(after.rules.layout.surfaces.map(({ unit }) => unit))];
  const white = units
    .filter((unit) => was.has(unit) && !now.has(unit))
    .map((unit) => ({ ...eventOf(after, "side_white"), surface: unit }));
  const red = units
    .filter((unit) => now.has(unit) && !was.has(unit))
    .map((unit) => eventOf(after, "side_red", { surface: unit, part: now.get(unit) as string }));
  return [...white, ...red];
}

const COMMANDS: Readonly<Record<CommandKind, (state: TaskState, timeS: number) => Advanced>> = {
  start(state, timeS) {
    if (hasStarted(state)) {
      throw new TaskRuleError("The phase has started already. Valid now: pause, resume or freeze.");
    }
    const after = { ...state, clock: state.clock.begin(timeS), goalSinceS: timeS };
    return { state: after, events: [eventOf(after, "started")] };
  },

  pause(state, timeS) {
    checkRunning(state, "pause");
    if (state.isPaused) {
      throw new TaskRuleError("The phase is paused already. Valid now: resume or freeze.");
    }
    const after = { ...stopClock(state, timeS), isPaused: true };
    return { state: after, events: [eventOf(after, "paused")] };
  },

  resume(state, timeS) {
    checkRunning(state, "resume");
    if (!state.isPaused) {
      throw new TaskRuleError("The phase is not paused. Valid now: pause or freeze.");
    }
    const after = { ...state, isPaused: false };
    const resumed = eventOf(after, "resumed");
    if (after.walkBackSinceS === null) {
      return { state: { ...after, clock: after.clock.resume(timeS) }, events: [resumed] };
    }
    const { state: arrived, events } = arrive(after, timeS);
    return { state: arrived, events: [resumed, ...events] };
  },

  freeze(state, timeS) {
    checkRunning(state, "freeze");
    const after = {
      ...stopClock(state, timeS),
      isFrozen: true,
      isPaused: false,
      walkBackSinceS: null,
    };
    return { state: after, events: [eventOf(after, "frozen")] };
  },
};

function checkRunning(state: TaskState, command: CommandKind): void {
  if (!hasStarted(state)) {
    throw new TaskRuleError(`Cannot ${command}: the phase has not started. Valid now: start.`);
  }
  if (state.isFrozen) {
    throw new TaskRuleError(`Cannot ${command}: the phase has ended. Begin a new phase.`);
  }
}

const stopClock = (state: TaskState, timeS: number): TaskState =>
  isActive(state) ? { ...state, clock: state.clock.pause(timeS) } : state;

function changeContacts(state: TaskState, change: ContactChange): Advanced {
  checkChange(state, change);
  const begins = change.begins.filter((contact) => !state.contacts.has(contactName(contact)));
  const contacts = new Map(state.contacts);
  for (const contact of change.ends) contacts.delete(contactName(contact));
  for (const contact of begins) contacts.set(contactName(contact), contact);
  const arrived = new Map([...state.arrived].filter(([name]) => contacts.has(name)));
  const after = { ...state, contacts, arrived };
  if (state.walkBackSinceS !== null) return stepOnStart(after, begins, change.timeS);
  // At the very instant the clock starts or resumes, a contact counts as existing, not as new. So
  // the record can be verified from its intervals, which begin at that instant too.
  const { runningSinceS } = state.clock;
  if (runningSinceS === null || change.timeS <= runningSinceS) return { state: after, events: [] };
  return judge(after, state.contacts, begins, change.timeS);
}

function checkChange(state: TaskState, { begins, ends, timeS }: ContactChange): void {
  const { byKey } = state.rules.layout;
  for (const { surface } of [...begins, ...ends]) {
    if (byKey.has(surface)) continue;
    throw new TaskRuleError(
      `There is no surface "${surface}". Use one of: ${[...byKey.keys()].join(", ")}.`,
    );
  }
  const ending = new Set(ends.map(contactName));
  const both = begins.find((contact) => ending.has(contactName(contact)));
  if (both !== undefined) {
    throw new TaskRuleError(
      `${both.part} on ${both.surface} both begins and ends at ${timeS} s. Give two changes instead.`,
    );
  }
}

/** Record which counting feet step on the start square during a walk back. */
function stepOnStart(state: TaskState, begins: readonly Contact[], timeS: number): Advanced {
  const { layout, countingParts } = state.rules;
  const sinceS = state.walkBackSinceS;
  const steps = begins.filter(
    ({ surface, part }) =>
      surface === layout.startKey && countingParts.has(part) && sinceS !== null && timeS > sinceS,
  );
  const arrived = new Map(state.arrived);
  for (const step of steps) arrived.set(contactName(step), step);
  const after = { ...state, arrived };
  return after.isPaused ? { state: after, events: [] } : arrive(after, timeS);
}

/** End the walk back if a counting foot has arrived. */
function arrive(state: TaskState, timeS: number): Advanced {
  const first = [...state.arrived.keys()].sort()[0];
  if (first === undefined) return { state, events: [] };
  const after = {
    ...state,
    clock: state.clock.resume(timeS),
    walkBackSinceS: null,
    arrived: new Map<string, Contact>(),
  };
  return { state: after, events: [eventOf(after, "walk_back_ended", state.arrived.get(first))] };
}

/** Judge the contacts that begin now, in layout order, by the goal just before each. */
function judge(
  state: TaskState,
  contactsBefore: Contacts,
  begins: readonly Contact[],
  timeS: number,
): Advanced {
  const { layout, countingParts } = state.rules;
  const events: TaskEvent[] = [];
  let after = state;
  for (const { key, kind } of layout.surfaces) {
    if (kind !== "panel" && kind !== "target") continue;
    const parts = begins.filter(({ surface }) => surface === key).map(({ part }) => part);
    if (parts.length === 0) continue;
    const limbs = new Set(
      [...contactsBefore.values()]
        .filter(({ surface, part }) => surface === key && countingParts.has(part))
        .map(({ part }) => limbOf(part)),
    );
    for (const part of parts.sort()) {
      const contact = { surface: key, part };
      if (!countingParts.has(part)) {
        events.push(eventOf(after, "wrong_part", contact));
      } else if (!limbs.has(limbOf(part))) {
        limbs.add(limbOf(part));
        const judged = judgeTouch(after, contact, timeS);
        after = judged.state;
        events.push(...judged.events);
      }
    }
  }
  return { state: after, events };
}

const limbOf = (part: string): string => (part.startsWith("Left") ? "left" : "right");

/** Judge a new touch of a panel or the target by a limb that counts. */
function judgeTouch(state: TaskState, contact: Contact, timeS: number): Advanced {
  const { layout } = state.rules;
  const panels = state.order.map((box) => layout.panelKey(box));
  const goal = panels[state.greenCount] ?? layout.targetKey;
  if (contact.surface !== goal || timeS <= state.goalSinceS) {
    if (panels.slice(0, state.greenCount).includes(contact.surface)) return { state, events: [] };
    const kind = contact.surface === layout.targetKey ? "target_early" : "out_of_order";
    return { state, events: [eventOf(state, kind, contact)] };
  }
  if (goal === layout.targetKey) return complete(state, contact, timeS);
  return {
    state: { ...state, greenCount: state.greenCount + 1, goalSinceS: timeS },
    events: [eventOf(state, "panel_green", contact)],
  };
}

/** Complete the task: grey panels, the order reversed if configured, the walk back of a foot task. */
function complete(state: TaskState, contact: Contact, timeS: number): Advanced {
  const { layout } = state.rules;
  const events = [eventOf(state, "task_completed", contact)];
  let after: TaskState = {
    ...state,
    greenCount: 0,
    completed: state.completed + 1,
    goalSinceS: timeS,
  };
  if (layout.reverseAfterTask) {
    after = { ...after, order: after.order.toReversed() };
    events.push(eventOf(after, "order_reversed"));
  }
  if (layout.startKey !== null) {
    after = { ...stopClock(after, timeS), walkBackSinceS: timeS };
    events.push(eventOf(after, "walk_back_begun"));
  }
  return { state: after, events };
}
