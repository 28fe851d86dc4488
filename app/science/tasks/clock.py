"""The active clock of a phase, which is stopped while the phase is paused.

The clock is given every time as an argument and never reads a system clock. All times are seconds
of one monotonic clock (the headset's), so wall time and active time differ only by the pauses.
"""

import math
from dataclasses import dataclass


class ClockError(ValueError):
    """A call to the clock that is not valid in its state, such as a time that goes back."""


@dataclass(frozen=True)
class ActiveClock:
    """An immutable clock that counts active time; every method returns a new value.

    `active_before_s`: active time up to the last start of the clock. `running_since_s`: the time at
    which it was last started or resumed, None while it is stopped. `last_s`: the time of its latest
    change.
    """

    active_before_s: float = 0.0
    running_since_s: float | None = None
    last_s: float | None = None

    def begin(self, time_s: float) -> "ActiveClock":
        """Start from zero active time. Raises ClockError if it was started before."""
        if self.last_s is not None:
            raise ClockError(f"The clock was started before. Resume it instead (at {time_s} s).")
        self._check(time_s)
        return ActiveClock(0.0, time_s, time_s)

    def pause(self, time_s: float) -> "ActiveClock":
        """Stop at `time_s`. Raises ClockError if the clock is not running or the time goes back."""
        if self.running_since_s is None:
            raise ClockError(f"The clock is stopped. Resume it before pausing (at {time_s} s).")
        return ActiveClock(self.active_s(time_s), None, time_s)

    def resume(self, time_s: float) -> "ActiveClock":
        """Run again from `time_s` on.

        Raises ClockError if the clock is running or was never started, or if the time goes back.
        """
        if self.last_s is None:
            raise ClockError(
                f"The clock has not started. Begin it before resuming (at {time_s} s)."
            )
        if self.running_since_s is not None:
            raise ClockError(f"The clock is running. Pause it before resuming (at {time_s} s).")
        self._check(time_s)
        return ActiveClock(self.active_before_s, time_s, time_s)

    def active_s(self, time_s: float) -> float:
        """Return the active time at `time_s`, which must not be earlier than the latest change.

        Raises ClockError if it is.
        """
        self._check(time_s)
        if self.running_since_s is None:
            return self.active_before_s
        return self.active_before_s + (time_s - self.running_since_s)

    def reaches_s(self, active_s: float) -> float | None:
        """Return when the active time will reach `active_s` if not paused; None while stopped."""
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
