"""Bounded steering parameters and the regular grid over them.

A planner is steered by a vector of numbers, each between bounds. The paper's are maximum velocity,
maximum acceleration, and the slope of the line that limits angular velocity by velocity, each on
ten values from .1 to 2 ("i * .21" in its equations 7 to 9 is the rounded step of 1.9 / 9). The grid
is independent of these three: each follower defines its own parameters.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records.model import WalkingError


@dataclass(frozen=True)
class SteeringParameter:
    """A steering parameter: its name, its unit, and its bounds (low < high)."""

    name: str
    unit: str
    low: float
    high: float

    def __post_init__(self) -> None:
        """Raise WalkingError unless the bounds are finite and in order."""
        if not (np.isfinite([self.low, self.high]).all() and self.low < self.high):
            raise WalkingError(
                f"Parameter {self.name} has bounds {self.low} to {self.high}: give low < high."
            )


@dataclass(frozen=True)
class ParameterGrid:
    """All combinations of a few values of each parameter.

    Attributes:
        parameters: n of them, in the order of a vector's columns.
        values: the increasing values of each parameter, within its bounds; a single value fixes it.
    """

    parameters: tuple[SteeringParameter, ...]
    values: tuple[tuple[float, ...], ...]

    def __post_init__(self) -> None:
        """Raise WalkingError if values are missing, out of bounds or out of order."""
        if len(self.parameters) != len(self.values) or not self.parameters:
            raise WalkingError("A grid needs parameters, and a list of values for each.")
        for parameter, values in zip(self.parameters, self.values, strict=True):
            column = np.array(values)
            inside = len(column) and (column >= parameter.low).all()
            if not inside or (column > parameter.high).any() or (np.diff(column) <= 0.0).any():
                raise WalkingError(
                    f"The grid's values of {parameter.name} must increase and be from"
                    f" {parameter.low} to {parameter.high} {parameter.unit}; they are {values}."
                )

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each parameter: the shape of a map."""
        return tuple(len(values) for values in self.values)

    @property
    def size(self) -> int:
        """Number of combinations of values, K."""
        return int(np.prod(self.shape))

    @cached_property
    def nodes(self) -> FloatArray:
        """All combinations (K, n), the last parameter fastest: `nodes.reshape(*shape, n)`."""
        mesh = np.meshgrid(*(np.array(values) for values in self.values), indexing="ij")
        nodes = np.stack([axis.ravel() for axis in mesh], axis=-1)
        nodes.flags.writeable = False
        return nodes

    def node(self, index: int) -> FloatArray:
        """Return the vector (n,) at a flat index, such as the `argmax` of a map."""
        vector: FloatArray = self.nodes[index]
        return vector


def regular_grid(parameters: tuple[SteeringParameter, ...], count: int = 10) -> ParameterGrid:
    """Make a grid of `count` equally spaced values of each parameter, bounds included."""
    values = tuple(tuple(np.linspace(p.low, p.high, count).tolist()) for p in parameters)
    return ParameterGrid(parameters, values)


VELOCITY = SteeringParameter("velocity", "m/s", 0.1, 2.0)
"""Maximum speed."""
ACCELERATION = SteeringParameter("acceleration", "m/s^2", 0.1, 2.0)
"""Largest rate of change of speed, when accelerating and when braking."""
ANGULAR = SteeringParameter("angular", "1/m", 0.1, 2.0)
"""Angular velocity allowed per metre per second of speed: the largest curvature."""
PAPER_PARAMETERS = (VELOCITY, ACCELERATION, ANGULAR)
PAPER_GRID = regular_grid(PAPER_PARAMETERS)
"""The paper's 10 x 10 x 10 combinations, its equations 6 to 9."""
