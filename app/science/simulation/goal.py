"""The goals that a task sets for the simulated participant."""

import math
from dataclasses import dataclass
from enum import StrEnum

from app.science.rotations import Vector

_HANDS = ("LeftHand", "RightHand")
_FEET = ("LeftFoot", "RightFoot")


class SimulationError(ValueError):
    """An argument of the simulation is not valid."""


class GoalKind(StrEnum):
    """The kinds of goal: touch with a hand, step with a foot, walk to a place, or stand at rest."""

    REACH = "reach"
    STEP = "step"
    WALK_TO = "walk_to"
    REST = "rest"


@dataclass(frozen=True)
class Goal:
    """One goal of the simulated participant; a goal equal to the previous one is the same goal.

    Attributes:
        kind: the kind of action.
        effector: "LeftHand" or "RightHand" to reach, "LeftFoot" or "RightFoot" to step; else None.
        target_m: world point for the finger tip, for the middle of the sole, or on the floor for
            the middle of the body; None to rest.
        near_m: half width of the object to hit: it determines pace and scatter.
        approach_m: vector from the target out through the open side, as long as the way out is: +z
            out of a hand box, +y out of a foot box. It is the way in and, at the next goal, the way
            out. For walking only its height is used, to lift the feet over edges.
    """

    kind: GoalKind
    effector: str | None = None
    target_m: Vector | None = None
    near_m: float = 0.05
    approach_m: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        """Raise SimulationError for a goal whose attributes do not fit together."""
        valid = {GoalKind.REACH: _HANDS, GoalKind.STEP: _FEET}.get(self.kind, (None,))
        if self.effector not in valid:
            raise SimulationError(
                f"A goal to {self.kind} cannot use {self.effector!r}: valid are {valid}."
            )
        if (self.target_m is None) != (self.kind is GoalKind.REST):
            raise SimulationError(f"A goal to {self.kind} and target {self.target_m} do not fit.")
        numbers = (*(self.target_m or ()), *self.approach_m, self.near_m)
        if not all(math.isfinite(number) for number in numbers) or self.near_m <= 0.0:
            raise SimulationError(
                f"Goal numbers must be finite and near_m above zero, got {numbers}."
            )
