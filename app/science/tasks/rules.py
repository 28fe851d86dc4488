"""The rules of the box task as a pure state machine: state + input -> state + events.

**Order.** Panels are touched one after the other; the first order starts at the writing hand's
side (or as configured). The target completes the task once every panel is green, and all panels
turn grey again. Where configured (hands), order and displayed numbers are then reversed, each time.

**Which parts count.** Hand tasks: the writing hand and its fingers. Foot tasks: foot and toes, of
either foot unless one is configured. Other parts on a panel or the target are logged as
`wrong_part`.

**What a touch is.** A limb's touch of a panel or the target begins when its first counting part
begins to touch and lasts until its last one lets go: a finger joining the hand is no second touch.

**Only a new touch counts.** A touch is judged once, at the instant it begins, by the goal just
before that instant. So a hand resting on a panel that later becomes current must leave it and come
back, and one instant never advances two goals. It is `out_of_order` on a panel that is neither
current nor green, and `target_early` on the target before it is the goal; touching a green panel
again has no effect.

**Pauses.** While paused, walking back or frozen, contacts are remembered but do not count. What is
already touched when the clock starts or resumes (also at that very instant) is no new touch, but
it does make a side red again.

**Walk back.** Completing a foot task stops the clock until a counting foot steps on the start
square. A foot that was there already must step again; if one stepped there during an operator's
pause and still stands there, the walk back ends when the phase resumes.

**Sides.** A side is red while any body part touches it, and white otherwise; the rim bars of a box
are one side. Sides are red in active time only.

Sources: Karas 2020, sections 7.1.3 and 7.2 and appendix A.1; what it leaves open is decided here.
"""

import math
from dataclasses import replace

from app.science.tasks.judging import Events, event, judge, stop_clock
from app.science.tasks.state import (
    Command,
    CommandKind,
    Contact,
    ContactChange,
    EventKind,
    TaskRuleError,
    TaskState,
)


def advance(state: TaskState, step: ContactChange | Command) -> tuple[TaskState, Events]:
    """Return the state after one input, and the events that the input caused.

    Raises TaskRuleError for a command that is not valid in the state, an unknown surface, a contact
    that both begins and ends in one change, and a time that goes back; the old state stays valid.
    """
    if not (math.isfinite(step.time_s) and step.time_s >= state.last_s):
        raise TaskRuleError(
            f"Time went from {state.last_s} s to {step.time_s} s. "
            "Give finite times of one monotonic clock, in order."
        )
    before = replace(state, last_s=step.time_s)
    if isinstance(step, Command):
        after, events = _HANDLERS[step.kind](before, step.time_s)
    else:
        after, events = _change_contacts(before, step)
    return after, events + _side_events(state, after)


def _side_events(before: TaskState, after: TaskState) -> Events:
    """Return events for sides that turned white, then for those turned red, in layout order."""
    was, now = before.red_units(), after.red_units()
    if was.keys() == now.keys():
        return ()
    units = dict.fromkeys(surface.unit for surface in after.rules.layout.surfaces)
    white = [event(after, EventKind.SIDE_WHITE, u) for u in units if u in was and u not in now]
    red = [event(after, EventKind.SIDE_RED, u, now[u]) for u in units if u in now and u not in was]
    return (*white, *red)


def _start(state: TaskState, time_s: float) -> tuple[TaskState, Events]:
    if state.started:
        raise TaskRuleError("The phase has started already. Valid now: pause, resume or freeze.")
    after = replace(state, clock=state.clock.begin(time_s), goal_since_s=time_s)
    return after, (event(after, EventKind.STARTED),)


def _pause(state: TaskState, time_s: float) -> tuple[TaskState, Events]:
    _check_running(state, "pause")
    if state.paused:
        raise TaskRuleError("The phase is paused already. Valid now: resume or freeze.")
    after = replace(stop_clock(state, time_s), paused=True)
    return after, (event(after, EventKind.PAUSED),)


def _resume(state: TaskState, time_s: float) -> tuple[TaskState, Events]:
    _check_running(state, "resume")
    if not state.paused:
        raise TaskRuleError("The phase is not paused. Valid now: pause or freeze.")
    after = replace(state, paused=False)
    events = (event(after, EventKind.RESUMED),)
    if after.walk_back_since_s is None:
        return replace(after, clock=after.clock.resume(time_s)), events
    after, arrived = _arrive(after, time_s)
    return after, events + arrived


def _freeze(state: TaskState, time_s: float) -> tuple[TaskState, Events]:
    _check_running(state, "freeze")
    after = replace(stop_clock(state, time_s), frozen=True, paused=False, walk_back_since_s=None)
    return after, (event(after, EventKind.FROZEN),)


_HANDLERS = {
    CommandKind.START: _start,
    CommandKind.PAUSE: _pause,
    CommandKind.RESUME: _resume,
    CommandKind.FREEZE: _freeze,
}


def _check_running(state: TaskState, command: str) -> None:
    if not state.started:
        raise TaskRuleError(f"Cannot {command}: the phase has not started. Valid now: start.")
    if state.frozen:
        raise TaskRuleError(f"Cannot {command}: the phase has ended. Begin a new phase.")


def _change_contacts(state: TaskState, change: ContactChange) -> tuple[TaskState, Events]:
    _check_change(state, change)
    begins = [contact for contact in change.begins if contact not in state.contacts]
    contacts = (state.contacts - frozenset(change.ends)) | frozenset(begins)
    after = replace(state, contacts=contacts, arrived=state.arrived & contacts)
    if state.walk_back_since_s is not None:
        return _step_on_start(after, begins, change.time_s)
    # At the very instant the clock starts or resumes, a contact counts as existing, not as new.
    # So the record can be verified from its intervals, which begin at that instant too.
    if state.clock.running_since_s is None or change.time_s <= state.clock.running_since_s:
        return after, ()
    return judge(after, state.contacts, begins, change.time_s)


def _check_change(state: TaskState, change: ContactChange) -> None:
    surfaces = state.rules.layout.by_key
    for contact in (*change.begins, *change.ends):
        if contact.surface not in surfaces:
            raise TaskRuleError(
                f"There is no surface {contact.surface!r}. Use one of: {', '.join(surfaces)}."
            )
    both = set(change.begins) & set(change.ends)
    if both:
        raise TaskRuleError(
            f"{min(both)} both begins and ends at {change.time_s} s. Give two changes instead."
        )


def _step_on_start(
    state: TaskState, begins: list[Contact], time_s: float
) -> tuple[TaskState, Events]:
    """Record which counting feet step on the start square during a walk back."""
    start, counting = state.rules.layout.start_key, state.rules.counting_parts
    since_s = state.walk_back_since_s
    steps = [
        contact
        for contact in begins
        if contact.surface == start and contact.part in counting
        if since_s is not None and time_s > since_s
    ]
    after = replace(state, arrived=state.arrived | frozenset(steps))
    return (after, ()) if after.paused else _arrive(after, time_s)


def _arrive(state: TaskState, time_s: float) -> tuple[TaskState, Events]:
    """End the walk back if a counting foot has arrived."""
    if not state.arrived:
        return state, ()
    contact = min(state.arrived)
    after = replace(
        state, clock=state.clock.resume(time_s), walk_back_since_s=None, arrived=frozenset()
    )
    return after, (event(after, EventKind.WALK_BACK_ENDED, *contact),)
