"""Poses over time, of the headset or of a tracker, and their values between the samples."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, cast

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray, geodesic_angle, is_unit, normalise, slerp

BoolArray = npt.NDArray[np.bool_]
Problem = Literal["samples", "short", "still", "turn", "nod", "unlike", "delay"]
"""Why streams cannot be aligned.

`samples`: the numbers are not poses at rising times. `short`: too little time in common. `still`:
the head hardly turned. `turn`, `nod`: it turned about one axis only, and turning left and right, or
up and down, is missing. `unlike`: the tracker does not turn as the head does. `delay`: the delay is
outside of the range that was searched.
"""
LONGEST_GAP_S = 0.1
"""Between samples further apart than this, a pose is unknown."""

FASTEST_RAD_S = 15.0
"""A head reaches about 10 rad/s; what seems to turn faster is a tracker that was lost."""
_SPIKE_RAD = 0.15  # at high rates, noise alone turns fast


class AlignmentError(ValueError):
    """Two streams cannot be aligned; `problem` says why, for those who translate the message."""

    def __init__(self, problem: Problem, message: str) -> None:
        super().__init__(message)
        self.problem = problem


@dataclass(frozen=True, eq=False)
class PoseStream:
    """The pose of one thing in its tracking system's world, over time.

    Attributes:
        times_s: (N,) rising strictly, by any clock that is common to the streams that are compared.
        positions_m: (N, 3).
        rotations: (N, 4) world_from_thing, unit quaternions w, x, y, z.
        weights: (N,) how much each sample counts, at least 0; a sample of weight 0, such as one
            that the tracking system guessed, is not used. 1 by default.
    """

    times_s: FloatArray
    positions_m: FloatArray
    rotations: FloatArray
    weights: FloatArray

    @classmethod
    def of(
        cls,
        times_s: npt.ArrayLike,
        positions_m: npt.ArrayLike,
        rotations: npt.ArrayLike,
        weights: npt.ArrayLike | None = None,
    ) -> "PoseStream":
        """Return a stream of checked samples.

        Raises:
            AlignmentError: shapes differ, times do not rise, or a sample is not a pose.
        """
        times = np.asarray(times_s, dtype=np.float64)
        positions = np.asarray(positions_m, dtype=np.float64)
        turned = np.asarray(rotations, dtype=np.float64)
        n = times.shape[0] if times.ndim == 1 else -1
        counted = np.ones(max(n, 0)) if weights is None else np.asarray(weights, dtype=np.float64)
        if (positions.shape, turned.shape, counted.shape) != ((n, 3), (n, 4), (n,)):
            raise AlignmentError(
                "samples",
                f"Shapes {times.shape}, {positions.shape}, {turned.shape} and {counted.shape} do"
                " not fit: give N times, (N, 3) positions, (N, 4) rotations and N weights.",
            )
        _check("is not later than the one before", times, np.diff(times, prepend=-np.inf) > 0.0)
        _check("has no finite time", times, np.isfinite(times))
        _check("has no finite position", times, np.asarray(np.isfinite(positions).all(axis=1)))
        _check("has no rotation of unit length", times, is_unit(turned, 0.1))
        _check("has no weight of at least 0", times, np.isfinite(counted) & (counted >= 0.0))
        return cls(times, positions, normalise(turned) if n > 0 else turned, counted)

    def between(self, start_s: float, end_s: float) -> "PoseStream":
        """Return the samples from `start_s` to `end_s`, both included."""
        part = slice(
            int(np.searchsorted(self.times_s, start_s, side="left")),
            int(np.searchsorted(self.times_s, end_s, side="right")),
        )
        return PoseStream(
            self.times_s[part], self.positions_m[part], self.rotations[part], self.weights[part]
        )

    def without_spikes(self) -> "PoseStream":
        """Return the samples without those that are turned far from both neighbours."""
        if len(self.times_s) < 2:
            return self
        turns = geodesic_angle(self.rotations[:-1], self.rotations[1:])
        far = turns > np.maximum(FASTEST_RAD_S * np.diff(self.times_s), _SPIKE_RAD)
        good = ~(np.append(far, True) & np.insert(far, 0, True))
        if good.all():
            return self
        return PoseStream(
            self.times_s[good], self.positions_m[good], self.rotations[good], self.weights[good]
        )

    def at(self, times_s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return positions (M, 3), rotations (M, 4) and weights (M,) at any times (M,).

        Positions are linear between two samples, rotations turn at constant speed. The weight is
        the smaller one of both samples; it is 0 outside of the stream and in gaps.
        """
        times = self.times_s
        if len(times) < 2:
            raise AlignmentError("short", f"A stream of {len(times)} samples: give 2 or more.")
        low = np.clip(np.searchsorted(times, times_s, side="right") - 1, 0, len(times) - 2)
        step_s = times[low + 1] - times[low]
        fraction = np.clip((times_s - times[low]) / step_s, 0.0, 1.0)
        known = (times_s >= times[0]) & (times_s <= times[-1]) & (step_s <= LONGEST_GAP_S)
        before, after = self.positions_m[low], self.positions_m[low + 1]
        positions = before + fraction[:, np.newaxis] * (after - before)
        rotations = slerp(self.rotations[low], self.rotations[low + 1], fraction)
        weights = np.where(known, np.minimum(self.weights[low], self.weights[low + 1]), 0.0)
        return positions, rotations, weights


def _check(what: str, times_s: FloatArray, good: BoolArray) -> None:
    if not bool(good.all()):
        first = int(np.argmin(good))
        raise AlignmentError(
            "samples",
            f"Sample {first + 1} of {len(times_s)}, at {times_s[first]:g} s, {what}: leave it out.",
        )


def robust_spread(sizes: FloatArray, least: float) -> float:
    """Return the standard deviation per axis of errors in three dimensions from their sizes (N,).

    Half of the lengths of normal errors are below 1.538 standard deviations (chi distribution with
    3 degrees of freedom), so outliers hardly change it.
    """
    return max(float(np.median(sizes)) / 1.538172, least)


def mean_rotation(rotations: FloatArray, weights: FloatArray) -> FloatArray:
    """Return the weighted mean (4,) of rotations (N, 4).

    It maximises the sum of squared cosines to all of them. Source: Markley et al. (2007),
    "Averaging quaternions", J. Guidance, Control, and Dynamics 30:1193-1197.
    """
    _, vectors = np.linalg.eigh((rotations * weights[:, np.newaxis]).T @ rotations)
    return cast("FloatArray", vectors[:, -1])


def reweighted(
    solve: Callable[[FloatArray], FloatArray], weights: FloatArray, rounds: int, least: float
) -> None:
    """Solve repeatedly, each time with less weight on samples with large errors.

    `solve` takes weights (N,), keeps its solution, and returns each sample's error (N,). The
    weights are those of a Cauchy distribution, under which a few gross errors hardly count.
    """
    errors = solve(weights)
    for _ in range(rounds):
        scale = 2.0 * max(float(np.median(errors)), least)
        errors = solve(weights / (1.0 + (errors / scale) ** 2))
