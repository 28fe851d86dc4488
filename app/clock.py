"""Clocks as arguments: wall-clock time for the record, monotonic time for durations."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime


def _utc_now() -> datetime:
    return datetime.now(UTC)


@dataclass(frozen=True)
class Clock:
    """The source of time.

    Durations never use `utc_now`, because the wall clock can be set at any moment.
    """

    utc_now: Callable[[], datetime] = _utc_now
    monotonic_ns: Callable[[], int] = time.monotonic_ns
