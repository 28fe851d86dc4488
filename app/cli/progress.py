"""Show the progress of a long command on standard error, starting within a second.

On a terminal it is one line that is overwritten. Elsewhere (a log, a pipe, a service) it is an
occasional line, and none for a command that finishes within a second. A separate thread writes
them, so that they also appear while one step takes minutes and reports nothing.
"""

import sys
import threading
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from app.cli.errors import ERASE_LINE

FIRST_UPDATE_S = 0.7
LOG_EVERY_S, DRAWN_EVERY_S = 5.0, 0.2
"""Shortest time between updates: in a log, and on a terminal."""


class Activity:
    """A progress display that shows what a command is doing, for the duration of the block.

    with Activity("backing up: opening the database") as activity:
        activity.now("backing up: copying")
    """

    def __init__(self, what: str) -> None:
        self._what, self._shown = what, ""
        self._ended, self._output_lock = threading.Event(), threading.Lock()
        self._thread = threading.Thread(target=self._show, daemon=True)
        self._live = sys.stderr.isatty()

    def now(self, what: str) -> None:
        """Set the description of the current step."""
        self._what = what

    def rows(self, what: str) -> Callable[[str, int], None]:
        """Return a callback that counts a table's completed rows and shows the total."""
        done: Counter[str] = Counter()

        def count(table: str, rows: int) -> None:
            done[table] += rows
            self.now(f"{what}: {table}, {done[table]} rows")

        return count

    @contextmanager
    def silent(self) -> Iterator[None]:
        """Show no progress while the user answers a question."""
        with self._output_lock:
            self._erase()
            yield

    def __enter__(self) -> "Activity":
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._ended.set()
        self._thread.join()
        self._erase()

    def _erase(self) -> None:
        if self._live and self._shown:
            sys.stderr.write(ERASE_LINE)
            sys.stderr.flush()

    def _show(self) -> None:
        wait_s = FIRST_UPDATE_S
        while not self._ended.wait(wait_s):
            wait_s = DRAWN_EVERY_S if self._live else LOG_EVERY_S
            with self._output_lock:
                if self._what == self._shown or self._ended.is_set():
                    continue
                self._shown = self._what
                if self._live:
                    sys.stderr.write(f"{ERASE_LINE}{self._shown}")
                else:
                    sys.stderr.write(f"reembody: {self._shown}\n")
                sys.stderr.flush()
