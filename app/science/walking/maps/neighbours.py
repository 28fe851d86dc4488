"""Find the nearest walks in the space of dependencies, and their weights.

Of the k nearest, the i-th has weight w_i = 1 - d_i / d_k, divided by the sum of all: linear in
distance, zero for the farthest. That makes the result a continuous function of the query: a walk
that becomes one of the neighbours starts with weight 0. If all k are equally far, but for rounding,
they have the same weight.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps.densifying import IntArray
from app.science.walking.records import WalkingError

LEAF = 16
"""Largest number of points in a leaf of the tree."""


@dataclass(frozen=True, eq=False)
class Tree:
    """A k-d tree over N points of m numbers, as arrays for compiled code.

    Node i splits along `axes[i]` at `splits[i]`: smaller points are below node `lows[i]`, the
    others below the node after it. A leaf has axis -1 and contains points `firsts[i]` to
    `lasts[i]`.

    Attributes:
        points: (N, m) points in the order of the leaves.
        order: (N,) index of each point in the caller's order.
        axes, lows, firsts, lasts: (nodes,) integers of each node.
        splits: (nodes,) value at which each node splits.
    """

    points: FloatArray
    order: IntArray
    axes: IntArray
    splits: FloatArray
    lows: IntArray
    firsts: IntArray
    lasts: IntArray


def tree_of(points: FloatArray) -> Tree:
    """Build a k-d tree of points (N, m); raise WalkingError if there are none."""
    if points.ndim != 2 or not len(points):
        raise WalkingError(f"Neighbours are searched among points (N, m), got {points.shape}.")
    order = np.arange(len(points))
    nodes: list[list[float]] = [[-1, 0.0, -1, 0, len(points)]]
    waiting = [0]
    while waiting:
        at = waiting.pop()
        first, last = int(nodes[at][3]), int(nodes[at][4])
        own = points[order[first:last]]
        spread = np.ptp(own, axis=0)
        if last - first <= LEAF or not spread.max() > 0.0:
            continue
        axis, half = int(np.argmax(spread)), (last - first) // 2
        # Not partitioned: the order of equal numbers would depend on the processor.
        sorting = np.argsort(own[:, axis], kind="stable")
        order[first:last] = order[first:last][sorting]
        nodes[at][:3] = [axis, float(own[sorting[half], axis]), len(nodes)]
        waiting += [len(nodes), len(nodes) + 1]
        nodes += [[-1, 0.0, -1, first, first + half], [-1, 0.0, -1, first + half, last]]
    columns = np.array(nodes, dtype=np.float64)
    axes, lows, firsts, lasts = (columns[:, at].astype(np.int64) for at in (0, 2, 3, 4))
    ordered = np.ascontiguousarray(points[order], dtype=np.float64)
    return Tree(ordered, order, axes, np.ascontiguousarray(columns[:, 1]), lows, firsts, lasts)


def neighbours(tree: Tree, z: FloatArray, k: int) -> tuple[IntArray, FloatArray]:
    """Return the k nearest points to z-scores (m,), unordered.

    Returns:
        Their indices (k,) and weights (k,), which sum to 1.

    Raises:
        WalkingError: k is not between 1 and the number of points.
    """
    from app.science.walking.maps.neighbours_kernels import nearest, weigh

    check_k(k, len(tree.points))
    indices, weights = np.empty(k, dtype=np.int64), np.empty(k)
    nearest(
        tree.points,
        tree.order,
        tree.axes,
        tree.splits,
        tree.lows,
        tree.firsts,
        tree.lasts,
        np.ascontiguousarray(z, dtype=np.float64),
        indices,
        weights,
    )
    weigh(weights)
    return indices, weights


def check_k(k: int, points: int) -> None:
    """Raise WalkingError unless `k` is between 1 and the number of points."""
    if not 1 <= k <= points:
        raise WalkingError(f"{k} neighbours of {points} are not possible: give 1 to {points}.")
