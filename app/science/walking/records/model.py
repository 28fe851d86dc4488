"""The data types of walking: tracks, walks from rest to rest, and their planned paths.

A `Track` is a person's position on the floor over time. Cut where the person stands still, and
smoothed, it gives `Walk`s. The planner plans a `PlannedPath` between a walk's start and goal; with
the numbers on which a walk is assumed to depend (length, turning, stature, or any other) that is a
`PlannedWalk`, an entry of the database. Dependencies are computed from the planned path and not
from the actual one, since for a future walk only the planned path is known.

The floor is seen from above: x to the right, y ahead, which is (x, -z) of the world's y-up frame.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np

from app.science.rotations import FloatArray

Kind = Literal["human", "synthetic"]
"""Whether a person or a program walked; stored with all data derived from a walk."""
LENGTH, TURNING, STATURE = "length_m", "turning_per_m", "stature_m"
"""Names of the paper's three dependencies, in metres, radians per metre and metres."""
OPEN_FLOOR = "open floor"
"""What a walk's scene is called on the floor without obstacles; no key, which has no space."""


class WalkingError(ValueError):
    """A walk, a scene or a model is invalid; the message says what is wrong and what to do."""


@dataclass(frozen=True, eq=False)
class Track:
    """One person's position on the floor over time.

    Attributes:
        times_s: (N,) increasing times.
        xy_m: (N, 2) finite positions.
        subject: the person; walks of one subject are never split between training and test.
        source: origin of the data, such as a file's name.
        kind: human or synthetic.
        stature_m: the person's height, None if unknown.
        scene: where it was walked, by the name of the scene; None if that is not said.
        others: further numbers by name, (N,) at each sample; NaN where one is not known.

    Raises:
        WalkingError: there are fewer than two points, positions are not finite, times do not
            increase, or there is not one further number for each sample.
    """

    times_s: FloatArray
    xy_m: FloatArray
    subject: str
    source: str
    kind: Kind = "human"
    stature_m: float | None = None
    scene: str | None = None
    others: Mapping[str, FloatArray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Validate the track."""
        what = f"The track of {self.subject!r} ({self.source})"
        _check_course(self.times_s, self.xy_m, what)
        check_stature(self.stature_m)
        for name, values in self.others.items():
            if values.shape != self.times_s.shape:
                raise WalkingError(
                    f"{what} has {name} of shape {values.shape}: give {self.times_s.shape}."
                )

    @property
    def rate_hz(self) -> float:
        """Sampling rate, from the median interval."""
        return float(1.0 / np.median(np.diff(self.times_s)))


@dataclass(frozen=True, eq=False)
class Walk:
    """One walk from a start to a goal, smoothed.

    Attributes:
        times_s: (N,) increasing times from 0.
        xy_m: (N, 2) the centre of mass on the floor.
        subject, source, kind, stature_m: the same as those of its track.
        begins_still, ends_still: whether the person stood before and after. If a recording begins
            or ends during the walk, its agent starts at speed or does not brake.
        note: information for the reader, such as the name of the scene's path.
        scene: the same as that of its track.
        others: further numbers by name: those that are known and the same during the whole walk.
        changing: further numbers that change during the walk, each with its smallest and largest
            value; no path has them before it is walked, so they are not in `others`.
    """

    times_s: FloatArray
    xy_m: FloatArray
    subject: str
    source: str
    kind: Kind = "human"
    stature_m: float | None = None
    begins_still: bool = True
    ends_still: bool = True
    note: str = ""
    scene: str | None = None
    others: Mapping[str, float] = field(default_factory=dict)
    changing: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Validate the walk."""
        _check_course(self.times_s, self.xy_m, f"The walk of {self.subject!r} ({self.source})")
        check_stature(self.stature_m)
        if self.times_s[0] != 0.0:
            raise WalkingError(f"A walk's times must begin at 0, not at {self.times_s[0]:g} s.")

    @property
    def duration_s(self) -> float:
        """Travel time of the walk."""
        return float(self.times_s[-1])

    @cached_property
    def arc_m(self) -> FloatArray:
        """Distance walked up to each sample, (N,)."""
        return arc_of(self.xy_m)

    @property
    def length_m(self) -> float:
        """Distance walked; longer than the planned path, since people sway."""
        return float(self.arc_m[-1])

    @cached_property
    def speeds_m_s(self) -> FloatArray:
        """Speed at each sample by central differences, (N,)."""
        velocity = np.gradient(self.xy_m, self.times_s, axis=0)
        return np.asarray(np.linalg.norm(velocity, axis=1), dtype=np.float64)

    @property
    def start_m(self) -> tuple[float, float]:
        """Position at which the walk begins."""
        return float(self.xy_m[0, 0]), float(self.xy_m[0, 1])

    @property
    def goal_m(self) -> tuple[float, float]:
        """Position at which the walk ends."""
        return float(self.xy_m[-1, 0]), float(self.xy_m[-1, 1])

    def at(self, times_s: FloatArray) -> FloatArray:
        """Return positions (T, 2) at any times; outside the walk's time, its start or its goal."""
        columns = [np.interp(times_s, self.times_s, self.xy_m[:, axis]) for axis in (0, 1)]
        return np.stack(columns, axis=-1)


@dataclass(frozen=True, eq=False)
class PlannedPath:
    """A polyline from start to goal, free of obstacles.

    Attributes:
        points_m: (P, 2) points, with P >= 2 and consecutive points distinct.
    """

    points_m: FloatArray

    def __post_init__(self) -> None:
        """Raise WalkingError for fewer than two points, repeated points, or points not finite."""
        points = self.points_m
        if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
            raise WalkingError(f"A path needs two points or more, (P, 2), got {points.shape}.")
        if not np.isfinite(points).all():
            raise WalkingError("A path's points must be finite.")
        if not (np.linalg.norm(np.diff(points, axis=0), axis=1) > 0.0).all():
            raise WalkingError("A path's neighbouring points must differ.")

    @cached_property
    def arc_m(self) -> FloatArray:
        """Distance along the path up to each point, (P,)."""
        return arc_of(self.points_m)

    @property
    def length_m(self) -> float:
        """Length of the whole path."""
        return float(self.arc_m[-1])


@dataclass(frozen=True, eq=False)
class PlannedWalk:
    """A walk, the path planned for it, and its dependencies: an entry of the database.

    Attributes:
        walk: the reference.
        path: the planned path from the walk's start to its goal, or, where that is not what was
            walked, the walk's own path (`is_own_path`).
        dependencies: name -> number; `LENGTH`, `TURNING`, `STATURE` and any others that were given.
    """

    walk: Walk
    path: PlannedPath
    dependencies: Mapping[str, float] = field(default_factory=dict)
    is_own_path: bool = False

    def __post_init__(self) -> None:
        """Raise WalkingError if a dependency is not finite; the message names it."""
        for name, value in self.dependencies.items():
            if not np.isfinite(value):
                raise WalkingError(f"Dependency {name} is {value}; give a finite number.")


def arc_of(points_m: FloatArray) -> FloatArray:
    """Return the distance along a line (N, 2) up to each of its points, (N,)."""
    steps = np.linalg.norm(np.diff(points_m, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def check_stature(stature_m: float | None) -> None:
    """Raise WalkingError unless a stature is None or between 0.5 and 2.6 m."""
    if stature_m is not None and not 0.5 <= stature_m <= 2.6:
        raise WalkingError(f"Stature {stature_m} is not between 0.5 and 2.6 m: give metres.")


def _check_course(times_s: FloatArray, xy_m: FloatArray, what: str) -> None:
    if times_s.ndim != 1 or xy_m.shape != (len(times_s), 2):
        raise WalkingError(
            f"{what} has times {times_s.shape} and positions {xy_m.shape}: give (N,), (N, 2)."
        )
    if len(times_s) < 2:
        raise WalkingError(f"{what} has {len(times_s)} point(s); a walk needs at least two.")
    bad = ~(np.isfinite(times_s) & np.isfinite(xy_m).all(axis=1))
    if bad.any():
        first = int(np.argmax(bad))
        raise WalkingError(
            f"{what} has {int(bad.sum())} sample(s) that are not finite, the first at index"
            f" {first}: fill short gaps (`tracks.bridged`) or cut the recording there."
        )
    steps = np.diff(times_s)
    if not (steps > 0.0).all():
        at = int(np.argmin(steps > 0.0))
        raise WalkingError(f"{what} has times that do not increase, at index {at + 1}.")
