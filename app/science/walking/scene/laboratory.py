"""The scenes in which the paper's database was captured: a straight line, and around a pole.

Eight straight distances from .5 to 4 m, and turns of 45 to 180 degrees around a pole, over 3 m and
4 m. The paper does not draw these scenes to scale. Here start and goal are each half the distance
from the pole, offset to the side so that a person passes it at the clearance; a thin wall from the
pole to the inside of the turn keeps planners from the short cut that people were told not to take.
"""

import math

from app.science.walking.records import Point, WalkingError
from app.science.walking.scene.scene import CLEARANCE_M, Obstacle, Scene, ScenePath
from app.science.walking.scene.shapes import disc_corners, wall_corners

STRAIGHT_M = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)
POLE_M = (3.0, 4.0)
POLE_DEG = (45.0, 90.0, 135.0, 180.0)
POLE_RADIUS_M, WALL_M, ASIDE_M, MARGIN_M = 0.05, 0.02, 0.05, 1.0


def straight_scene(length_m: float) -> Scene:
    """Make the scene of a straight walk ahead, from the origin."""
    if not 0.05 < length_m <= 500.0:
        raise WalkingError(f"A straight walk of {length_m} m is invalid: give 0.05 to 500 m.")
    places: dict[str, Point] = {"start": (0.0, 0.0), "goal": (0.0, length_m)}
    bounds = (-MARGIN_M, -MARGIN_M, MARGIN_M, length_m + MARGIN_M)
    path = ScenePath("there", "start", "goal")
    return Scene(f"straight {length_m:g} m", bounds, places=places, paths=(path,))


def pole_scene(turned_deg: float, distance_m: float, clearance_m: float = CLEARANCE_M) -> Scene:
    """Make the scene of a walk around a pole at the origin, turning to the left.

    Args:
        turned_deg: the angle by which the walk turns, 5 to 180.
        distance_m: distance from the start past the pole to the goal.
        clearance_m: the clearance of the scene.
    """
    if not (5.0 <= turned_deg <= 180.0 and 1.0 <= distance_m <= 100.0):
        raise WalkingError(
            f"No walk of {distance_m} m turns {turned_deg} degrees around a pole here:"
            " give 1 to 100 m and 5 to 180 degrees."
        )
    turn, half_m = math.radians(turned_deg), distance_m / 2.0
    aside_m = POLE_RADIUS_M + clearance_m + ASIDE_M
    goal = (
        -half_m * math.sin(turn) + aside_m * math.cos(turn),
        half_m * math.cos(turn) + aside_m * math.sin(turn),
    )
    places: dict[str, Point] = {"start": (aside_m, -half_m), "goal": goal}
    reach_m = half_m + MARGIN_M
    # The wall extends out of bounds, so that there is no path around its far end.
    inner = (-2.0 * reach_m * math.cos(turn / 2.0), -2.0 * reach_m * math.sin(turn / 2.0))
    obstacles = (
        Obstacle("pole", disc_corners((0.0, 0.0), POLE_RADIUS_M)),
        Obstacle("inner wall", wall_corners((0.0, 0.0), inner, WALL_M)),
    )
    return Scene(
        f"pole {turned_deg:g} degrees {distance_m:g} m",
        (-reach_m, -reach_m, reach_m, reach_m),
        obstacles,
        places,
        (ScenePath("round", "start", "goal"),),
        clearance_m,
    )
