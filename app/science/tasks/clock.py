"""The active clock of a phase: it stands still while the phase is paused.

The clock is told when it runs; it never reads a clock itself. All times are seconds of one
monotonic clock (the headset's), so wall time and active time differ only by the pauses.
"""

import math
from dataclasses import dataclass


class ClockError(ValueError):
    """The clock was asked for something impossible, such as going back in time."""


@dataclass(frozen=True)
class ActiveClock:
    """A frozen clock; every method returns a new value.

    `active_before_s`: active time up to the last start of the clock. `running_since_s`: when it
    last began or resumed, None while it stands. `last_s`: its latest change.
    """

    active_before_s: float = 0.0
    running_since_s: float | None = None
    last_s: float | None = None

    def begin(self, time_s: float) -> "ActiveClock":
        """Start from zero active time. Raises ClockError when it has begun before."""
        if self.last_s is not None:
            raise ClockError(f"The clock has begun already. Resume it instead (at {time_s} s).")
        self._check(time_s)
        return ActiveClock(0.0, time_s, time_s)

    def pause(self, time_s: float) -> "ActiveClock":
        """Stand still from `time_s` on. Raises ClockError when not running or back in time."""
        if self.running_since_s is None:
            raise ClockError(f"The clock stands already. Resume it before pausing (at {time_s} s).")
        return ActiveClock(self.active_s(time_s), None, time_s)

    def resume(self, time_s: float) -> "ActiveClock":
        """Run again from `time_s` on. Raises ClockError when running, not begun or back in time."""
        if self.last_s is None:
            raise ClockError(f"The clock has not begun. Begin it before resuming (at {time_s} s).")
        if self.running_since_s is not None:
            raise ClockError(f"The clock runs already. Pause it before resuming (at {time_s} s).")
        self._check(time_s)
        return ActiveClock(self.active_before_s, time_s, time_s)

    def active_s(self, time_s: float) -> float:
        """Active time at `time_s`, which is now or later. Raises ClockError back in time."""
        self._check(time_s)
        if self.running_since_s is None:
            return self.active_before_s
        return self.active_before_s + (time_s - self.running_since_s)

    def reaches_s(self, active_s: float) -> float | None:
        """When the active time will be `active_s` if nothing pauses it; None while it stands."""
        if self.running_since_s is None:
            return None
        return self.running_since_s + (active_s - self.active_before_s)

    def _check(self, time_s: float) -> None:
        if not math.isfinite(time_s):
            raise ClockError(f"The time is {time_s}. Give finite seconds of the monotonic clock.")
        if self.last_s is not None and time_s < self.last_s:
            raise ClockError(
                f"Time went back from {self.last_s} s to {time_s} s. "
                "Give times of one monotonic clock, in order."
            )
