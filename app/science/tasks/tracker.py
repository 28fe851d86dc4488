"""Turn the touches of each frame into contact intervals, the unit that is stored.

A part on a surface gives one interval, from when the contact begins to count until it no longer
does. A pause closes every open interval; a contact that still exists when the clock resumes begins
a new one at that instant. So intervals contain active time only, and their lengths are the same on
either clock.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.science.tasks.state import Contact, ContactChange, TaskState

Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class ContactInterval:
    """An interval in which a part counted as touching a surface, in seconds.

    `begin_s`, `end_s`: times on the monotonic clock. `begin_active_s`, `end_active_s`: times on the
    active clock; the length is the same on both. The touch that stops the clock has length zero.
    """

    surface: str
    part: str
    begin_s: float
    end_s: float
    begin_active_s: float
    end_active_s: float


class ContactTracker:
    """Tracks the contacts of a phase. Per frame:

        change = tracker.observe(time_s, touching, near)
        state, events = advance(state, change)
        intervals += tracker.settle(state)

    After a command only `settle` is called. A frame takes effect with its `settle`, so one that the
    rules reject leaves no trace. A change without contacts (false) needs neither call.
    """

    def __init__(self, surfaces: tuple[str, ...], parts: tuple[str, ...]) -> None:
        self._surfaces, self._parts = surfaces, parts
        self._touching: Bools = np.zeros((len(surfaces), len(parts)), dtype=np.bool_)
        self._open: dict[Contact, tuple[float, float]] = {}
        self._next: Bools | None = None
        self._was_active = False

    def observe(self, time_s: float, touching: Bools, near: Bools | None = None) -> ContactChange:
        """Return the contacts that begin and end with this frame.

        `touching`: (S, P), surfaces and parts in the order given at construction. `near`: (S, P),
        where an existing contact continues although the part no longer touches (hysteresis); None
        for no hysteresis. Raises ValueError if the shapes do not fit.
        """
        for name, array in (("touching", touching), ("near", near)):
            if array is not None and array.shape != self._touching.shape:
                raise ValueError(
                    f"Expected {name} of shape {self._touching.shape} (surfaces, parts), "
                    f"got {array.shape}."
                )
        now = touching if near is None else touching | (self._touching & near)
        begins = self._contacts(now & ~self._touching)
        ends = self._contacts(self._touching & ~now)
        self._next = now.copy()
        return ContactChange(time_s, begins, ends)

    def settle(self, state: TaskState) -> tuple[ContactInterval, ...]:
        """Open and close intervals to match the state after an input; return those that closed."""
        if self._next is not None:  # the rules have accepted the change
            self._touching, self._next = self._next, None
        time_s = state.last_s
        counts: frozenset[Contact] = state.contacts if state.active else frozenset()
        # The touch that stopped the clock counted, so its interval is opened before all are closed.
        touched = state.contacts if self._was_active else counts
        for contact in touched - self._open.keys():
            self._open[contact] = time_s, state.clock.active_s(time_s)
        self._was_active = state.active
        closing = sorted(self._open.keys() - counts)
        return tuple(self._close(contact, state) for contact in closing)

    def _close(self, contact: Contact, state: TaskState) -> ContactInterval:
        begin_s, begin_active_s = self._open.pop(contact)
        end_s, end_active_s = state.last_s, state.clock.active_s(state.last_s)
        return ContactInterval(*contact, begin_s, end_s, begin_active_s, end_active_s)

    def _contacts(self, pairs: Bools) -> tuple[Contact, ...]:
        if not pairs.any():
            return ()
        surfaces, parts = np.nonzero(pairs)
        return tuple(
            Contact(self._surfaces[s], self._parts[p]) for s, p in zip(surfaces, parts, strict=True)
        )
