"""Refused sign-ins on the audit trail: a row for an address and window, however many there were.

The first one from an address is put on record at once. What follows within the window is counted
and appended as one row when the window ends, and so on while it goes on; so a flood costs the trail
a row a minute, and nothing that was written is ever changed. The names that were typed are not
kept, they may be passwords; how many there were is.
"""

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Self

from sqlalchemy.exc import DBAPIError

from app.clock import Clock
from app.database import Database
from app.errors import ReembodyError
from app.features.people.audit import record
from app.platform.context import AppContext, Part

log = logging.getLogger(__name__)
WINDOW_S = 60.0
MOST_ADDRESSES = 256
MOST_NAMES = 1000
ELSEWHERE = "other addresses"
"""Where the refusals of more addresses than are kept apart are counted together."""


@dataclass
class _Window:
    """What an address was refused since its last row. `names` are hashes, forgotten with it."""

    until_s: float
    wrong: int = 0
    unchecked: int = 0
    names: set[int] = field(default_factory=set)

    def details(self, address: str) -> dict[str, Any]:
        """What goes on record."""
        told: dict[str, Any] = {"address": address, "count": self.wrong + self.unchecked}
        if self.unchecked:
            told["unchecked"] = self.unchecked
        if len(self.names) > 1:
            told["names"] = len(self.names)
        return told


@dataclass(eq=False)
class RefusedSignIns(Part):
    """Counts refusals and puts them on record; safe from any thread."""

    database: Database
    clock: Clock
    window_s: float = WINDOW_S
    monotonic_s: Callable[[], float] = time.monotonic
    _open: dict[str, _Window] = field(default_factory=dict)
    _changed: threading.Condition = field(default_factory=threading.Condition)
    _thread: threading.Thread | None = None
    _ending: bool = False

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """The refusals of a server."""
        return cls(context.database, context.clock)

    def start(self) -> None:
        """Begin to close windows when they end."""
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="refused-sign-ins", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Put on record what was counted so far."""
        with self._changed:
            self._ending = True
            self._changed.notify_all()
        if self._thread is not None:
            self._thread.join()
        self.close_windows(float("inf"))

    def note(self, address: str, name: str, *, checked: bool) -> None:
        """One more refusal; not `checked`: there were too many to look at the password."""
        with self._changed:
            window = self._open.get(address)
            if window is None and len(self._open) >= MOST_ADDRESSES:
                address = ELSEWHERE
                window = self._open.get(address)
            if first := window is None:
                window = _Window(self.monotonic_s() + self.window_s)
                self._open[address] = window
                self._changed.notify_all()
            else:
                window.wrong += checked
                window.unchecked += not checked
                if len(window.names) < MOST_NAMES:
                    window.names.add(hash(name))
        if first:
            self._append([{"address": address}])

    def close_windows(self, now_s: float) -> None:
        """Append a row for every window that has ended by `now_s` and held any refusal."""
        told = []
        with self._changed:
            for address, window in list(self._open.items()):
                if window.until_s > now_s:
                    continue
                if window.wrong + window.unchecked:
                    told.append(window.details(address))
                    # It may go on: what follows is counted, not put on record at once.
                    self._open[address] = _Window(now_s + self.window_s)
                else:
                    del self._open[address]
        if told:
            self._append(told)

    def _append(self, told: list[dict[str, Any]]) -> None:
        with self.database.writing() as db:
            for details in told:
                record(
                    db,
                    actor="nobody",
                    action="login.refused",
                    details=details,
                    now=self.clock.utc_now(),
                )

    def _run(self) -> None:
        while True:
            with self._changed:
                ends = [window.until_s for window in self._open.values()]
                if not self._ending and (not ends or min(ends) > self.monotonic_s()):
                    wait_s = None if not ends else max(0.0, min(ends) - self.monotonic_s())
                    self._changed.wait(wait_s)
                if self._ending:
                    return
            try:
                self.close_windows(self.monotonic_s())
            except (DBAPIError, ReembodyError) as error:
                log.error("refused sign-ins could not be put on record: %s", error)
