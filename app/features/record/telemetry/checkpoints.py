"""Checkpoint SQLite's write-ahead log into the database file, separately from the commits.

SQLite does this automatically, inside whichever commit makes the log long: that commit, and all
acknowledgements after it, then wait for two more flushes. So the server's connections leave it to
this class. It copies concurrently with the writers (PASSIVE blocks nobody and waits for nobody),
then takes the write lock for the little that was added meanwhile: the next commit restarts the log.

A copy never starts on a log that is already copied: SQLite before 3.51.3 may damage the database if
a commit restarts the log at that very moment. So it is first checked, under the write lock, whether
anything was committed since the last complete copy; if so, the log contains something to copy until
this class has copied it.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass

from app.database import Database

EVERY_S = 2.0


@dataclass
class Checkpointer:
    """Checkpoints the write-ahead log at intervals; call `turn` repeatedly from a single thread."""

    database: Database
    monotonic_s: Callable[[], float] = time.monotonic
    _next_s: float = 0.0

    def turn(self) -> None:
        """Copy what has been committed to the database file, if a checkpoint is due."""
        if not self.database.is_sqlite or self.monotonic_s() < self._next_s:
            return
        self._next_s = self.monotonic_s() + EVERY_S
        commits = self.database.commits
        with commits.copying:
            with self.database.write_turn():
                nothing_new = commits.number == commits.copied
            if nothing_new:
                return
            self._copy()
            with self.database.write_turn():
                if commits.number != commits.copied and self._copy():
                    commits.copied = commits.number

    def _copy(self) -> bool:
        """Copy without blocking anybody; return whether nothing is left to copy."""
        connection = self.database.engine.raw_connection()
        try:
            cursor = connection.cursor()
            # The engine's own execution would open a transaction first.
            cursor.execute("PRAGMA wal_checkpoint(PASSIVE)")
            busy, pages, copied = cursor.fetchone() or (0, 0, 0)
            return not busy and pages == copied
        finally:
            connection.close()
