"""Readings of two clocks, and what each of them proves about the offset.

A probe leaves the client at `client_sent`, reaches the server at `server_received`, is answered at
`server_sent` and is back at `client_received`, each read on its own side's clock. No message
arrives before it was sent. So with theta(t) = server minus client, t on the client's clock,

    server_sent - client_received <= theta(client_received)
    theta(client_sent) <= server_received - client_sent,

whatever the two ways took: the width of the two together is the round trip. This is the
correctness interval of NTP (Mills, RFC 5905, section 11.1; Marzullo 1984), kept as two one-sided
bounds at their own times because the clocks drift in between.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


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


FloatArray = npt.NDArray[np.float64]
_READING_STEPS_S = (0.1, 0.01, 0.001)
_STEP_NEEDS = 8


@dataclass(frozen=True, eq=False)
class ClockProbes:
    """n probes of one client run in the order in which they were made; seconds.

    A probe without an answer has NaN in place of what is missing. `server_utc_s` (optional) is the
    server's wall clock, read when or after the answer was sent; it only tells which clock jumped.

    Raises ClockError if the arrays are not all of shape (n,).
    """

    client_sent_s: FloatArray
    server_received_s: FloatArray
    server_sent_s: FloatArray
    client_received_s: FloatArray
    server_utc_s: FloatArray | None = None

    def __post_init__(self) -> None:
        shapes = {array.shape for array in self.arrays}
        if len(shapes) != 1 or self.client_sent_s.ndim != 1:
            raise ClockError(
                f"Readings of shapes {sorted(shapes)} do not fit: all must be (n,), probe by probe."
            )

    def __len__(self) -> int:
        return len(self.client_sent_s)

    @property
    def arrays(self) -> tuple[FloatArray, ...]:
        """All readings there are, the wall clock last."""
        four = (
            self.client_sent_s,
            self.server_received_s,
            self.server_sent_s,
            self.client_received_s,
        )
        return four if self.server_utc_s is None else (*four, self.server_utc_s)

    def taken(self, chosen: npt.NDArray[np.bool_] | npt.NDArray[np.intp]) -> "ClockProbes":
        """Some of the probes, in their order."""
        return ClockProbes(*(array[chosen] for array in self.arrays))

    @property
    def answered(self) -> npt.NDArray[np.bool_]:
        """(n,) whether all four times are there."""
        complete = np.isfinite(self.client_sent_s)
        for readings in self.arrays[1:4]:
            complete = complete & np.isfinite(readings)
        return complete

    @property
    def round_trip_s(self) -> FloatArray:
        """(n,) time under way: the client's waiting less the server's handling; NaN if lost."""
        return (self.client_received_s - self.client_sent_s) - (
            self.server_sent_s - self.server_received_s
        )

    @property
    def offset_s(self) -> FloatArray:
        """(n,) server minus client if both ways took as long (RFC 5905, eq. for theta)."""
        return 0.5 * (
            (self.server_received_s - self.client_sent_s)
            + (self.server_sent_s - self.client_received_s)
        )

    @property
    def middle_s(self) -> FloatArray:
        """(n,) the client's time half-way through the exchange."""
        return 0.5 * (self.client_sent_s + self.client_received_s)


@dataclass(frozen=True, eq=False)
class Bounds:
    """n bounds from above at `upper_t_s` and n from below at `lower_t_s`, all (n,), slack added."""

    upper_t_s: FloatArray
    upper_s: FloatArray
    lower_t_s: FloatArray
    lower_s: FloatArray

    def between(self, first: int, end: int) -> "Bounds":
        """The bounds of the probes first to end - 1."""
        part = slice(first, end)
        return Bounds(
            self.upper_t_s[part], self.upper_s[part], self.lower_t_s[part], self.lower_s[part]
        )

    def chosen(self, index: npt.NDArray[np.intp]) -> "Bounds":
        """The bounds of these probes."""
        return Bounds(
            self.upper_t_s[index], self.upper_s[index], self.lower_t_s[index], self.lower_s[index]
        )


def bounds_of(probes: ClockProbes, widening_s: float) -> Bounds:
    """The bounds that answered probes set, each moved outwards by `widening_s`."""
    return Bounds(
        upper_t_s=probes.client_sent_s,
        upper_s=probes.server_received_s - probes.client_sent_s + widening_s,
        lower_t_s=probes.client_received_s,
        lower_s=probes.server_sent_s - probes.client_received_s - widening_s,
    )


def is_possible(probes: ClockProbes, widening_s: float) -> npt.NDArray[np.bool_]:
    """(n,) whether each answered probe can be true: time went forward and no way took less than 0.

    With half of what its bounds are widened by to spare, so that some line fits each on its own.
    """
    waited_s = probes.client_received_s - probes.client_sent_s
    handled_s = probes.server_sent_s - probes.server_received_s
    return (waited_s >= 0.0) & (handled_s >= 0.0) & (probes.round_trip_s >= -widening_s)


def reading_step_s(client_s: FloatArray) -> float:
    """The coarse step in which a clock is read, 0 if it is finer than a millisecond.

    Browsers round their clocks, some to a millisecond or more, against timing attacks. A clock all
    of whose readings are whole multiples of such a step is taken at its word.
    """
    if len(client_s) < _STEP_NEEDS:
        return 0.0
    for step_s in _READING_STEPS_S:
        steps = client_s / step_s
        if np.abs(steps - np.round(steps)).max() < 1e-4:
            return step_s
    return 0.0
