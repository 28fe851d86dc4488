"""Paired readings of two clocks, and the bounds on their offset that each reading proves.

A probe leaves the client at `client_sent`, reaches the server at `server_received`, is answered at
`server_sent` and arrives back at `client_received`; each side reads its own clock. No message
arrives before it was sent. So with theta(t) = server minus client, t on the client's clock,

    server_sent - client_received <= theta(client_received)
    theta(client_sent) <= server_received - client_sent,

whatever the delay in each direction: the two bounds lie a round trip apart. This is the correctness
interval of NTP (Mills, RFC 5905, section 11.1; Marzullo 1984), stored as two one-sided bounds at
their own times because the clocks drift in between.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


class ClockError(ValueError):
    """The clock readings or the limits are invalid; the message says why."""


@dataclass(frozen=True)
class ClockLimits:
    """Assumptions about the clocks: over a window the offset is a line, except for a small wander.

    Attributes:
        drift: largest rate of one clock relative to the other, s/s. Crystals stay within 100 ppm;
            500 ppm is what NTP allows itself when it slews (RFC 5905, appendix A.1).
        slack_s: how far a clock may deviate from its line within a window. A crystal that warms up
            by 5 ppm in a quarter of an hour deviates by 30 us in 5 minutes. Every bound is widened
            by it and every uncertainty includes it.
        window_s: longest time that one line may cover, s.
        step_s: smallest jump that the server's wall clock is used to explain, s. That clock is read
            when a probe is stored, tens of milliseconds late.
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
    """n clock probes of one client run, in the order in which they were made; seconds.

    A probe without an answer has NaN for each missing reading. `server_utc_s` (optional) is the
    server's wall clock, read when or after the answer was sent; it is used only to decide which
    clock jumped.

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
        """All arrays of readings, the wall clock last if it is given."""
        four = (
            self.client_sent_s,
            self.server_received_s,
            self.server_sent_s,
            self.client_received_s,
        )
        return four if self.server_utc_s is None else (*four, self.server_utc_s)

    def select(self, chosen: npt.NDArray[np.bool_] | npt.NDArray[np.intp]) -> "ClockProbes":
        """Return the chosen probes, given by a mask (n,) or by indices."""
        return ClockProbes(*(array[chosen] for array in self.arrays))

    @property
    def answered(self) -> npt.NDArray[np.bool_]:
        """Mask (n,) of the probes that have all four readings."""
        complete = np.isfinite(self.client_sent_s)
        for readings in self.arrays[1:4]:
            complete = complete & np.isfinite(readings)
        return complete

    @property
    def round_trip_s(self) -> FloatArray:
        """Time on the network (n,): the client's waiting minus the server's handling time, in s.

        NaN where the probe was lost.
        """
        return (self.client_received_s - self.client_sent_s) - (
            self.server_sent_s - self.server_received_s
        )

    @property
    def offset_s(self) -> FloatArray:
        """Server minus client (n,), for equal delays in both directions (RFC 5905, theta)."""
        return 0.5 * (
            (self.server_received_s - self.client_sent_s)
            + (self.server_sent_s - self.client_received_s)
        )

    @property
    def middle_s(self) -> FloatArray:
        """The client's time half-way through each exchange, (n,)."""
        return 0.5 * (self.client_sent_s + self.client_received_s)


@dataclass(frozen=True, eq=False)
class Bounds:
    """Upper bounds of the offset at `upper_t_s` and lower bounds at `lower_t_s`, slack included.

    All arrays are (n,), one element per probe.
    """

    upper_t_s: FloatArray
    upper_s: FloatArray
    lower_t_s: FloatArray
    lower_s: FloatArray

    def between(self, first: int, end: int) -> "Bounds":
        """Return the bounds of the probes from `first` to `end` - 1."""
        part = slice(first, end)
        return Bounds(
            self.upper_t_s[part], self.upper_s[part], self.lower_t_s[part], self.lower_s[part]
        )

    def select(self, index: npt.NDArray[np.intp]) -> "Bounds":
        """Return the bounds of the probes with these indices."""
        return Bounds(
            self.upper_t_s[index], self.upper_s[index], self.lower_t_s[index], self.lower_s[index]
        )


def bounds_of(probes: ClockProbes, widening_s: float) -> Bounds:
    """Return the bounds that answered probes set, each widened by `widening_s`."""
    return Bounds(
        upper_t_s=probes.client_sent_s,
        upper_s=probes.server_received_s - probes.client_sent_s + widening_s,
        lower_t_s=probes.client_received_s,
        lower_s=probes.server_sent_s - probes.client_received_s - widening_s,
    )


def is_possible(probes: ClockProbes, widening_s: float) -> npt.NDArray[np.bool_]:
    """Return for each answered probe whether its readings can be true, (n,).

    Time must have passed on both clocks, and the round trip may be negative by no more than
    `widening_s`. That is half the widening of the two bounds together, so some line fits each probe
    on its own.
    """
    waited_s = probes.client_received_s - probes.client_sent_s
    handled_s = probes.server_sent_s - probes.server_received_s
    return (waited_s >= 0.0) & (handled_s >= 0.0) & (probes.round_trip_s >= -widening_s)


def reading_step_s(client_s: FloatArray) -> float:
    """Return the step in which a clock is read; 0 if it is finer than a millisecond.

    Browsers round their clocks, some to a millisecond or more, as protection against timing
    attacks. A clock is assumed to be rounded if all its readings are whole multiples of such a
    step.
    """
    if len(client_s) < _STEP_NEEDS:
        return 0.0
    for step_s in _READING_STEPS_S:
        steps = client_s / step_s
        if np.abs(steps - np.round(steps)).max() < 1e-4:
            return step_s
    return 0.0
