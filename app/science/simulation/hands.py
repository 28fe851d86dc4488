"""The movement of one hand towards its goals: react, withdraw, reach, enter, wait, and retry."""

from math import inf

import numpy as np

from app.science.rotations import Vector, v_add, v_dot, v_length, v_scale, v_subtract
from app.science.simulation.aiming import Aim
from app.science.simulation.goal import Goal
from app.science.simulation.paths import SmoothPath, minimum_jerk
from app.science.simulation.vision import LateVision

_ENGAGE_S = 0.45
_BACK_OFF_M = 0.08
# Share of the time of the way out after which hand and wrist are past the edges.
_OUT_SHARE = 0.6
_UNSEEN_S = 2.0
_CAUGHT_M = 0.06
_FORWARD: Vector = (0.0, 0.0, -1.0)
_TURN_RATE = 6.0


class Hand:
    """The position of one finger tip over time, and how far the arm has left its base movement.

    A hand without a goal hangs with the base movement (work 0); with a goal, it takes `_ENGAGE_S`
    to leave it (work 1). Only a new touch counts, so a hand whose goal has not changed after the
    person's patience backs off and touches once more. If that has no effect either, as when the
    following body is caught at an edge, the hand withdraws completely and enters from outside.
    The hand is moved beside its planned path by noise and by the correction of `vision`.
    """

    def __init__(self, vision: LateVision) -> None:
        self.vision = vision
        self.goal: Goal | None = None
        self.tip_m: Vector = (0.0, 0.0, 0.0)
        self.fingers: Vector = _FORWARD
        self.aimed_m: Vector | None = None
        self._path: SmoothPath | None = None
        self._noise: SmoothPath | None = None
        self._left: Goal | None = None
        self._pending: Goal | None = None
        self._react_s = self._settle_s = 0.0
        self._work = 0.0
        self._misses = 0
        #: When the hand is (or was) out of its previous box; infinite while that is unknown.
        self.out_s = inf

    @property
    def work(self) -> float:
        """Share of the arm's pose that follows the goal, 0 to 1, changing smoothly."""
        return minimum_jerk(self._work)

    @property
    def idle(self) -> bool:
        """Whether the arm hangs and has no goal to act on."""
        return self._work == 0.0 and self._pending is None

    def set_goal(
        self, goal: Goal | None, time_s: float, reaction_s: float, settle_s: float = 0.0
    ) -> None:
        """Set a new goal, or None to let the arm hang; the hand acts on it after the reaction time.

        The hand waits in front of the goal until the body has had `settle_s` to follow.
        """
        self._pending, self._react_s, self._settle_s = goal, time_s + reaction_s, settle_s
        self.out_s = inf
        if goal is None:
            self.goal = None

    def follow(
        self,
        time_s: float,
        step_s: float,
        tip_now_m: Vector | None,
        aim: Aim,
        rng: np.random.Generator,
    ) -> None:
        """Advance the hand by one frame.

        `tip_now_m` is the present position of the finger tip, needed if the arm was hanging.
        """
        if self._pending is not None and time_s >= self._react_s:
            self._set_off(time_s, tip_now_m, aim, rng)
        elif self.goal is not None and self._is_caught(time_s, aim):
            self._misses = max(self._misses, 1)
            self._try_again(self.goal, time_s, aim, rng)
        elif self.goal is not None and time_s > self._rests_since_s() + aim.traits.patience_s:
            self._try_again(self.goal, time_s, aim, rng)
        if self._path is not None and self._noise is not None:
            planned = self._path.at(time_s)
            if self._work >= 1.0:
                gains = aim.traits.correction_per_s, aim.traits.learning_per_s
                self.vision.correct(time_s, planned, gains, step_s)
            corrected = v_add(self.vision.correction_m, self.vision.learned_m)
            self.tip_m = v_add(planned, v_add(self._noise.at(time_s), corrected))
        change = step_s / _ENGAGE_S
        self._work = min(1.0, self._work + change) if self.goal else max(0.0, self._work - change)
        self._turn(step_s)

    def seen_out(self, time_s: float) -> bool:
        """Return whether the hand is seen out of the opening that it leaves.

        If it is not seen at all, it counts as where it was planned to be; and nobody waits longer
        than `_UNSEEN_S` for a hand that is caught.
        """
        at_m = self.vision.perceived_m
        if at_m is None or self._left is None or time_s > self.out_s + _UNSEEN_S:
            return time_s >= self.out_s
        way = self._left.approach_m
        out = v_dot(v_subtract(at_m, self._left.target_m or at_m), way)
        return time_s >= self.out_s and out >= _OUT_SHARE * v_dot(way, way)

    def _is_caught(self, time_s: float, aim: Aim) -> bool:
        """Return whether the hand was seen to move, and now rests far from where it should be."""
        vision = self.vision
        if vision.still_since_s is None or not vision.seen_moving:
            return False
        long_s = time_s - vision.still_since_s
        return long_s > aim.traits.caught_s and v_length(vision.error_m) > _CAUGHT_M

    def _rests_since_s(self) -> float:
        """Return since when the hand has rested, as far as the person can see."""
        path = self._path
        if path is None:
            return inf
        if not self.vision.sees:
            return path.end_s
        seen_s = self.vision.still_since_s
        longest_s = path.end_s + _UNSEEN_S
        return longest_s if seen_s is None else min(max(path.end_s, seen_s), longest_s)

    def _set_off(
        self, time_s: float, tip_now_m: Vector | None, aim: Aim, rng: np.random.Generator
    ) -> None:
        goal, self._pending = self._pending, None
        if goal is None:
            return
        way_out: Vector = (0.0, 0.0, 0.0)
        here = self.tip_m
        if self._work == 0.0 and tip_now_m is not None:
            here = tip_now_m
        elif self.goal is not None:
            way_out = self.goal.approach_m
        self._left = self.goal if v_length(way_out) > 0.0 else None
        self._misses = 0
        self._plan(goal, way_out, here, time_s, aim, rng, retry=goal == self.goal)

    def _try_again(self, goal: Goal, time_s: float, aim: Aim, rng: np.random.Generator) -> None:
        self._misses += 1
        retry = self._misses == 1
        way_out = self._back_off(goal) if retry else goal.approach_m
        self._left = goal
        self._plan(goal, way_out, self.tip_m, time_s, aim, rng, retry=retry)

    def _plan(
        self,
        goal: Goal,
        way_out: Vector,
        here: Vector,
        time_s: float,
        aim: Aim,
        rng: np.random.Generator,
        *,
        retry: bool,
    ) -> None:
        self.vision.begin()
        here = v_subtract(here, self.vision.learned_m)
        # A second touch goes straight back in, because the hand is still in front of the surface.
        inside = Goal(goal.kind, goal.effector, goal.target_m, goal.near_m, way_out)
        path = aim.path(
            here,
            (0.0, 0.0, 0.0) if retry else way_out,
            inside if retry else goal,
            time_s,
            rng,
            self._misses,
        )
        left = v_length(way_out) > 0.0 and not retry
        self.out_s = path.moves[0][0] + (_OUT_SHARE * path.moves[0][1] if left else 0.0)
        entering = (2 if left else 1) if v_length(goal.approach_m) > 0.0 else None
        if entering is not None and not retry and entering < len(path.moves):
            path = path.waiting_to_enter(entering, self.out_s + self._settle_s)
        self._path, self.goal = path, goal
        self._noise = aim.noise(path, rng)
        beside_m = v_add(self._noise.at(path.end_s), self.vision.learned_m)
        self.aimed_m = v_add(path.at(path.end_s), beside_m)

    def _back_off(self, goal: Goal) -> Vector:
        length = v_length(goal.approach_m)
        if length < 1e-6:
            return (0.0, 0.0, _BACK_OFF_M)
        return v_scale(goal.approach_m, min(1.0, _BACK_OFF_M / length))

    def _turn(self, step_s: float) -> None:
        """Turn the fingers towards the goal's opening."""
        direction = _FORWARD
        if self.goal is not None and (length := v_length(self.goal.approach_m)) > 1e-6:
            direction = v_scale(self.goal.approach_m, -1.0 / length)
        share = min(1.0, _TURN_RATE * step_s)
        mixed = v_add(v_scale(self.fingers, 1.0 - share), v_scale(direction, share))
        length = v_length(mixed)
        self.fingers = v_scale(mixed, 1.0 / length) if length > 1e-3 else direction
