"""Two feet that stand or step, and the position of the body between them."""

import numpy as np

from app.science.rotations import Vector, v_add, v_length
from app.science.simulation.aiming import Aim
from app.science.simulation.goal import Goal, GoalKind
from app.science.simulation.paths import SmoothPath, path_through
from app.science.simulation.steps import (
    LEFT,
    RIGHT,
    Feet,
    Step,
    distance_on_floor,
    plan_to_stand,
    plan_to_step_on,
)
from app.science.simulation.vision import LateVision
from app.science.skeleton import Skeleton

_LEAST_LIFT_M = 0.06
_STEP_S, _STEP_S_PER_M = 0.35, 0.45
_UNSEEN_S = 2.0
_STILL: Vector = (0.0, 0.0, 0.0)


class Stance:
    """The positions of both feet over time: their soles, their steps, and the body above them.

    A step ends beside its goal by noise. It is not corrected in the air; by `vision` the person
    notices that the foot rests without effect, and steps once more.
    """

    def __init__(
        self, skeleton: Skeleton, centre_m: tuple[float, float], vision: LateVision
    ) -> None:
        self._vision = vision
        stature = skeleton.stature_m
        self._half_width_m = 0.055 * stature
        # The ankle is a quarter of the foot's length (.152 H) from the heel: the middle is ahead.
        self._sole_ahead_m = 0.038 * stature
        self._stride_m = 0.72 * skeleton.leg_length_m
        self.goal: Goal | None = None
        self.aimed_m: Vector | None = None
        # Places that a foot has stepped into are free of edges: the other foot may use them too.
        self._boxes: dict[Vector, Vector] = {}
        self.place_at(centre_m)

    def place_at(self, centre_m: tuple[float, float]) -> None:
        """Put both feet on the floor under a body at (x, z), without stepping."""
        left, right = self._places((centre_m[0], 0.0, centre_m[1]))
        self.soles: list[Vector] = [left, right]
        self._edges: list[Vector] = [_STILL, _STILL]
        self._swing: tuple[int, SmoothPath] | None = None
        self._queue: list[Step] = []
        self._pending: Goal | None = None
        self._react_s = 0.0
        self._since_s = 0.0

    @property
    def busy(self) -> bool:
        """Whether a foot is in the air or a step is already planned or requested."""
        return self._swing is not None or bool(self._queue) or self._pending is not None

    @property
    def bearing_foot(self) -> int | None:
        """The foot that bears the weight: the standing or last moved one; None for both feet."""
        if self._swing is not None:
            return 1 - self._swing[0]
        if self.goal is None or self.goal.kind is not GoalKind.STEP:
            return None
        return _foot_of(self.goal)

    @property
    def centre_m(self) -> tuple[float, float]:
        """The midpoint between the ankles, (x, z)."""
        left, right = self.soles
        return (left[0] + right[0]) / 2.0, (left[2] + right[2]) / 2.0 + self._sole_ahead_m

    def ankle(self, foot: int, ankle_height_m: float) -> Vector:
        """Return the position of the ankle of a flat foot."""
        x, y, z = self.soles[foot]
        return (x, y + ankle_height_m, z + self._sole_ahead_m)

    def set_goal(self, goal: Goal | None, time_s: float, reaction_s: float) -> None:
        """Set a new goal to step or walk, or None to stay; it is acted on after a reaction time."""
        self._pending, self._react_s = goal, time_s + reaction_s
        self._queue.clear()
        if goal is None:
            self.goal = None

    def side_step(self, centre_m: tuple[float, float]) -> None:
        """Step so that the body stands at (x, z); ignored while steps are in progress."""
        if not self.busy:
            places = self._places((centre_m[0], 0.0, centre_m[1]))
            self._queue = plan_to_stand(self._feet(), places, self._stride_m)

    def follow(self, time_s: float, aim: Aim, rng: np.random.Generator) -> None:
        """Advance the feet by one frame."""
        if self._swing is not None:
            foot, path = self._swing
            self.soles[foot] = path.at(time_s)
            if time_s < path.end_s:
                return
            self._swing, self._since_s = None, time_s
        if self._pending is not None and time_s >= self._react_s:
            self.goal, self._pending = self._pending, None
            self._plan(self.goal)
        elif self._retry_is_due(time_s, aim) and self.goal is not None:
            self._plan(self.goal)
        if self._queue:
            self._lift_off(time_s, aim, rng)

    def _feet(self) -> Feet:
        return (self.soles[LEFT], self.soles[RIGHT])

    def _places(self, centre: Vector) -> Feet:
        x, y, z = centre
        ahead = z - self._sole_ahead_m
        return (x - self._half_width_m, y, ahead), (x + self._half_width_m, y, ahead)

    def _plan(self, goal: Goal) -> None:
        target = goal.target_m or _STILL
        if goal.kind is GoalKind.STEP:
            foot, spots = _foot_of(goal), tuple(self._boxes)
            self._queue = plan_to_step_on(self._feet(), foot, target, self._stride_m, spots)
            if goal.approach_m[1] > _LEAST_LIFT_M:
                self._boxes[target] = goal.approach_m
        else:
            self._queue = plan_to_stand(self._feet(), self._places(target), self._stride_m)

    def _retry_is_due(self, time_s: float, aim: Aim) -> bool:
        """Return whether a step has had no effect for longer than the person's patience."""
        if self.goal is None or self.goal.kind is not GoalKind.STEP or self.busy:
            return False
        rests_s = self._since_s
        if self._vision.sees:
            seen_s = self._vision.still_since_s
            longest_s = rests_s + _UNSEEN_S
            rests_s = longest_s if seen_s is None else min(max(rests_s, seen_s), longest_s)
        return time_s > rests_s + aim.traits.patience_s

    def _lift_off(self, time_s: float, aim: Aim, rng: np.random.Generator) -> None:
        foot, place = self._queue.pop(0)
        here, goal = self.soles[foot], self.goal
        edge = goal.approach_m[1] if goal is not None else 0.0
        lift = max(_LEAST_LIFT_M, edge, self._edges[foot][1], self._edges[1 - foot][1])
        up: Vector = (0.0, lift, 0.0)
        if goal is not None and goal.kind is GoalKind.STEP and not self._queue:
            approach = goal.approach_m if v_length(goal.approach_m) > _LEAST_LIFT_M else up
            into = Goal(goal.kind, goal.effector, place, goal.near_m, approach)
            path = _on_floor(aim, aim.path(here, up, into, time_s, rng), rng)
            self.aimed_m, self._edges[foot] = path.at(path.end_s), approach
        else:
            over = [(x, y + lift, z) for x, y, z in (here, place)]
            lasts_s = _STEP_S + _STEP_S_PER_M * distance_on_floor(here, place)
            path = path_through([here, *over, place], time_s, aim.traits.tempo * lasts_s)
            self._edges[foot] = self._boxes.get(place, _STILL)
        self._swing = (foot, path)


def _on_floor(aim: Aim, path: SmoothPath, rng: np.random.Generator) -> SmoothPath:
    """Return the path with its noise; the sole still ends on the floor, and not below it."""
    noise = aim.noise(path, rng)
    moves = tuple(
        (begins, lasts, v_add(way, (dx, 0.0, dz)))
        for (begins, lasts, way), (_, _, (dx, _, dz)) in zip(path.moves, noise.moves, strict=True)
    )
    return SmoothPath(path.start_m, moves)


def _foot_of(goal: Goal) -> int:
    return LEFT if goal.effector == "LeftFoot" else RIGHT
