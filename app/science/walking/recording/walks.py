"""Make database entries from walks: the planned path, and the dependencies."""

from collections.abc import Mapping

from app.science.walking.records import (
    LENGTH,
    STATURE,
    TURNING,
    PlannedPath,
    PlannedWalk,
    Planner,
    Walk,
    WalkingError,
    check_stature,
)
from app.science.walking.scene import turning_per_m

NONE: Mapping[str, float] = {}


def dependencies_of(
    path: PlannedPath, stature_m: float | None = None, others: Mapping[str, float] = NONE
) -> dict[str, float]:
    """Return the dependencies of a walk along a path, for an entry or for a query to the model.

    Args:
        path: the planned path.
        stature_m: the person's height; None leaves it out.
        others: any further numbers by name, such as a load in kilograms.

    Raises:
        WalkingError: one of `others` has one of the three names, or the stature is impossible.
    """
    check_stature(stature_m)
    own = {LENGTH: path.length_m, TURNING: turning_per_m(path.points_m)}
    if stature_m is not None:
        own[STATURE] = stature_m
    clash = [name for name in others if name in (LENGTH, TURNING, STATURE)]
    if clash:
        raise WalkingError(f"{', '.join(clash)} is computed or given already: choose other names.")
    return own | dict(others)


def planned_walk(walk: Walk, planner: Planner, others: Mapping[str, float] = NONE) -> PlannedWalk:
    """Plan the path between a walk's own start and goal, and make a database entry of both.

    Raises:
        SceneError: the planner finds no path.
    """
    path = planner.plan(walk.start_m, walk.goal_m)
    return PlannedWalk(walk, path, dependencies_of(path, walk.stature_m, others))
