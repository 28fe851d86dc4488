"""Maps of deviation over the parameter grid, and their conversion to suitability.

A `DeviationMap` is the result of the simulation: for each combination its deviation from the
reference and its travel time. It is stored. A `SuitabilityMap`, higher is better, is one reading of
it:

    s = 1 - m / max(m)                        the paper's
    s = (max(m) - m) / (max(m) - min(m))      min-max: the best combination always has 1
    s = s * exp(-|T - T_ref| / tau)           time-aware, 0 for agents that did not arrive
    s = s^p,  0 where s < threshold           to suppress combinations that are barely suitable

Readings are fast to compute, so that they can be chosen by validation without simulating again.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import BoolArray, ParameterGrid, WalkingError

TIME_CONSTANT_S = 0.1
"""Time constant tau of the time-aware reading."""


@dataclass(frozen=True)
class SuitabilityOptions:
    """Options for converting deviations to suitability; the defaults are the paper's.

    Attributes:
        normalisation: whether to normalise by the largest deviation, or between smallest and
            largest.
        power: the exponent p > 0 applied to the result.
        threshold: suitability below it counts as 0, in [0, 1).
        time_constant_s: tau, None to ignore travel time.
    """

    normalisation: Literal["max", "min-max"] = "max"
    power: float = 1.0
    threshold: float = 0.0
    time_constant_s: float | None = None

    def __post_init__(self) -> None:
        """Raise WalkingError if a value is out of its range."""
        if not 0.0 < self.power < np.inf:
            raise WalkingError(f"The power is {self.power}; it must be positive.")
        if not 0.0 <= self.threshold < 1.0:
            raise WalkingError(f"The threshold is {self.threshold}; it must be in [0, 1).")
        if self.time_constant_s is not None and not 0.0 < self.time_constant_s < np.inf:
            raise WalkingError(
                f"The time constant is {self.time_constant_s} s; it must be positive."
            )


PAPER = SuitabilityOptions()
TIME_AWARE = SuitabilityOptions(time_constant_s=TIME_CONSTANT_S)


@dataclass(frozen=True, eq=False)
class DeviationMap:
    """Deviations and travel times of all combinations for one walk.

    Attributes:
        grid: the combinations.
        metric: name of the measure.
        deviations: `grid.shape`, non-negative and finite.
        arrival_s: `grid.shape`, travel times, NaN where an agent did not arrive.
        reference_s: travel time of the walk itself.
    """

    grid: ParameterGrid
    metric: str
    deviations: FloatArray
    arrival_s: FloatArray
    reference_s: float

    def __post_init__(self) -> None:
        """Raise WalkingError if shapes differ, or a deviation is negative or not finite."""
        if self.deviations.shape != self.grid.shape or self.arrival_s.shape != self.grid.shape:
            raise WalkingError(
                f"A map over a grid {self.grid.shape} cannot have deviations"
                f" {self.deviations.shape} and arrivals {self.arrival_s.shape}."
            )
        if not (np.isfinite(self.deviations).all() and (self.deviations >= 0.0).all()):
            raise WalkingError(
                f"Metric {self.metric} gave deviations that are negative or not finite."
            )

    @cached_property
    def arrived(self) -> BoolArray:
        """Whether each agent reached the goal in time, in `grid.shape`."""
        return np.isfinite(self.arrival_s)

    def read(self, options: SuitabilityOptions = PAPER) -> "SuitabilityMap":
        """Convert the deviations to suitability."""
        worst, best = float(self.deviations.max()), float(self.deviations.min())
        floor = best if options.normalisation == "min-max" else 0.0
        span = worst - floor
        # If all combinations deviate equally, none is better than another.
        values = (worst - self.deviations) / span if span > 0.0 else np.ones(self.grid.shape)
        if options.time_constant_s is not None:
            late_s = np.abs(np.where(self.arrived, self.arrival_s, np.inf) - self.reference_s)
            values = values * np.exp(-late_s / options.time_constant_s)
        values = np.clip(values, 0.0, 1.0) ** options.power
        values[values < options.threshold] = 0.0
        return SuitabilityMap(self.grid, values, self.arrival_s, self.arrived)


@dataclass(frozen=True, eq=False)
class SuitabilityMap:
    """The suitability of each combination of parameters: how well it reproduces a walk.

    Attributes:
        grid: the combinations.
        values: `grid.shape`, from 0 (unsuitable) to 1.
        arrival_s: `grid.shape`, travel times, NaN where an agent did not arrive.
        arrived: `grid.shape`.
    """

    grid: ParameterGrid
    values: FloatArray
    arrival_s: FloatArray
    arrived: BoolArray

    @cached_property
    def best(self) -> FloatArray:
        """The most suitable combination (n,); of ties the one with the largest last parameters.

        On a straight walk the angular velocity has no effect: the tie goes to the largest.
        """
        backwards = self.values.ravel()[::-1]
        return self.grid.node(self.grid.size - 1 - int(np.argmax(backwards)))
