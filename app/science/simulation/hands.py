"""One hand on its way to its goals: react, leave, go, enter, hold; and try again."""

from math import inf

import numpy as np

from app.science.rotations import Vector, v_add, v_length, v_scale
from app.science.simulation.aiming import Aim
from app.science.simulation.goal import Goal
from app.science.simulation.paths import SmoothPath, minimum_jerk

_ENGAGE_S = 0.45
_BACK_OFF_M = 0.08
# Share of the time of the way out after which hand and wrist are past the edges.
_OUT_SHARE = 0.6
_FORWARD: Vector = (0.0, 0.0, -1.0)
_TURN_RATE = 6.0


class Hand:
    """Where the finger tip should be, and how much the hand is at work at all.

    A hand that is not asked for hangs with the base movement (work 0); asked for, it takes
    `_ENGAGE_S` to leave it (work 1). A touch counts only when it begins anew, so a hand whose goal
    has not changed after the person's patience backs off and touches once more. If that was not it
    either, as when the body that follows hangs at an edge, it leaves altogether and comes in anew.
    """

    def __init__(self) -> None:
        self.goal: Goal | None = None
        self.tip_m: Vector = (0.0, 0.0, 0.0)
        self.fingers: Vector = _FORWARD
        self.aimed_m: Vector | None = None
        self._path: SmoothPath | None = None
        self._wanted: Goal | None = None
        self._react_s = self._settle_s = 0.0
        self._work = 0.0
        self._misses = 0
        #: When the hand is (or was) out of what it was in; endless while that is not known.
        self.out_s = inf

    @property
    def work(self) -> float:
        """Share of the arm that follows the goal, 0 to 1, smooth."""
        return minimum_jerk(self._work)

    @property
    def idle(self) -> bool:
        """Whether the arm hangs and nothing has to be planned from where it is."""
        return self._work == 0.0 and self._wanted is None

    def ask(
        self, goal: Goal | None, time_s: float, reaction_s: float, settle_s: float = 0.0
    ) -> None:
        """Take a new goal, or None to let the arm hang again; it is acted on after reacting.

        The hand waits in front of the goal until the body has had `settle_s` to follow.
        """
        self._wanted, self._react_s, self._settle_s = goal, time_s + reaction_s, settle_s
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
        """Go on by one frame; `tip_now_m` is where the tip is, needed when the arm was hanging."""
        if self._wanted is not None and time_s >= self._react_s:
            self._set_off(time_s, tip_now_m, aim, rng)
        elif self.goal is not None and self._path is not None:
            patience_s = aim.traits.patience_s + aim.latency_s
            if time_s > self._path.end_s + patience_s:
                self._try_again(self.goal, time_s, aim, rng)
        if self._path is not None:
            self.tip_m = self._path.at(time_s)
        change = step_s / _ENGAGE_S
        self._work = min(1.0, self._work + change) if self.goal else max(0.0, self._work - change)
        self._turn(step_s)

    def _set_off(
        self, time_s: float, tip_now_m: Vector | None, aim: Aim, rng: np.random.Generator
    ) -> None:
        goal, self._wanted = self._wanted, None
        if goal is None:
            return
        way_out: Vector = (0.0, 0.0, 0.0)
        if self._work == 0.0 and tip_now_m is not None:
            self.tip_m = tip_now_m
        elif self.goal is not None:
            way_out = self.goal.approach_m
        self._misses = 0
        self._plan(goal, way_out, time_s, aim, rng, again=goal == self.goal)

    def _try_again(self, goal: Goal, time_s: float, aim: Aim, rng: np.random.Generator) -> None:
        self._misses += 1
        again = self._misses == 1
        way_out = self._back_off(goal) if again else goal.approach_m
        self._plan(goal, way_out, time_s, aim, rng, again=again)

    def _plan(
        self,
        goal: Goal,
        way_out: Vector,
        time_s: float,
        aim: Aim,
        rng: np.random.Generator,
        *,
        again: bool,
    ) -> None:
        # A second touch goes straight back in: the hand is in front of its surface already.
        inside = Goal(goal.kind, goal.effector, goal.target_m, goal.near_m, way_out)
        path = aim.path(
            self.tip_m,
            (0.0, 0.0, 0.0) if again else way_out,
            inside if again else goal,
            time_s,
            rng,
            self._misses,
        )
        left = v_length(way_out) > 0.0 and not again
        self.out_s = path.moves[0][0] + (_OUT_SHARE * path.moves[0][1] if left else 0.0)
        entering = (2 if left else 1) if v_length(goal.approach_m) > 0.0 else None
        if entering is not None and not again and entering < len(path.moves):
            path = path.waiting_to_enter(entering, self.out_s + self._settle_s)
        self._path, self.goal, self.aimed_m = path, goal, path.at(path.end_s)

    def _back_off(self, goal: Goal) -> Vector:
        length = v_length(goal.approach_m)
        if length < 1e-6:
            return (0.0, 0.0, _BACK_OFF_M)
        return v_scale(goal.approach_m, min(1.0, _BACK_OFF_M / length))

    def _turn(self, step_s: float) -> None:
        """Let the fingers point into the goal's opening."""
        wanted = _FORWARD
        if self.goal is not None and (length := v_length(self.goal.approach_m)) > 1e-6:
            wanted = v_scale(self.goal.approach_m, -1.0 / length)
        share = min(1.0, _TURN_RATE * step_s)
        mixed = v_add(v_scale(self.fingers, 1.0 - share), v_scale(wanted, share))
        length = v_length(mixed)
        self.fingers = v_scale(mixed, 1.0 / length) if length > 1e-3 else wanted
