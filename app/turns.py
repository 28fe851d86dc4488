"""A lock whose waiters get it in the order in which they came.

Python's own lock goes to whoever asks at the right moment: of a crowd that wants to write, most are
served at once and a few wait for all the others.
"""

import threading
from collections import deque
from types import TracebackType


class Turns:
    """One holder at a time; it may be given back by another thread than the one that took it."""

    def __init__(self) -> None:
        self._mutex = threading.Lock()
        self._taken = False
        self._waiting: deque[threading.Lock] = deque()

    def acquire(self, timeout: float = -1) -> bool:
        """Take it, after at most `timeout` seconds (no limit if negative); False if it did not."""
        with self._mutex:
            if not self._taken:
                self._taken = True
                return True
            mine = threading.Lock()
            mine.acquire()
            self._waiting.append(mine)
        if mine.acquire(timeout=timeout):
            return True
        with self._mutex:
            if mine not in self._waiting:
                # Handed over while the time ran out.
                return True
            self._waiting.remove(mine)
            return False

    def release(self) -> None:
        """Hand it to the one who waits longest."""
        with self._mutex:
            if self._waiting:
                self._waiting.popleft().release()
            else:
                self._taken = False

    def __enter__(self) -> None:
        self.acquire()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.release()
