"""Plan the path of a movement to a goal: way-points through the open side, scatter, overshoot."""

import math
from dataclasses import dataclass

import numpy as np

from app.science.rotations import Vector, v_add, v_dot, v_length, v_scale, v_subtract
from app.science.simulation.goal import Goal
from app.science.simulation.paths import SmoothPath, path_length, path_through
from app.science.simulation.traits import MovementTraits

_WAYPOINT_SCATTER = 1.5
_LEAST_OVERSHOOT, _MOST_OVERSHOOT = 0.04, 0.12
_NEARLY_THERE_M = 0.02
_CARE, _FURTHER_M = 0.5, 0.02


@dataclass(frozen=True)
class Aim:
    """Plans the movements of one limb of a person.

    Attributes:
        traits: the traits of the person's movement.
        latency_s: delay that the person sees at present, which slows movements.
        tempo: factor on movement times, larger for a foot.
        press_m: distance by which an end point lies beyond a surface, against the approach.
    """

    traits: MovementTraits
    latency_s: float
    tempo: float
    press_m: float

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

        After each miss the person aims more carefully and reaches further in.
        """
        target = goal.target_m or here
        care = _CARE**misses
        end = self._scattered(target, goal, care, rng)
        points = [here]
        if v_length(way_out) > _NEARLY_THERE_M:
            points.append(v_add(here, way_out))
        if v_length(goal.approach_m) > _NEARLY_THERE_M:
            front = v_add(target, goal.approach_m)
            points.append(self._scattered(front, goal, _WAYPOINT_SCATTER * care, rng))
            further = misses * _FURTHER_M / v_length(goal.approach_m)
            press = self._press(goal, rng) + further
            end = v_subtract(end, v_scale(goal.approach_m, press))
        lasts_s = self.tempo * self.traits.movement_time(
            path_length([*points, end]), goal.near_m, self.latency_s, rng
        )
        if rng.random() < self.traits.overshoot_probability:
            return self._overshooting(points, end, start_s, lasts_s, rng)
        return path_through([*points, end], start_s, lasts_s)

    def _press(self, goal: Goal, rng: np.random.Generator) -> float:
        """Return how far to press beyond the surface, as a share of the approach."""
        depth = self.press_m * (1.0 + 0.5 * abs(rng.standard_normal()))
        return depth / v_length(goal.approach_m)

    def _scattered(
        self, point: Vector, goal: Goal, factor: float, rng: np.random.Generator
    ) -> Vector:
        """Scatter a point across the approach, or in the floor plane if there is no approach."""
        sigma = factor * self.traits.scatter_m(goal.near_m)
        dx, dy, dz = (sigma * rng.standard_normal(3)).tolist()
        axis = goal.approach_m if v_length(goal.approach_m) > 1e-9 else (0.0, 1.0, 0.0)
        along = v_dot((dx, dy, dz), axis) / v_dot(axis, axis)
        return v_add(point, v_subtract((dx, dy, dz), v_scale(axis, along)))

    def _overshooting(
        self,
        points: list[Vector],
        end: Vector,
        start_s: float,
        lasts_s: float,
        rng: np.random.Generator,
    ) -> SmoothPath:
        """Plan a path that goes too far along its longest leg and is corrected shortly after."""
        legs = [v_subtract(b, a) for a, b in zip(points, [*points[1:], end], strict=True)]
        longest = max(range(len(legs)), key=lambda leg: v_length(legs[leg]))
        share = rng.uniform(_LEAST_OVERSHOOT, _MOST_OVERSHOOT)
        too_far = v_scale(legs[longest], share)
        stops = [*points, end]
        # The later points shift as well, because the person has not noticed the error yet.
        carried = [v_add(p, too_far) if i > longest else p for i, p in enumerate(stops)]
        path = path_through(carried, start_s, lasts_s)
        back = v_scale(too_far, -1.0)
        correct_s = 0.1 + 0.1 * math.sqrt(v_length(too_far))
        correction = (path.end_s + self.traits.correction_s, correct_s, back)
        return SmoothPath(path.start_m, (*path.moves, correction))
