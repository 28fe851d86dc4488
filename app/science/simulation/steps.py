"""Plan which foot steps where.

A foot's position is the middle of its sole. Both feet stay within a comfortable stride of each
other: the rear foot follows until the goal is within a stride of the standing foot.
"""

from math import hypot, sqrt

from app.science.rotations import Vector
from app.science.simulation.goal import SimulationError

LEFT, RIGHT = 0, 1
_MOST_STEPS = 60
_ARRIVED_M = 0.01
_FOLLOW_SHARE = 0.97

Feet = tuple[Vector, Vector]
Step = tuple[int, Vector]


def distance_on_floor(a: Vector, b: Vector) -> float:
    """Return the horizontal distance between two points, in metres."""
    return hypot(a[0] - b[0], a[2] - b[2])


def plan_to_stand(feet: Feet, places: Feet, stride_m: float) -> list[Step]:
    """Plan steps until both feet are at their places; the foot with the longer way goes next.

    Raises:
        SimulationError: the way would take more than 60 steps.
    """
    now, steps = list(feet), list[Step]()
    while True:
        ways = [distance_on_floor(now[foot], places[foot]) for foot in (LEFT, RIGHT)]
        foot = LEFT if ways[LEFT] > ways[RIGHT] else RIGHT
        if ways[foot] < _ARRIVED_M:
            return steps
        now[foot] = _towards(now[foot], places[foot], now[1 - foot], stride_m)
        steps.append((foot, now[foot]))
        _check(steps, places[foot])


def plan_to_step_on(
    feet: Feet, foot: int, target: Vector, stride_m: float, spots: tuple[Vector, ...] = ()
) -> list[Step]:
    """Plan steps of which the last one puts `foot` on the target.

    The other foot moves only as far as it must: sideways if that suffices, so that it stays in
    front of an edge. If it must step forward, or already stands on one of the free `spots`, it
    takes the nearest free spot within reach, if there is one.

    Raises:
        SimulationError: more than 60 steps would be needed.
    """
    now, other, steps = list(feet), 1 - foot, list[Step]()
    while distance_on_floor(now[other], target) > stride_m:
        near = _nearer(target, now[other], now[foot], stride_m, spots)
        now[other] = _towards(now[other], near, now[foot], stride_m)
        steps.append((other, now[other]))
        if distance_on_floor(now[other], target) > stride_m:
            now[foot] = _towards(now[foot], near, now[other], stride_m)
            steps.append((foot, now[foot]))
        _check(steps, target)
    return [*steps, (foot, target)]


def _nearer(
    target: Vector, mover: Vector, standing: Vector, stride_m: float, spots: tuple[Vector, ...]
) -> Vector:
    """Return where a foot should stand for the other one to step on the target."""
    gap_m, ahead = _FOLLOW_SHARE * stride_m, mover[2] - target[2]
    among = any(distance_on_floor(mover, spot) < _ARRIVED_M for spot in spots)
    if abs(ahead) <= gap_m and not among:
        aside = sqrt(gap_m * gap_m - ahead * ahead)
        return (target[0] + (aside if mover[0] > target[0] else -aside), 0.0, mover[2])
    free = [
        spot
        for spot in spots
        if 0.0 < distance_on_floor(spot, target) <= stride_m
        and 0.0 < distance_on_floor(spot, standing) <= stride_m
    ]
    if free:
        return min(free, key=lambda spot: distance_on_floor(spot, mover))
    share = gap_m / max(distance_on_floor(target, mover), gap_m)
    return (
        target[0] + share * (mover[0] - target[0]),
        0.0,
        target[2] + share * (mover[2] - target[2]),
    )


def _check(steps: list[Step], target: Vector) -> None:
    if len(steps) > _MOST_STEPS:
        raise SimulationError(f"Target {target} is more than {_MOST_STEPS} steps away.")


def _towards(foot: Vector, place: Vector, standing: Vector, stride_m: float) -> Vector:
    """Return the place, or the farthest point on the way to it within a stride of `standing`."""
    for share in (1.0, 0.8, 0.65, 0.5, 0.35, 0.2, 0.1):
        x = foot[0] + share * (place[0] - foot[0])
        z = foot[2] + share * (place[2] - foot[2])
        point = (x, place[1], z)
        if distance_on_floor(point, standing) <= stride_m:
            return place if share == 1.0 else point
    return (foot[0] + 0.1 * (place[0] - foot[0]), place[1], foot[2] + 0.1 * (place[2] - foot[2]))
