"""The ground an avatar walks on: its height as a function of the position.

A capture's floor is flat; an avatar's world seldom is. Degen et al. (2022) use the height of the
ground under the avatar while it moves, and so does this package: any object with `height_m` is a
ground. Coordinates are the world's, y up: x and z are horizontal, metres. Heights are metres too.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray


class GroundError(ValueError):
    """The ground's parameters are invalid, such as a ramp without a length."""


class Ground(Protocol):
    """Protocol of a ground: it has a height at every position."""

    def height_m(self, x_m: FloatArray, z_m: FloatArray) -> FloatArray:
        """Return the height at (x, z); both are broadcast, and the result has the common shape."""


@dataclass(frozen=True)
class Flat:
    """Flat ground: the same height everywhere."""

    level_m: float = 0.0

    def height_m(self, x_m: npt.ArrayLike, z_m: npt.ArrayLike) -> FloatArray:
        """Return the height at (x, z); see `Ground`."""
        shape = np.broadcast_shapes(np.shape(x_m), np.shape(z_m))
        return np.full(shape, self.level_m)


@dataclass(frozen=True)
class Ramp:
    """A ramp: level before its start, a constant slope over `run_m`, then level again.

    With s the distance from `start_m` (x, z) along the horizontal direction `uphill` (x, z),
    height = rise_m * clip(s / run_m, 0, 1).
    """

    start_m: tuple[float, float]
    uphill: tuple[float, float]
    run_m: float
    rise_m: float

    def __post_init__(self) -> None:
        """Raise GroundError if the ramp has no length or no direction."""
        if not self.run_m > 0.0:
            raise GroundError(f"A ramp's run of {self.run_m} m is invalid: it must be above zero.")
        _unit(self.uphill)

    def height_m(self, x_m: npt.ArrayLike, z_m: npt.ArrayLike) -> FloatArray:
        """Return the height at (x, z); see `Ground`."""
        along = _along(x_m, z_m, self.start_m, self.uphill)
        return np.asarray(self.rise_m * np.clip(along / self.run_m, 0.0, 1.0))


@dataclass(frozen=True)
class Steps:
    """A flight of steps; with a single edge, a kerb.

    With s the distance from `start_m` (x, z) along `uphill` (x, z), the height is the sum of the
    `rises_m` whose edge in `edges_m` has been passed: s >= edge. Negative rises go down.
    """

    start_m: tuple[float, float]
    uphill: tuple[float, float]
    edges_m: tuple[float, ...]
    rises_m: tuple[float, ...]

    def __post_init__(self) -> None:
        """Raise GroundError unless each edge has a rise and the edges are in ascending order."""
        if len(self.edges_m) != len(self.rises_m) or not self.edges_m:
            raise GroundError(
                f"{len(self.edges_m)} edges and {len(self.rises_m)} rises: give each edge one rise."
            )
        if list(self.edges_m) != sorted(self.edges_m):
            raise GroundError(f"Edges at {self.edges_m} m are out of order: list them uphill.")
        _unit(self.uphill)

    def height_m(self, x_m: npt.ArrayLike, z_m: npt.ArrayLike) -> FloatArray:
        """Return the height at (x, z); see `Ground`."""
        along = _along(x_m, z_m, self.start_m, self.uphill)
        heights = np.concatenate(([0.0], np.cumsum(self.rises_m)))
        return np.asarray(heights[np.searchsorted(self.edges_m, along, side="right")])


@dataclass(frozen=True, eq=False)
class Grid:
    """Heights measured at the corners of square cells, interpolated bilinearly in between.

    Beyond the grid the height of the nearest corner or edge continues.

    Attributes:
        corner_m: position (x, z) of heights_m[0, 0].
        cell_m: side of a cell.
        heights_m: (X, Z), row i at x = corner + i cell, column j at z = corner + j cell.
    """

    corner_m: tuple[float, float]
    cell_m: float
    heights_m: FloatArray

    def __post_init__(self) -> None:
        """Raise GroundError if there is no cell, or a height is missing."""
        if self.heights_m.ndim != 2 or min(self.heights_m.shape) < 2 or not self.cell_m > 0.0:
            raise GroundError(
                f"Heights {self.heights_m.shape} in cells of {self.cell_m} m are not a grid: give"
                " (X, Z) with at least two rows and columns, and a cell above zero."
            )
        if not np.isfinite(self.heights_m).all():
            raise GroundError("Every height of a grid must be finite: fill the gaps first.")

    def height_m(self, x_m: npt.ArrayLike, z_m: npt.ArrayLike) -> FloatArray:
        """Return the height at (x, z); see `Ground`."""
        rows, columns = self.heights_m.shape
        i, u = _cell(np.asarray(x_m, dtype=np.float64), self.corner_m[0], self.cell_m, rows)
        j, v = _cell(np.asarray(z_m, dtype=np.float64), self.corner_m[1], self.cell_m, columns)
        h = self.heights_m
        near = h[i, j] * (1.0 - v) + h[i, j + 1] * v
        far = h[i + 1, j] * (1.0 - v) + h[i + 1, j + 1] * v
        return np.asarray(near * (1.0 - u) + far * u)


def _cell(
    place_m: FloatArray, corner_m: float, cell_m: float, count: int
) -> tuple[npt.NDArray[np.intp], FloatArray]:
    """Return the index of the cell along one axis, and the position within it, 0 to 1."""
    where = np.clip((place_m - corner_m) / cell_m, 0.0, count - 1.0)
    index = np.minimum(where.astype(np.intp), count - 2)
    return index, where - index


def _along(
    x_m: npt.ArrayLike,
    z_m: npt.ArrayLike,
    start_m: tuple[float, float],
    direction: tuple[float, float],
) -> FloatArray:
    x, z = _unit(direction)
    across = (np.asarray(x_m, dtype=np.float64) - start_m[0]) * x
    return np.asarray(across + (np.asarray(z_m, dtype=np.float64) - start_m[1]) * z)


def _unit(direction: tuple[float, float]) -> tuple[float, float]:
    length = float(np.hypot(*direction))
    if not (np.isfinite(length) and length > 0.0):
        raise GroundError(f"{direction} is not a direction: give a finite (x, z) other than zero.")
    return direction[0] / length, direction[1] / length
