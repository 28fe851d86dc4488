"""Reach with the hand that one sees.

A body with other proportions than the participant's copies their angles, so its hand is beside
theirs. People look at the hand of the body and correct for that; so does the scripted participant,
once a reach has had no effect for a while. What they have learned holds for the reaches after it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from app.science.rotations import Vector
from app.science.simulation import Goal, GoalKind

PATIENCE_S = 1.5
"""How long a reach has no effect before its end is corrected, in addition to twice the latency."""
LEAST_M, MOST_M = 0.03, 0.4
"""The offsets that are corrected: smaller ones do no harm, larger ones are no arm's."""


@dataclass
class Sight:
    """What the participant has learned about where the body's hand is.

    `seen_m`: from the finger tip of the body to the participant's own.
    """

    seen_m: Vector = (0.0, 0.0, 0.0)
    _goal: Goal | None = None
    _since_s: float = 0.0

    def corrected(
        self, goal: Goal | None, t_s: float, latency_s: float, look: Callable[[], Vector]
    ) -> Goal | None:
        """Return the goal for the participant's own hand; other goals are returned unchanged.

        `look` measures the offset in the present pose.
        """
        if goal is None or goal.kind is not GoalKind.REACH:
            self._goal = None
            return goal
        if goal != self._goal:
            self._goal, self._since_s = goal, t_s
        elif t_s - self._since_s > PATIENCE_S + 2.0 * latency_s:
            self._since_s = t_s
            seen_m = look()
            if LEAST_M < math.hypot(*seen_m) < MOST_M:
                self.seen_m = seen_m
        if self.seen_m == (0.0, 0.0, 0.0):
            return goal
        x, y, z = (at + off for at, off in zip(goal.target_m or (), self.seen_m, strict=True))
        return replace(goal, target_m=(x, y, z))
