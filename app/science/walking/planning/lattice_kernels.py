"""Mark the nodes of a lattice that obstacles block, compiled; see `outlines` for the data types."""

import numpy as np

from app.science.compiled import compiled
from app.science.rotations import FloatArray
from app.science.walking.scene import BLOCKED, FREE, MOVED, TOUCH_M, Lattice, Outlines

EDGE_CELLS = 0.75
"""Nodes less deep inside an outline than this are moved onto it."""


@compiled
def _depth(x: float, y: float, planes: FloatArray, count: int) -> tuple[float, int]:
    """Return how deep a point is inside an outline (negative outside), and the nearest edge."""
    depth, nearest = np.inf, 0
    for edge in range(count):
        own = planes[edge, 2] - planes[edge, 0] * x - planes[edge, 1] * y
        if own < depth:
            depth, nearest = own, edge
    return depth, nearest


@compiled
def _block_one(lattice: Lattice, planes: FloatArray, count: int, box: FloatArray) -> None:
    """Block the nodes inside one outline; move those close to its edge onto the edge."""
    state, places, cell_m = lattice.state, lattice.places, lattice.cell_m
    rows, columns = state.shape
    left, near = lattice.left, lattice.near
    for row in range(max(0, int((box[1] - near) / cell_m)), rows):
        if near + row * cell_m > box[3]:
            break
        for column in range(max(0, int((box[0] - left) / cell_m)), columns):
            x, y = left + column * cell_m, near + row * cell_m
            if x > box[2]:
                break
            depth, edge = _depth(x, y, planes, count)
            if depth <= TOUCH_M:
                continue
            if depth > EDGE_CELLS * cell_m or state[row, column] != FREE:
                state[row, column] = BLOCKED
                continue
            state[row, column] = MOVED
            places[row, column, 0] = x + depth * planes[edge, 0]
            places[row, column, 1] = y + depth * planes[edge, 1]


@compiled
def block(lattice: Lattice, outlines: Outlines) -> None:
    """Mark the nodes of a lattice that lie inside an obstacle as blocked.

    Nodes less than three quarters of a cell inside are moved to the outline instead: so there is a
    path through gaps that are narrower than a cell, and paths lie close to the obstacles they pass.
    """
    state, places, counts = lattice.state, lattice.places, outlines.counts
    rows, columns = state.shape
    for row in range(rows):
        for column in range(columns):
            places[row, column, 0] = lattice.left + column * lattice.cell_m
            places[row, column, 1] = lattice.near + row * lattice.cell_m
    for at in range(len(counts)):
        _block_one(lattice, outlines.planes[at], counts[at], outlines.boxes[at])
    for row in range(rows):
        for column in range(columns):
            if state[row, column] == MOVED:
                state[row, column] = FREE
                x, y = places[row, column, 0], places[row, column, 1]
                for at in range(len(counts)):
                    if _depth(x, y, outlines.planes[at], counts[at])[0] > TOUCH_M:
                        state[row, column] = BLOCKED
