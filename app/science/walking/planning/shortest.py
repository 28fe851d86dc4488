"""The shortest path over points among obstacles: Dijkstra's algorithm on the visibility graph."""

import heapq

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.scene import IntArray, Outlines, contains

HIDDEN_M = 1e-7
"""Depth inside another outline from which on a corner is left out of the graph."""
Bounds = tuple[float, float, float, float]


def sees(ax: float, ay: float, bx: float, by: float, outlines: Outlines) -> bool:
    """Return whether the straight line from a to b passes through no obstacle; it is exact."""
    from app.science.walking.planning import planner_kernels as kernels

    return kernels.sees(ax, ay, bx, by, outlines)


def passable(places: list[FloatArray], corners: list[FloatArray], bounds_m: Bounds) -> FloatArray:
    """Return those of some points (each array (K, 2)) that are within bounds and in no outline."""
    joined = np.concatenate([np.empty((0, 2)), *places])
    kept = (joined >= bounds_m[:2]).all(axis=1) & (joined <= bounds_m[2:]).all(axis=1)
    for own in corners:
        kept = kept & ~contains(own, joined, margin_m=HIDDEN_M)
    free: FloatArray = joined[kept]
    return free


def shortest_way(points_m: FloatArray, outlines: Outlines) -> FloatArray | None:
    """Return the points (Q, 2) of the shortest path from the first point to the second.

    None if obstacles block every path.
    """
    from app.science.walking.planning import planner_kernels as kernels

    lengths = kernels.mutual_sight(points_m, outlines)
    far, parent = np.full(len(points_m), np.inf), np.full(len(points_m), -1, dtype=np.int64)
    far[0] = 0.0
    queue = [(0.0, 0)]
    while queue:
        so_far, at = heapq.heappop(queue)
        if at == 1:
            return _backtrack(points_m, parent)
        if so_far > far[at]:
            continue
        through = so_far + lengths[at]
        for other in np.flatnonzero(through < far):
            far[other], parent[other] = through[other], at
            heapq.heappush(queue, (float(through[other]), int(other)))
    return None


def _backtrack(points_m: FloatArray, parent: IntArray) -> FloatArray:
    order, at = [1], 1
    while at != 0:
        at = int(parent[at])
        order.append(at)
    way = points_m[order[::-1]]
    # Points of the graph may coincide, for example where obstacles share a corner.
    apart = np.linalg.norm(np.diff(way, axis=0), axis=1) > 0.0
    chosen: FloatArray = way[np.concatenate([[True], apart])]
    return chosen
