"""Plan the path of a movement to a goal, through the open side, and the noise of doing it."""

import math
from dataclasses import dataclass

import numpy as np

from app.science.rotations import Vector, v_add, v_length, v_scale, v_subtract
from app.science.simulation.goal import Goal
from app.science.simulation.paths import SmoothPath, path_length, path_through
from app.science.simulation.traits import MovementTraits, ReachingPerson, shortest_time_s

_NEARLY_THERE_M = 0.02
_FURTHER_M = 0.02
_ACROSS_SHARE = 0.5
"""Ends scatter about half as widely across a movement as along it."""


@dataclass(frozen=True)
class Aim:
    """Plans the movements of one limb of a person.

    Attributes:
        traits: the traits of the person's movement.
        tempo: factor on movement times, larger for a foot.
        press_m: distance by which an end point lies beyond a surface, against the approach.
        reaching: how the limb moves if that was learnt from recordings; None for the traits.
    """

    traits: MovementTraits
    tempo: float
    press_m: float
    reaching: ReachingPerson | None = None

    def path(
        self,
        here: Vector,
        way_out: Vector,
        goal: Goal,
        start_s: float,
        rng: np.random.Generator,
        misses: int = 0,
    ) -> SmoothPath:
        """Plan a path that leaves by `way_out`, goes to the front of the goal, and enters it.

        After each miss the person reaches further in.
        """
        end = goal.target_m or here
        points = [here]
        if v_length(way_out) > _NEARLY_THERE_M:
            points.append(v_add(here, way_out))
        if v_length(goal.approach_m) > _NEARLY_THERE_M:
            points.append(v_add(end, goal.approach_m))
            further = misses * _FURTHER_M / v_length(goal.approach_m)
            end = v_subtract(end, v_scale(goal.approach_m, self._press(goal, rng) + further))
        way_m = path_length([*points, end])
        if self.reaching is None:
            lasts_s = self.tempo * self.traits.movement_time(way_m, goal.near_m, rng)
            return path_through([*points, end], start_s, lasts_s)
        drawn_s, skew = self.reaching.movement(way_m, goal.near_m, rng)
        lasts_s = self.tempo * max(drawn_s, shortest_time_s(way_m))
        return path_through([*points, end], start_s, lasts_s, skew)

    def noise(self, path: SmoothPath, rng: np.random.Generator) -> SmoothPath:
        """Draw the noise of a path's movements: each ends a little beside its plan."""
        moves = []
        for begins, lasts, way in path.moves:
            length = v_length(way)
            sigma = self.traits.scatter_m(length, lasts)
            dx, dy, dz = (_ACROSS_SHARE * sigma * rng.standard_normal(3)).tolist()
            along = math.sqrt(1.0 - _ACROSS_SHARE**2) * sigma * float(rng.standard_normal())
            ahead = v_scale(way, along / length) if length > 0.0 else way
            moves.append((begins, lasts, v_add((dx, dy, dz), ahead)))
        return SmoothPath((0.0, 0.0, 0.0), tuple(moves), path.skew)

    def _press(self, goal: Goal, rng: np.random.Generator) -> float:
        """Return how far to press beyond the surface, as a share of the approach."""
        depth = self.press_m * (1.0 + 0.5 * abs(rng.standard_normal()))
        return depth / v_length(goal.approach_m)
