"""Obstacles and lattices as arrays for the compiled planners."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray
from app.science.walking.scene.shapes import half_planes

IntArray = npt.NDArray[np.int64]
ByteArray = npt.NDArray[np.uint8]
TOUCH_M = 1e-9
"""Depth inside an outline up to which a segment only counts as touching it."""
FREE, BLOCKED, CLOSED, MOVED = 0, 1, 2, 3
"""States of a node: closed ones have been expanded; moved ones are still to be checked."""


class Outlines(NamedTuple):
    """M convex outlines as half planes n . p < d.

    Attributes:
        planes: (M, E, 3) n_x, n_y, d, padded to the longest outline.
        counts: (M,) number of edges of each.
        boxes: (M, 4) left, near, right, far of each.
    """

    planes: FloatArray
    counts: IntArray
    boxes: FloatArray


class Lattice(NamedTuple):
    """Nodes of a search on a square lattice.

    Attributes:
        state: (rows y, columns x) free, blocked or expanded.
        places: (rows, columns, 2) position of each node; at outlines they are off the lattice.
        left, near: regular position of node (0, 0).
        cell_m: distance between nodes.
    """

    state: ByteArray
    places: FloatArray
    left: float
    near: float
    cell_m: float


def outlines_of(corners_m: list[FloatArray]) -> Outlines:
    """Pack outlines, given by their corners, into arrays."""
    most = max((len(corners) for corners in corners_m), default=1)
    planes = np.zeros((len(corners_m), most, 3))
    boxes = np.zeros((len(corners_m), 4))
    for at, corners in enumerate(corners_m):
        planes[at, : len(corners)] = half_planes(corners)
        boxes[at] = [*corners.min(axis=0), *corners.max(axis=0)]
    counts = np.array([len(corners) for corners in corners_m], dtype=np.int64)
    return Outlines(planes, counts, boxes)
