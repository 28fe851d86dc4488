"""The nearest walks in the space of dependencies, and how much each counts.

Of the k nearest, the i-th counts w_i = 1 - d_i / d_k, over the sum of these: linear in distance,
the farthest not at all. That makes the result continuous in the question: whoever enters the circle
of neighbours enters with weight 0. Where all k are equally far, they count the same.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps.densifying import IntArray
from app.science.walking.records import WalkingError

LEAF = 16
"""Points in a leaf of the tree."""


@dataclass(frozen=True, eq=False)
class Tree:
    """A k-d tree over N points of m numbers, as arrays that compiled code walks through.

    Node i splits along `axes[i]` at `splits[i]`: smaller points are below node `lows[i]`, the
    others below the next of it. A leaf has axis -1 and holds points `firsts[i]` to `lasts[i]`.

    Attributes:
        points: (N, m) in the order of the leaves.
        order: (N,) which point of the caller each one is.
        axes, lows, firsts, lasts: (nodes,).
        splits: (nodes,).
    """

    points: FloatArray
    order: IntArray
    axes: IntArray
    splits: FloatArray
    lows: IntArray
    firsts: IntArray
    lasts: IntArray


def tree_of(points: FloatArray) -> Tree:
    """Build the tree; raises WalkingError without points."""
    if points.ndim != 2 or not len(points):
        raise WalkingError(f"Neighbours are found among points (N, m), got {points.shape}.")
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
        sorting = np.argpartition(own[:, axis], half)
        order[first:last] = order[first:last][sorting]
        nodes[at][:3] = [axis, float(own[sorting[half], axis]), len(nodes)]
        waiting += [len(nodes), len(nodes) + 1]
        nodes += [[-1, 0.0, -1, first, first + half], [-1, 0.0, -1, first + half, last]]
    columns = np.array(nodes, dtype=np.float64)
    axes, lows, firsts, lasts = (columns[:, at].astype(np.int64) for at in (0, 2, 3, 4))
    ordered = np.ascontiguousarray(points[order], dtype=np.float64)
    return Tree(ordered, order, axes, np.ascontiguousarray(columns[:, 1]), lows, firsts, lasts)


def neighbours(tree: Tree, z: FloatArray, k: int) -> tuple[IntArray, FloatArray]:
    """The k nearest points of a question (m,), in no order.

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
    """Raise WalkingError for a number of neighbours that there are not."""
    if not 1 <= k <= points:
        raise WalkingError(f"{k} neighbours of {points} cannot be taken: 1 to {points}.")
