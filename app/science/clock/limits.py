"""What is taken for granted about the clocks."""

from dataclasses import dataclass


class ClockError(ValueError):
    """The readings or the limits cannot be used; the message says why."""


@dataclass(frozen=True)
class ClockLimits:
    """The model: over a window the offset is a line, but for a small wander.

    Attributes:
        drift: largest rate of one clock against the other, s/s. Crystals stay within 100 ppm;
            500 ppm is what NTP allows itself when it slews (RFC 5905, appendix A.1).
        slack_s: how far a clock may stray from its line within a window. A crystal that warms up
            by 5 ppm in a quarter of an hour strays 30 us in 5 minutes. Every bound is widened by
            it and every uncertainty holds it.
        window_s: longest time that one line has to serve, s.
        step_s: a jump below this is not looked for in the server's wall clock, s. That clock is
            read when a probe is stored, tens of milliseconds late.
    """

    drift: float = 500e-6
    slack_s: float = 100e-6
    window_s: float = 300.0
    step_s: float = 0.2

    def __post_init__(self) -> None:
        for name in ("drift", "slack_s", "window_s", "step_s"):
            value = getattr(self, name)
            if not 0.0 < value < float("inf"):
                raise ClockError(f"{name} is {value!r}: it must be a positive, finite number.")
