"""Moving SQLite's write-ahead log into the database file, away from the commits.

SQLite does this by itself, inside whichever commit makes the log long: that commit, and all the
acknowledgements behind it, then wait for two more flushes. So the server's connections leave it to
this class. It copies beside the writers (PASSIVE waits for nobody, and nobody waits for it), and
only when the log has become long it takes the writing turn for the little that came meanwhile: the
next commit then begins the log anew.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass

from app.database import Database

EVERY_S = 2.0
LONG_LOG_PAGES = 8192
"""32 MiB of 4 KiB pages."""


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
        if self._copy() >= LONG_LOG_PAGES:
            with self.database.write_turn():
                self._copy()
        self._next_s = self.monotonic_s() + EVERY_S

    def _copy(self) -> int:
        """Copy without waiting for anybody; how many pages the log holds."""
        connection = self.database.engine.raw_connection()
        try:
            cursor = connection.cursor()
            # Not through the engine's own execution: it would open a transaction first.
            cursor.execute("PRAGMA wal_checkpoint(PASSIVE)")
            _, pages, _ = cursor.fetchone() or (0, 0, 0)
            return int(pages)
        finally:
            connection.close()
