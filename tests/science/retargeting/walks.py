"""The generated walk, under the names that the tests of retargeting use."""

from app.science.retargeting.generated_walk import (
    DOUBLE_S,
    STAND_S,
    SWING_S,
    GeneratedWalk,
    generated_walk,
)
from app.science.retargeting.generated_walk import WALK_RATE_HZ as RATE_HZ
from app.science.retargeting.legs import Legs, legs_of
from app.science.rig import Rig
from tests.science.retargeting.bodies import SAME

__all__ = ["DOUBLE_S", "RATE_HZ", "STAND_S", "SWING_S", "made_walk", "mapped"]


def made_walk(
    rig: Rig, *, step_m: float = 0.6, steps: int = 4, height_m: float = 0.12
) -> GeneratedWalk:
    """Return a walk of `steps` steps of `step_m` that ends with closed feet."""
    return generated_walk(rig, step_m=step_m, steps=steps, height_m=height_m)


def mapped(rig: Rig) -> Legs:
    """Return the mapped legs of a rig whose joints are named like the body's."""
    return legs_of(rig, SAME)
