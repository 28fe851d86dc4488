"""Moving SQLite's write-ahead log into the database file, away from the commits.

SQLite does this by itself, inside whichever commit makes the log long: that commit, and all the
acknowledgements behind it, then wait for two more flushes. So the server's connections leave it to
this class. It copies beside the writers (PASSIVE waits for nobody, and nobody waits for it), then
takes the writing turn for the little that came meanwhile: the next commit begins the log anew.

A copy never starts on a log that is copied already: SQLite before 3.51.3 may damage the database if
a commit begins the log anew at that very moment. So it is asked first, within the writing turn,
whether anything was committed since the last complete copy; then the log holds something to copy
until this class has copied it.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass

from app.database import Database

EVERY_S = 2.0


@dataclass
class Checkpointer:
    """Call `turn` from one thread, now and then."""

    database: Database
    monotonic_s: Callable[[], float] = time.monotonic
    _next_s: float = 0.0

    def turn(self) -> None:
        """Copy what has been written, if it is time to."""
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
        """Copy without waiting for anybody; whether nothing is left to copy."""
        connection = self.database.engine.raw_connection()
        try:
            cursor = connection.cursor()
            # Not through the engine's own execution: it would open a transaction first.
            cursor.execute("PRAGMA wal_checkpoint(PASSIVE)")
            busy, pages, copied = cursor.fetchone() or (0, 0, 0)
            return not busy and pages == copied
        finally:
            connection.close()
