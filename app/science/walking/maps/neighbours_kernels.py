"""The neighbour search of `neighbours`, compiled.

It descends the tree, nearer side first, and stores the best k in a heap.
"""

import math

from app.science.compiled import compiled
from app.science.rotations import FloatArray
from app.science.walking.maps.densifying import IntArray

STACK = 128
"""Size of the search stack, sufficient for any tree that fits into memory."""
ROUNDING = 1e-9
"""Mean weight below which distances differ by rounding alone."""


@compiled
def _sift(far: FloatArray, indices: IntArray, count: int) -> None:
    """Restore the heap, largest first, after its top was replaced."""
    at = 0
    while True:
        child = 2 * at + 1
        if child >= count:
            return
        if child + 1 < count and far[child + 1] > far[child]:
            child += 1
        if far[at] >= far[child]:
            return
        far[at], far[child] = far[child], far[at]
        indices[at], indices[child] = indices[child], indices[at]
        at = child


@compiled
def _lift(far: FloatArray, indices: IntArray, at: int) -> None:
    """Restore the heap after an element was appended at `at`."""
    while at > 0:
        parent = (at - 1) // 2
        if far[parent] >= far[at]:
            return
        far[at], far[parent] = far[parent], far[at]
        indices[at], indices[parent] = indices[parent], indices[at]
        at = parent


@compiled
def _take_leaf(
    points: FloatArray,
    first: int,
    last: int,
    z: FloatArray,
    indices: IntArray,
    far: FloatArray,
    found: int,
) -> int:
    k = len(indices)
    for point in range(first, last):
        apart = 0.0
        for axis in range(len(z)):
            step = points[point, axis] - z[axis]
            apart += step * step
        if found < k:
            far[found], indices[found] = apart, point
            _lift(far, indices, found)
            found += 1
        elif apart < far[0]:
            far[0], indices[0] = apart, point
            _sift(far, indices, k)
    return found


@compiled
def nearest(
    points: FloatArray,
    order: IntArray,
    axes: IntArray,
    splits: FloatArray,
    lows: IntArray,
    firsts: IntArray,
    lasts: IntArray,
    z: FloatArray,
    indices: IntArray,
    far: FloatArray,
) -> None:
    """Search the k nearest points: fill `indices` (k,) and their distances `far` (k,)."""
    stack, bounds = [0] * STACK, [0.0] * STACK
    depth, found, k = 1, 0, len(indices)
    while depth > 0:
        depth -= 1
        node = stack[depth]
        if found == k and bounds[depth] >= far[0]:
            continue
        axis = axes[node]
        if axis < 0:
            found = _take_leaf(points, firsts[node], lasts[node], z, indices, far, found)
            continue
        off = z[axis] - splits[node]
        near = lows[node] if off < 0.0 else lows[node] + 1
        stack[depth], bounds[depth] = 2 * lows[node] + 1 - near, off * off
        stack[depth + 1], bounds[depth + 1] = near, 0.0
        depth += 2
    for at in range(k):
        indices[at] = order[indices[at]]
        far[at] = math.sqrt(far[at])


@compiled
def weigh(far: FloatArray) -> None:
    """Convert distances (k,), in place, to weights 1 - d / d_k, normalised to sum to 1."""
    farthest = 0.0
    for apart in far:
        farthest = max(farthest, apart)
    total = 0.0
    for at in range(len(far)):
        far[at] = 1.0 - far[at] / farthest if farthest > 0.0 else 1.0
        total += far[at]
    for at in range(len(far)):
        far[at] = far[at] / total if total > ROUNDING * len(far) else 1.0 / len(far)
