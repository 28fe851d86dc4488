"""Slow guessing down: a sliding window per caller, in memory, forgotten at a restart."""

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from app.errors import TooManyAttempts


@dataclass
class RateLimiter:
    """At most `limit` attempts per `window_s` for each key."""

    limit: int
    window_s: float
    monotonic_ns: Callable[[], int]
    _attempts: dict[str, deque[float]] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def attempt(self, key: str) -> None:
        """Count an attempt; raises TooManyAttempts when the window is full."""
        now_s = self.monotonic_ns() / 1e9
        with self._lock:
            self._forget(now_s)
            recent = self._attempts.setdefault(key, deque())
            if len(recent) >= self.limit:
                wait_s = self.window_s - (now_s - recent[0])
                raise TooManyAttempts(
                    "too many attempts",
                    value=len(recent),
                    valid=f"{self.limit} per {self.window_s:.0f} s",
                    remedy=f"Wait {max(1, round(wait_s))} s and try again.",
                )
            recent.append(now_s)

    def succeed(self, key: str) -> None:
        """Forget the attempts of a caller who got it right."""
        with self._lock:
            self._attempts.pop(key, None)

    def _forget(self, now_s: float) -> None:
        for key, recent in list(self._attempts.items()):
            while recent and now_s - recent[0] >= self.window_s:
                recent.popleft()
            if not recent:
                del self._attempts[key]
