"""Obstacles and grids in the form that compiled planners take."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray
from app.science.walking.scene.shapes import half_planes

IntArray = npt.NDArray[np.int64]
ByteArray = npt.NDArray[np.uint8]
TOUCH_M = 1e-9
"""How deep a segment may go into an outline and still count as touching it."""
FREE, BLOCKED, CLOSED, MOVED = 0, 1, 2, 3
"""States of a node: expanded ones are closed; moved ones still have to be checked."""


class Outlines(NamedTuple):
    """M convex outlines as half planes n . p < d.

    Attributes:
        planes: (M, E, 3) n_x, n_y, d, padded to the longest outline.
        counts: (M,) how many edges each has.
        boxes: (M, 4) left, near, right, far of each.
    """

    planes: FloatArray
    counts: IntArray
    boxes: FloatArray


class Lattice(NamedTuple):
    """Nodes of a search on a square lattice.

    Attributes:
        state: (rows y, columns x) free, blocked or expanded.
        places: (rows, columns, 2) where each node is; at outlines they are off the lattice.
        left, near: where node (0, 0) would be.
        cell_m: how far apart nodes are.
    """

    state: ByteArray
    places: FloatArray
    left: float
    near: float
    cell_m: float


def outlines_of(corners_m: list[FloatArray]) -> Outlines:
    """Pack outlines given by their corners."""
    most = max((len(corners) for corners in corners_m), default=1)
    planes = np.zeros((len(corners_m), most, 3))
    boxes = np.zeros((len(corners_m), 4))
    for at, corners in enumerate(corners_m):
        planes[at, : len(corners)] = half_planes(corners)
        boxes[at] = [*corners.min(axis=0), *corners.max(axis=0)]
    counts = np.array([len(corners) for corners in corners_m], dtype=np.int64)
    return Outlines(planes, counts, boxes)
