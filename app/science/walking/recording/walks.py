"""Make database entries from walks: the path, and the dependencies.

The model predicts how somebody walks along a planned path, so a walk is compared with agents on the
path between its own start and goal. People who do not walk that path would spoil the comparison: a
captured walk of 15 m that turns by 650 degrees ends .34 m from its start, and an agent is there in
less than a second. So the distance walked is compared with the path's length (`entry_of`). A walk
that is longer, by more than people sway, has taken another way: it gets its own path, without the
sway, and with the turning of that path. So does one that is hardly longer but curves away from the
planned path: an arc of 45 degrees is 3 % longer than its chord. A walk that is shorter went through
what the scene calls an obstacle and is left out.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.recording.segmentation import smoothed
from app.science.walking.records import (
    LENGTH,
    STATURE,
    TURNING,
    PlannedPath,
    PlannedWalk,
    Planner,
    Walk,
    check_name,
    check_stature,
)
from app.science.walking.scene import by_length, turning_per_m

NONE: Mapping[str, float] = {}
LONGER, SHORTER = 1.08, 0.92
"""Distance walked over planned length: beyond these shares, another path was walked."""
ASIDE, ASIDE_M = 0.06, 0.2
"""Share of the planned length, and distance, both of which a curved walk leaves the planned path.
On straight courses of 14 m real heads leave it by up to .5 m, which is less than 4 %."""
SWAY_S = 0.2
"""Standard deviation of the filter that takes most of the sway of a stride from a walk."""
_SPACING_M = 0.1


FASTEST_M_S = 4.0
"""Mean speed that nobody walks: race walkers come close to it, and others run from 2 m/s on."""
SAME_M = 1e-3
"""Largest difference between two recordings of one walk."""


@dataclass(frozen=True, eq=False)
class LeftOut:
    """A walk that cannot be an entry of the database, and why."""

    walk: Walk
    reason: str


def dependencies_of(
    path: PlannedPath, stature_m: float | None = None, others: Mapping[str, float] = NONE
) -> dict[str, float]:
    """Return the dependencies of a walk along a path, for an entry or for a query to the model.

    Args:
        path: the planned path.
        stature_m: the person's height; None leaves it out.
        others: any further numbers by name, such as a load in kilograms.

    Raises:
        WalkingError: a name of `others` is not valid (`check_name`), or the stature is impossible.
    """
    check_stature(stature_m)
    own = {LENGTH: path.length_m, TURNING: turning_per_m(path.points_m)}
    if stature_m is not None:
        own[STATURE] = stature_m
    for name in others:
        check_name(name)
    return own | dict(others)


def planned_walk(walk: Walk, planner: Planner, others: Mapping[str, float] = NONE) -> PlannedWalk:
    """Plan the path between a walk's own start and goal, and make a database entry of both.

    Its dependencies are the paper's, the walk's own further numbers, and `others`.

    Raises:
        SceneError: the planner finds no path.
    """
    path = planner.plan(walk.start_m, walk.goal_m)
    return PlannedWalk(walk, path, dependencies_of(path, walk.stature_m, {**walk.others, **others}))


def entry_of(
    walk: Walk, planner: Planner, others: Mapping[str, float] = NONE
) -> PlannedWalk | LeftOut:
    """Make a database entry of a recorded walk, on the path that it really took.

    Raises:
        SceneError: the planner finds no path.
    """
    entry = planned_walk(walk, planner, others)
    share = walk.length_m / entry.path.length_m
    if share < SHORTER:
        return LeftOut(
            walk,
            f"{walk.length_m:.2f} m were walked where the shortest path of the scene is"
            f" {entry.path.length_m:.2f} m: the walk crosses an obstacle",
        )
    path = own_path(walk)
    if share <= LONGER and not _is_aside(path.points_m, entry.path):
        return entry
    dependencies = dependencies_of(path, walk.stature_m, {**walk.others, **others})
    return PlannedWalk(walk, path, dependencies, is_own_path=True)


class Recorded:
    """The walks of some files so far, to notice what cannot be one more walk of somebody.

    A file that is given twice, or under another name, would count as one more walk, and even as one
    more person. A table with a wrong unit or rate gives walks faster than anybody walks.
    """

    def __init__(self) -> None:
        self._by_samples: dict[int, list[tuple[str, Walk]]] = {}

    def objection(self, walk: Walk, name: str) -> str | None:
        """Return why a walk cannot be used, or None, and remember it by its name."""
        speed = walk.length_m / walk.duration_s
        if speed > FASTEST_M_S:
            return (
                f"it goes {speed:.1f} m/s on average, faster than anybody walks: check the unit of"
                " x and y, and the rate"
            )
        alike = self._by_samples.setdefault(len(walk.times_s), [])
        for other_name, other in alike:
            if _is_same(walk, other):
                return f"it is the same recording as {other_name}, sample for sample"
        alike.append((name, walk))
        return None


def _is_same(one: Walk, other: Walk) -> bool:
    places = [walk.xy_m - walk.xy_m[0] for walk in (one, other)]
    return bool(
        np.abs(one.times_s - other.times_s).max() < SAME_M
        and np.abs(places[0] - places[1]).max() < SAME_M
    )


def _is_aside(points_m: FloatArray, path: PlannedPath) -> bool:
    """Return whether one of the points (N, 2) lies far from a path, as on a curve."""
    nearest = np.full(len(points_m), np.inf)
    for start, end in pairwise(path.points_m):
        along = end - start
        share = np.clip((points_m - start) @ along / (along @ along), 0.0, 1.0)
        from_leg = np.linalg.norm(points_m - start - share[:, np.newaxis] * along, axis=1)
        nearest = np.minimum(nearest, from_leg)
    return float(nearest.max()) > max(ASIDE_M, ASIDE * path.length_m)


def own_path(walk: Walk) -> PlannedPath:
    """Return the path of a walk without the sway of its strides; its ends stay where they are."""
    rate_hz = (len(walk.times_s) - 1) / walk.duration_s
    return PlannedPath(by_length(smoothed(walk.xy_m, rate_hz, SWAY_S), _SPACING_M))
