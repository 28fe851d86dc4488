"""Record refused sign-ins in the audit trail, at most one entry per address and time window.

The first refusal from an address is recorded immediately. Subsequent ones within the window are
counted and appended as one entry when the window ends, and so on while they continue. So a flood of
attempts costs one entry a minute, and no existing entry is ever changed. The user names that were
typed are not stored, because they may be passwords; the number of different names is.
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
MAX_ADDRESSES = 256
MAX_NAMES = 1000
OTHER_ADDRESSES = "other addresses"
"""Counts the refusals of further addresses once `MAX_ADDRESSES` have a window of their own."""


@dataclass
class _Window:
    """The refusals of one address since its last entry. `names` are hashes, never stored."""

    until_s: float
    wrong: int = 0
    unchecked: int = 0
    names: set[int] = field(default_factory=set)

    def details(self, address: str) -> dict[str, Any]:
        """Return the details of this window's audit entry."""
        details: dict[str, Any] = {"address": address, "count": self.wrong + self.unchecked}
        if self.unchecked:
            details["unchecked"] = self.unchecked
        if len(self.names) > 1:
            details["names"] = len(self.names)
        return details


@dataclass(eq=False)
class RefusedSignIns(Part):
    """Counts refused sign-ins and writes them to the audit trail; thread-safe."""

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
        """Create the instance of a server from its context."""
        return cls(context.database, context.clock)

    def start(self) -> None:
        """Start the thread that closes windows when they end."""
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="refused-sign-ins", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Stop the thread, and record everything that was counted so far."""
        with self._changed:
            self._ending = True
            self._changed.notify_all()
        if self._thread is not None:
            self._thread.join()
        self.close_windows(float("inf"))

    def note(self, address: str, name: str, *, checked: bool) -> None:
        """Count a refused sign-in; `checked` is False if its password was not even checked."""
        with self._changed:
            window = self._open.get(address)
            if window is None and len(self._open) >= MAX_ADDRESSES:
                address = OTHER_ADDRESSES
                window = self._open.get(address)
            if first := window is None:
                window = _Window(self.monotonic_s() + self.window_s)
                self._open[address] = window
                self._changed.notify_all()
            else:
                window.wrong += checked
                window.unchecked += not checked
                if len(window.names) < MAX_NAMES:
                    window.names.add(hash(name))
        if first:
            self._append([{"address": address}])

    def close_windows(self, now_s: float) -> None:
        """Append an audit entry for every window that ended by `now_s` and contains refusals."""
        entries = []
        with self._changed:
            for address, window in list(self._open.items()):
                if window.until_s > now_s:
                    continue
                if window.wrong + window.unchecked:
                    entries.append(window.details(address))
                    # More may follow: count it in a new window instead of recording it immediately.
                    self._open[address] = _Window(now_s + self.window_s)
                else:
                    del self._open[address]
        if entries:
            self._append(entries)

    def _append(self, entries: list[dict[str, Any]]) -> None:
        with self.database.writing() as db:
            for details in entries:
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
                log.error("refused sign-ins could not be recorded on the audit trail: %s", error)
