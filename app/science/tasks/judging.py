"""Judge whether a touch advances the task or is a mistake; `rules` states the rules."""

from collections.abc import Iterable
from dataclasses import replace

from app.science.tasks.names import SurfaceKind
from app.science.tasks.state import Contact, EventKind, TaskEvent, TaskState

Events = tuple[TaskEvent, ...]


def event(
    state: TaskState, kind: EventKind, surface: str | None = None, part: str | None = None
) -> TaskEvent:
    """Return an event at the state's latest time, on both clocks."""
    active_s = state.clock.active_s(state.last_s) if state.started else 0.0
    return TaskEvent(kind, state.last_s, active_s, state.completed + 1, surface, part)


def stop_clock(state: TaskState, time_s: float) -> TaskState:
    """Return the state with its clock stopped at `time_s`."""
    return replace(state, clock=state.clock.pause(time_s)) if state.active else state


def judge(
    state: TaskState, contacts_before: frozenset[Contact], begins: Iterable[Contact], time_s: float
) -> tuple[TaskState, Events]:
    """Judge the contacts that begin now, in layout order; return the new state and the events."""
    events: list[TaskEvent] = []
    by_surface: dict[str, list[str]] = {}
    for contact in sorted(begins):
        by_surface.setdefault(contact.surface, []).append(contact.part)
    for surface in state.rules.layout.surfaces:
        if surface.kind not in (SurfaceKind.PANEL, SurfaceKind.TARGET):
            continue
        limbs = {
            _limb(contact.part)
            for contact in contacts_before
            if contact.surface == surface.key and _counts(state, contact)
        }
        for part in by_surface.get(surface.key, ()):
            contact = Contact(surface.key, part)
            if not _counts(state, contact):
                events.append(event(state, EventKind.WRONG_PART, *contact))
            elif _limb(part) not in limbs:
                limbs.add(_limb(part))
                state, found = _judge_touch(state, contact, time_s)
                events += found
    return state, tuple(events)


def _counts(state: TaskState, contact: Contact) -> bool:
    return contact.part in state.rules.counting_parts


def _limb(part: str) -> str:
    return "left" if part.startswith("Left") else "right"


def _judge_touch(state: TaskState, contact: Contact, time_s: float) -> tuple[TaskState, Events]:
    """Judge a new touch of a panel or the target by a limb that counts."""
    layout = state.rules.layout
    panels = [layout.panel_key(box) for box in state.order]
    goal = panels[state.n_green] if state.n_green < len(panels) else layout.target_key
    if contact.surface != goal or time_s <= state.goal_since_s:
        if contact.surface in panels[: state.n_green]:
            return state, ()
        early = contact.surface == layout.target_key
        kind = EventKind.TARGET_EARLY if early else EventKind.OUT_OF_ORDER
        return state, (event(state, kind, *contact),)
    if goal != layout.target_key:
        green = replace(state, n_green=state.n_green + 1, goal_since_s=time_s)
        return green, (event(state, EventKind.PANEL_GREEN, *contact),)
    return _complete(state, contact, time_s)


def _complete(state: TaskState, contact: Contact, time_s: float) -> tuple[TaskState, Events]:
    """Complete the task after the target was touched as the goal.

    Reset the panels, reverse the order if configured, and begin the walk back if there is a start
    square.
    """
    layout = state.rules.layout
    events = [event(state, EventKind.TASK_COMPLETED, *contact)]
    after = replace(state, n_green=0, completed=state.completed + 1, goal_since_s=time_s)
    if layout.reverse_after_task:
        after = replace(after, order=after.order[::-1])
        events.append(event(after, EventKind.ORDER_REVERSED))
    if layout.start_key is not None:
        after = replace(stop_clock(after, time_s), walk_back_since_s=time_s)
        events.append(event(after, EventKind.WALK_BACK_BEGUN))
    return after, tuple(events)
