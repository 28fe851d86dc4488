"""Limit how often clients may try: attempts in a sliding window, and budgets that refill.

Everything is kept in memory, is forgotten at a restart, and has a fixed size: beyond it, the name
or address that has been inactive longest is evicted. Guesses stay bounded even then, because only a
few passwords are checked at a time, whoever sends them (`app.features.people.accounts`).
"""

import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field
from ipaddress import IPv6Address, ip_address, ip_network

from app.errors import TooManyAttempts

MOST_KEYS = 20_000
IPV6_PREFIX = 64
"""A household or lab has at least a /64 of IPv6 addresses, so these are counted together."""


def network_of(address: str | None) -> str:
    """Return the key for counting a client: its address, or the /64 network of an IPv6 address."""
    try:
        parsed = ip_address((address or "").partition("%")[0])
    except ValueError:
        return address or ""
    if not isinstance(parsed, IPv6Address):
        return str(parsed)
    if parsed.ipv4_mapped is not None:
        return str(parsed.ipv4_mapped)
    return str(ip_network((parsed, IPV6_PREFIX), strict=False))


@dataclass
class RateLimiter:
    """Limits each key to `limit` attempts per `window_s`."""

    limit: int
    window_s: float
    monotonic_ns: Callable[[], int]
    most_keys: int = MOST_KEYS
    # The most recently tried key is last. Lists, because a deque takes 600 bytes for one element.
    _attempts: OrderedDict[str, list[float]] = field(default_factory=OrderedDict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def __len__(self) -> int:
        return len(self._attempts)

    def attempt(self, key: str) -> None:
        """Count an attempt; raise TooManyAttempts if the window is full."""
        now_s = self.monotonic_ns() / 1e9
        with self._lock:
            recent = self._recent(key, now_s)
            if len(recent) >= self.limit:
                wait_s = max(1.0, self.window_s - (now_s - recent[0]))
                raise TooManyAttempts(
                    "too many attempts",
                    value=len(recent),
                    valid=f"{self.limit} per {self.window_s:.0f} s",
                    remedy=f"Wait {round(wait_s)} s and try again.",
                    retry_after_s=wait_s,
                )
            recent.append(now_s)

    def succeed(self, key: str) -> None:
        """Clear the attempts of a key after a success."""
        with self._lock:
            self._attempts.pop(key, None)

    def take_back(self, key: str) -> None:
        """Remove the newest attempt: it was not a guess, or was never checked."""
        with self._lock:
            recent = self._attempts.get(key)
            if recent:
                recent.pop()

    def _recent(self, key: str, now_s: float) -> list[float]:
        recent = [at for at in self._attempts.get(key, ()) if now_s - at < self.window_s]
        self._attempts[key] = recent
        self._attempts.move_to_end(key)
        while len(self._attempts) > 1:
            oldest = next(iter(self._attempts))
            last_s = max(self._attempts[oldest], default=float("-inf"))
            if len(self._attempts) <= self.most_keys and now_s - last_s < self.window_s:
                break
            del self._attempts[oldest]
        return recent


@dataclass
class Budget:
    """A budget for each key: up to `capacity`, refilled by `per_s` a second."""

    capacity: float
    per_s: float
    monotonic_ns: Callable[[], int]
    most_keys: int = MOST_KEYS
    # The remaining budget and its time (s); a missing key has the full capacity.
    _left: OrderedDict[str, tuple[float, float]] = field(default_factory=OrderedDict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def __len__(self) -> int:
        return len(self._left)

    def spend(self, key: str, cost: float = 1.0) -> None:
        """Take `cost` from a key's budget; raise TooManyAttempts if less than that remains."""
        left = self._take(key, cost)
        if left < 0:
            wait_s = max(1.0, -left / self.per_s)
            raise TooManyAttempts(
                "too many requests from this address without a sign-in or pairing",
                valid=f"{self.capacity:g} at once, then {self.per_s:g} per second",
                remedy=f"Wait {round(wait_s)} s and try again. Paired devices and people who are "
                "signed in are not affected.",
                retry_after_s=wait_s,
            )

    def charge(self, key: str, cost: float) -> None:
        """Take `cost`, or what remains, for a request that was more expensive than expected."""
        self._take(key, cost, all_of_it=True)

    def _take(self, key: str, cost: float, *, all_of_it: bool = False) -> float:
        """Take `cost` and return the remainder; if it is negative, nothing was taken.

        With `all_of_it`, an insufficient budget is emptied instead.
        """
        now_s = self.monotonic_ns() / 1e9
        with self._lock:
            left, at_s = self._left.get(key, (self.capacity, now_s))
            left = min(self.capacity, left + (now_s - at_s) * self.per_s)
            after = left - cost
            remaining = max(0.0, after) if all_of_it or after >= 0 else left
            self._left[key] = (remaining, now_s)
            self._left.move_to_end(key)
            if len(self._left) > self.most_keys:
                self._left.popitem(last=False)
        return after


@dataclass(frozen=True)
class Limits:
    """The limits for one name or address, including the lab's own.

    `names`: sign-ins for one name from one address. `sign_ins`: failed ones from one address,
    whatever the names. `codes`: pairing codes and invitations from one address. `strangers`: every
    request without a valid login or pairing, pages included. A request with a valid login or
    pairing is never counted.
    """

    names: RateLimiter
    sign_ins: RateLimiter
    codes: RateLimiter
    strangers: Budget


def usual_limits(monotonic_ns: Callable[[], int]) -> Limits:
    """Return the default limits.

    They are far above what a lab behind one address needs, and far below what slows a session down.
    A tablet's first page takes about 15 requests, the console's 40.
    """
    return Limits(
        names=RateLimiter(10, 60.0, monotonic_ns),
        sign_ins=RateLimiter(30, 60.0, monotonic_ns),
        codes=RateLimiter(20, 60.0, monotonic_ns),
        strangers=Budget(400.0, 20.0, monotonic_ns),
    )
