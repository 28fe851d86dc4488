"""Detect that the database can be written again, even if no data arrive.

With a headset's movement, that is detected within a second. Otherwise the server would report
forever that nothing can be stored, and the next person to start something would have to try twice.
"""

import threading
from dataclasses import dataclass, field

from sqlalchemy import text
from sqlalchemy.exc import DBAPIError

from app.platform.context import AppContext, Part

CHECK_EVERY_S = 1.0
UNTRIED_NS = 5_000_000_000
"""Write again after this time, the same as a request waits before it tries to."""
THREAD = "storage-recovery"
_CHANGES_NOTHING = text("UPDATE alembic_version SET version_num = version_num")
"""Writes and commits a row without changing its content."""


@dataclass(eq=False)
class StorageRecovery(Part):
    """Keeps the reserve of the disk, and tests writing while nothing can be stored."""

    context: AppContext
    _stop: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None

    def start(self) -> None:
        """Allocate the disk reserve before anything is recorded, and start the thread."""
        self.context.storage.reserve.create()
        self._thread = self.context.background.thread(THREAD, self._run)

    def stop(self) -> None:
        """Stop the thread."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(timeout=10.0)

    def _run(self) -> None:
        while not self._stop.wait(CHECK_EVERY_S):
            if self.context.storage.is_untried(UNTRIED_NS):
                self.try_to_write()
            self.context.background.recovered(THREAD)

    def try_to_write(self) -> None:
        """Write once; the database reports the result to the storage's health."""
        if self.context.storage.must_wait():
            return
        try:
            with self.context.database.writing() as db:
                db.execute(_CHANGES_NOTHING)
        except DBAPIError:
            return
