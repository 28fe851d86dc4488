"""The three models of how a person steers, with a common interface.

    P_stat   one combination for everybody and every path
    P_adapt  the most suitable combination for this path and person
    P_prob   a draw from all combinations, with probability proportional to suitability

The first is the paper's state of the art and the second an intermediate step; all use the same
data.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps import BlendingSpace, axes_of, radial_basis
from app.science.walking.models.sampling import Density, Interpolation, MixtureSampler, density_of
from app.science.walking.records import BoolArray

_HALVINGS, _LEVEL = 12, 1e-3


class SteeringModel(Protocol):
    """Protocol of a model that gives steering parameters for a future walk."""

    @property
    def name(self) -> str:
        """Short key of the model."""
        ...

    @property
    def draws(self) -> bool:
        """Whether vectors are random draws, which differ from each other."""
        ...

    def vectors(
        self, dependencies: Mapping[str, float], count: int, rng: np.random.Generator
    ) -> FloatArray:
        """Return vectors (count, n); a model that does not draw returns the best ones, best first.

        Raises:
            WalkingError: a dependency is missing.
        """
        ...


@dataclass(frozen=True, eq=False)
class StaticModel:
    """P_stat: the same vector for every walk."""

    vector: FloatArray
    name: str = "stat"
    draws: bool = False

    def vectors(
        self, dependencies: Mapping[str, float], count: int, rng: np.random.Generator
    ) -> FloatArray:
        """Return the constant vector, `count` times."""
        del dependencies, rng
        return np.tile(self.vector, (count, 1))


@dataclass(frozen=True, eq=False)
class AdaptiveModel:
    """P_adapt: the maximum of the blended map, interpolated by radial basis functions."""

    space: BlendingSpace
    name: str = "adapt"
    draws: bool = False

    def vectors(
        self, dependencies: Mapping[str, float], count: int, rng: np.random.Generator
    ) -> FloatArray:
        """Return the most suitable vector for these dependencies, then the next best nodes."""
        del rng
        space = self.space
        density = density_of(space, space.scaling.z(space.scaling.vector(dependencies)), "radial")
        # Reversed, so that of equal nodes the one with the largest last parameters is first.
        order = np.argsort(-density.grid_values[::-1], kind="stable")[: max(1, count - 1)]
        nodes = space.grid.nodes[space.grid.size - 1 - order]
        best = self._uphill(density, nodes[0].copy())
        found: FloatArray = np.concatenate([best[None], nodes])[:count]
        return found

    def _uphill(self, density: Density, at: FloatArray) -> FloatArray:
        """Climb from a node to a maximum; steps of half a cell are halved where none leads up.

        Along an axis on which the map is constant the value stays unchanged, since there only the
        interpolation's own ripples lead up: on a straight walk the angular velocity is the largest.
        """
        grid = self.space.grid
        basis = radial_basis(grid)
        low = np.array([values[0] for values in grid.values])
        high = np.array([values[-1] for values in grid.values])
        steps = np.diag((high - low) / np.maximum(1, 2 * (axes_of(grid).shape - 1)))
        steps = steps[~_level(density.grid_values.reshape(grid.shape))]
        if not len(steps):
            return at
        value = float(basis.at(density.coefficients, at[None])[0])
        for _ in range(_HALVINGS):
            while True:
                trials = np.clip(np.concatenate([at + steps, at - steps]), low, high)
                found = basis.at(density.coefficients, trials)
                if not found.max() > value * (1.0 + 1e-9):
                    break
                at, value = trials[int(np.argmax(found))], float(found.max())
            steps = steps / 2.0
        return at


def _level(values: FloatArray) -> BoolArray:
    """Return for each axis whether the map is constant along it, through its highest node."""
    best = np.unravel_index(int(np.argmax(values)), values.shape)
    level = []
    for axis in range(values.ndim):
        line = values[tuple(slice(None) if at == axis else i for at, i in enumerate(best))]
        level.append(float(np.ptp(line)) <= _LEVEL * float(values[best]))
    return np.array(level)


@dataclass(frozen=True, eq=False)
class ProbabilisticModel:
    """P_prob: draws from the blended map.

    Attributes:
        space: the blending space of the maps.
        sampler: mixture, or the paper's rejection.
        interpolation: the interpolation used for rejection; the mixture is always multilinear.
    """

    space: BlendingSpace
    sampler: Literal["mixture", "rejection"] = "mixture"
    interpolation: Interpolation = "radial"
    name: str = "prob"
    draws: bool = True

    def vectors(
        self, dependencies: Mapping[str, float], count: int, rng: np.random.Generator
    ) -> FloatArray:
        """Draw vectors for these dependencies; reproducible by the rng's seed."""
        z = self.space.scaling.z(self.space.scaling.vector(dependencies))
        if self.sampler == "rejection":
            return density_of(self.space, z, self.interpolation).draw_by_rejection(count, rng)
        if count == 1:
            return MixtureSampler(self.space).draw_one(z, rng)[None]
        return density_of(self.space, z).draw(count, rng)
