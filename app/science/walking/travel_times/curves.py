"""How long a path takes: curves of travel time, by few parameters that differ between people.

A curve gives the travel time T of a person on a path of length d. Ours, `StartingAndStopping`, is
the time of a steering agent that speeds up, walks, and brakes: with its pace p = 1 / v and its ramp
time tau = v / a,

    T = p d + tau            from rest to rest, if it reaches its full speed (d >= tau / p)
    T = 2 sqrt(p tau d)      if the path is too short for that

On paths that short people are not quite agents: some go on as the line p d + tau does. So there the
logarithm of T is a mean of both, with a share kappa of the agent's time, which is learnt; from
d = tau / p on both are the same. Since people slow down in turns, d is the length plus r metres for
each radian of turning. A walk that the recording cuts at one end has half the ramp, one that is cut
at both ends has none. Further dependencies, such as stature, change the pace by a share of their
own standard deviation.

The other curves are baselines, with which every evaluation compares: `ConstantSpeed` T = p d,
`Line` T = p d + c, and `LogLog` log T = a + b log d. They do not know how a walk begins and ends.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray
from app.science.walking.records import LENGTH, TURNING, PlannedWalk, WalkingError

SHORTEST_S = 0.05
"""Smallest travel time of a curve: a line may cross zero."""


@dataclass(frozen=True, eq=False)
class TimedWalks:
    """What a curve knows of N walks, and of each its travel time.

    Attributes:
        lengths_m: (N,) lengths of the paths.
        turnings_rad: (N,) total turning of the paths.
        resting: (N,) share of the ramp that was recorded: 1 from rest to rest, .5 if the recording
            cuts one end of the walk, 0 if it cuts both.
        others: (N, m) further dependencies as z-scores.
        durations_s: (N,) travel times.
        subjects: N names; walks of one person are not independent.
    """

    lengths_m: FloatArray
    turnings_rad: FloatArray
    resting: FloatArray
    others: FloatArray
    durations_s: FloatArray
    subjects: tuple[str, ...]

    def __post_init__(self) -> None:
        """Raise WalkingError for shapes that do not match, or values that are not positive."""
        count = len(self.subjects)
        columns = (self.lengths_m, self.turnings_rad, self.resting, self.durations_s)
        if not count or any(column.shape != (count,) for column in columns):
            raise WalkingError("Travel times need one length, turning and duration for each walk.")
        if self.others.ndim != 2 or len(self.others) != count:
            raise WalkingError(f"Other dependencies need rows (N, m), got {self.others.shape}.")
        for name, column in (("duration", self.durations_s), ("length", self.lengths_m)):
            bad = ~(np.isfinite(column) & (column > 0.0))
            if bad.any():
                at = int(np.argmax(bad))
                raise WalkingError(
                    f"Walk {at + 1} of {self.subjects[at]!r} has a {name} of {column[at]}: give a"
                    " positive number."
                )

    def __len__(self) -> int:
        """Return the number of walks, N."""
        return len(self.subjects)

    @property
    def persons(self) -> tuple[str, ...]:
        """The names of all people, sorted."""
        return tuple(sorted(set(self.subjects)))

    def select(self, chosen: npt.NDArray[np.bool_] | npt.NDArray[np.intp]) -> "TimedWalks":
        """Return some of the walks, by a mask (N,) or by indices."""
        at = np.arange(len(self))[chosen]
        return TimedWalks(
            self.lengths_m[at],
            self.turnings_rad[at],
            self.resting[at],
            self.others[at],
            self.durations_s[at],
            tuple(self.subjects[i] for i in at),
        )


@dataclass(frozen=True)
class Coefficient:
    """A parameter of a curve, with its weak prior.

    Attributes:
        name: what it is, with its unit.
        mean, sd: the prior of the value of a median person: normal, and wide.
        between: scale of the prior of its standard deviation between people; 0 if people do not
            differ in it.
    """

    name: str
    mean: float
    sd: float
    between: float = 0.0


class Curve(Protocol):
    """Protocol of a curve of travel time; those coefficients in which people differ come first."""

    @property
    def name(self) -> str:
        """Short key."""
        ...

    def coefficients(self, others: int) -> tuple[Coefficient, ...]:
        """Return the curve's coefficients, given the number of further dependencies."""
        ...

    def times_s(self, walks: TimedWalks, values: FloatArray) -> FloatArray:
        """Return travel times (..., N) for coefficients that broadcast, (..., N, p) or (p,)."""
        ...


LOG_PACE = Coefficient("log pace, s/m", float(np.log(1.0 / 1.3)), 0.7, 0.1)
"""Most people prefer 1.1 to 1.5 m/s (Bohannon 1997), with a between-person SD of 10 to 15 %."""


@dataclass(frozen=True)
class StartingAndStopping:
    """Our curve: an agent's pace, and the time that its speeding up and braking adds."""

    name: str = "starting and stopping"

    def coefficients(self, others: int) -> tuple[Coefficient, ...]:
        """Return pace and ramp time, in which people differ, turns, short walks, and others."""
        return (
            LOG_PACE,
            Coefficient("log ramp time, s", float(np.log(1.5)), 0.7, 0.2),
            Coefficient("turning, m/rad", 0.0, 0.3),
            Coefficient("agent's share of short walks", 0.5, 0.5),
            *(Coefficient(f"dependency {at + 1}", 0.0, 0.1) for at in range(others)),
        )

    def times_s(self, walks: TimedWalks, values: FloatArray) -> FloatArray:
        """Return travel times (..., N)."""
        shift = (
            np.einsum("...m,...m->...", values[..., 4:], walks.others)
            if (walks.others.shape[1])
            else 0.0
        )
        pace = np.exp(values[..., 0] + shift)
        ramp_s = walks.resting * np.exp(values[..., 1])
        extra_m = values[..., 2] * walks.turnings_rad
        distance_m = np.maximum(walks.lengths_m + extra_m, 0.1 * walks.lengths_m)
        cruise_s = pace * distance_m
        line_s: FloatArray = cruise_s + ramp_s
        # The agent's time over the line's: 1 where it reaches its full speed, less below.
        share = np.minimum(2.0 * np.sqrt(cruise_s * ramp_s) / line_s, 1.0)
        share = np.where(cruise_s >= ramp_s, 1.0, share)
        return np.maximum(line_s * share ** values[..., 3], SHORTEST_S)


@dataclass(frozen=True)
class ConstantSpeed:
    """Baseline: everybody walks at a constant speed of their own."""

    name: str = "constant speed"

    def coefficients(self, others: int) -> tuple[Coefficient, ...]:
        """Return the pace."""
        del others
        return (LOG_PACE,)

    def times_s(self, walks: TimedWalks, values: FloatArray) -> FloatArray:
        """Return travel times (..., N)."""
        times_s: FloatArray = np.exp(values[..., 0]) * walks.lengths_m
        return np.maximum(times_s, SHORTEST_S)


@dataclass(frozen=True)
class Line:
    """Baseline: a line through distance, with slope and intercept of each person."""

    name: str = "line"

    def coefficients(self, others: int) -> tuple[Coefficient, ...]:
        """Return slope and intercept."""
        del others
        return LOG_PACE, Coefficient("intercept, s", 1.0, 2.0, 0.3)

    def times_s(self, walks: TimedWalks, values: FloatArray) -> FloatArray:
        """Return travel times (..., N)."""
        times_s: FloatArray = np.exp(values[..., 0]) * walks.lengths_m + values[..., 1]
        return np.maximum(times_s, SHORTEST_S)


@dataclass(frozen=True)
class LogLog:
    """Baseline: a line through the logarithm of distance, with level and slope of each person."""

    name: str = "log-log"

    def coefficients(self, others: int) -> tuple[Coefficient, ...]:
        """Return the level at one metre, and the slope."""
        del others
        return (
            Coefficient("log time of one metre, s", float(np.log(1.5)), 0.7, 0.1),
            Coefficient("slope", 0.8, 0.4, 0.1),
        )

    def times_s(self, walks: TimedWalks, values: FloatArray) -> FloatArray:
        """Return travel times (..., N)."""
        times_s: FloatArray = np.exp(values[..., 0] + values[..., 1] * np.log(walks.lengths_m))
        return np.maximum(times_s, SHORTEST_S)


BASELINES: tuple[Curve, ...] = (ConstantSpeed(), Line(), LogLog())
"""The curves with which ours is compared."""


def resting_of(entry: PlannedWalk) -> float:
    """Return the share of the ramp that a walk's recording contains: 1, .5 or 0."""
    return (entry.walk.begins_still + entry.walk.ends_still) / 2.0


def turning_of(dependencies: Mapping[str, float]) -> float:
    """Return the total turning of a path from its dependencies, rad."""
    return dependencies.get(TURNING, 0.0) * dependencies.get(LENGTH, 0.0)
