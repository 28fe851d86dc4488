"""What is kept of movement beside the headset's own stream: of trackers, a companion, a road.

It waits in memory for about a second, and until it is on disk if the disk refuses.
"""

import threading
from collections import deque
from collections.abc import Iterable
from typing import Generic, Literal, TypeVar

from sqlalchemy.orm import Session

from app.features.record.headset.service import is_recording
from app.features.record.sessions import plan_of, state_of
from app.models import StudySession

Item = TypeVar("Item")
Recording = Literal["yes", "no", "refused"]


class Waiting(Generic[Item]):
    """What is not on disk yet, at most `most` items; safe from any thread."""

    def __init__(self, most: int) -> None:
        self.lost = 0
        """Items that were discarded because too many waited: the disk was full for minutes."""
        self.stored = 0
        self._most = most
        self._items: deque[Item] = deque()
        self._lock = threading.Lock()

    def add(self, items: Iterable[Item]) -> None:
        """Add items in the order in which they came."""
        with self._lock:
            self._items.extend(items)
            while len(self._items) > self._most:
                self._items.popleft()
                self.lost += 1

    def take(self) -> list[Item]:
        """Return all waiting items, which no longer wait."""
        with self._lock:
            taken, self._items = list(self._items), deque()
        return taken

    def give_back(self, items: list[Item]) -> None:
        """Let items wait again that could not be stored."""
        with self._lock:
            self._items.extendleft(reversed(items))


def recording_of(db: Session, session: StudySession) -> Recording:
    """Return whether movement of a session is recorded now, and whether that was refused.

    It is refused by who does not take part, who withdrew, and whose data were erased.
    """
    state = state_of(session)
    if state.refused_consent is not None or state.erased or session.status == "withdrawn":
        return "refused"
    step = None if state.current is None else plan_of(db, session)[state.current]
    return "yes" if is_recording(state, step) else "no"


def is_kept(recording: Recording, *, was_recording: bool) -> bool:
    """Return whether what waits since the last look is kept: movement was recorded until now."""
    return recording == "yes" or (recording == "no" and was_recording)
