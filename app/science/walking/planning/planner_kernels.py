"""Lines of sight and Lazy Theta*, compiled; see `outlines` for the data types.

A segment is blocked if it passes through the interior of an outline; it may touch corners and
edges.
"""

import math

import numpy as np

from app.science.compiled import compiled
from app.science.rotations import FloatArray
from app.science.walking.scene import CLOSED, FREE, TOUCH_M, IntArray, Lattice, Outlines


@compiled
def _overlap(ax: float, ay: float, bx: float, by: float, planes: FloatArray, count: int) -> float:
    """Return the share of a segment that lies inside one outline; not positive if there is none."""
    enters, leaves = 0.0, 1.0
    for edge in range(count):
        nx, ny = planes[edge, 0], planes[edge, 1]
        along = nx * (bx - ax) + ny * (by - ay)
        depth = planes[edge, 2] - TOUCH_M - nx * ax - ny * ay
        if along > 0.0:
            leaves = min(leaves, depth / along)
        elif along < 0.0:
            enters = max(enters, depth / along)
        elif depth <= 0.0:
            return -1.0
        if enters >= leaves:
            return -1.0
    return leaves - enters


@compiled
def sees(ax: float, ay: float, bx: float, by: float, outlines: Outlines) -> bool:
    """Return whether the straight line from a to b passes through no obstacle; it is exact."""
    left, right = min(ax, bx), max(ax, bx)
    near, far = min(ay, by), max(ay, by)
    for at in range(len(outlines.counts)):
        left_or_right = left >= outlines.boxes[at, 2] or right <= outlines.boxes[at, 0]
        if left_or_right or near >= outlines.boxes[at, 3] or far <= outlines.boxes[at, 1]:
            continue
        if _overlap(ax, ay, bx, by, outlines.planes[at], outlines.counts[at]) > 0.0:
            return False
    return True


@compiled
def _push(keys: FloatArray, items: IntArray, size: int, key: float, item: int) -> None:
    """Push an item onto the heap, whose arrays must have room for it."""
    at = size
    while at > 0:
        above = (at - 1) >> 1
        if keys[above] <= key:
            break
        keys[at], items[at] = keys[above], items[above]
        at = above
    keys[at], items[at] = key, item


@compiled
def _pop(keys: FloatArray, items: IntArray, size: int) -> int:
    """Pop the item with the smallest key from a non-empty heap."""
    top = items[0]
    last = size - 1
    key, item = keys[last], items[last]
    at = 0
    while True:
        below = 2 * at + 1
        if below >= last:
            break
        if below + 1 < last and keys[below + 1] < keys[below]:
            below += 1
        if keys[below] >= key:
            break
        keys[at], items[at] = keys[below], items[below]
        at = below
    keys[at], items[at] = key, item
    return int(top)


@compiled
def _distance(ax: float, ay: float, bx: float, by: float) -> float:
    return math.sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by))


@compiled
def _check_parent(
    row: int,
    column: int,
    lattice: Lattice,
    far: FloatArray,
    parent: IntArray,
    outlines: Outlines,
) -> bool:
    """Check that a node's parent sees it, else replace it by the best expanded neighbour.

    Returns whether the node has a parent.
    """
    places, columns = lattice.places, lattice.state.shape[1]
    x, y = places[row, column, 0], places[row, column, 1]
    above = parent[row, column]
    row_above, column_above = above // columns, above % columns
    px, py = places[row_above, column_above, 0], places[row_above, column_above, 1]
    if sees(px, py, x, y, outlines):
        return True
    far[row, column], parent[row, column] = np.inf, -1
    for r in range(max(0, row - 1), min(lattice.state.shape[0], row + 2)):
        for c in range(max(0, column - 1), min(columns, column + 2)):
            if lattice.state[r, c] != CLOSED:
                continue
            ox, oy = places[r, c, 0], places[r, c, 1]
            length = far[r, c] + _distance(ox, oy, x, y)
            if length < far[row, column] and sees(ox, oy, x, y, outlines):
                far[row, column], parent[row, column] = length, r * columns + c
    return bool(parent[row, column] >= 0)


@compiled
def _update_neighbours(
    row: int,
    column: int,
    goal: int,
    lattice: Lattice,
    far: FloatArray,
    parent: IntArray,
    keys: FloatArray,
    items: IntArray,
    size: int,
) -> int:
    """Update a node's neighbours with the path through its parent; return the heap's new size."""
    state, places = lattice.state, lattice.places
    rows, columns = state.shape
    gx, gy = places[goal // columns, goal % columns, 0], places[goal // columns, goal % columns, 1]
    above = parent[row, column]
    row_above, column_above = above // columns, above % columns
    px, py = places[row_above, column_above, 0], places[row_above, column_above, 1]
    so_far = far[row_above, column_above]
    for r in range(max(0, row - 1), min(rows, row + 2)):
        for c in range(max(0, column - 1), min(columns, column + 2)):
            x, y = places[r, c, 0], places[r, c, 1]
            length = so_far + _distance(px, py, x, y)
            if state[r, c] == FREE and length < far[r, c]:
                far[r, c], parent[r, c] = length, above
                _push(keys, items, size, length + _distance(x, y, gx, gy), r * columns + c)
                size += 1
    return size


@compiled
def lazy_theta(lattice: Lattice, start: int, goal: int, outlines: Outlines) -> IntArray:
    """Search a path over a lattice (Nash, Koenig and Tovey 2010, Lazy Theta*).

    A node's parent is assumed to see it until the node is expanded; only then one line of sight is
    checked, and if it is blocked the best expanded neighbour becomes the parent.

    Args:
        lattice: the lattice, whose states are modified.
        start, goal: two different nodes, row * columns + column.
        outlines: the obstacles.

    Returns:
        Nodes from start to goal; empty if there is no path.
    """
    state = lattice.state
    columns = state.shape[1]
    far, parent = np.full(state.shape, np.inf), np.full(state.shape, -1, np.int64)
    far[start // columns, start % columns] = 0.0
    parent[start // columns, start % columns] = start
    keys, items, size = np.zeros(1024), np.full(1024, start, np.int64), 1
    while size > 0:
        node = _pop(keys, items, size)
        size -= 1
        row, column = node // columns, node % columns
        if state[row, column] != FREE:
            continue
        if not _check_parent(row, column, lattice, far, parent, outlines):
            continue  # it may still be reached from another neighbour
        state[row, column] = CLOSED
        if node == goal:
            return _backtrack(parent.ravel(), start, goal)
        if size + 8 >= len(keys):
            keys = np.concatenate((keys, np.empty_like(keys)))
            items = np.concatenate((items, np.empty_like(items)))
        size = _update_neighbours(row, column, goal, lattice, far, parent, keys, items, size)
    return np.empty(0, np.int64)


@compiled
def _backtrack(parent: IntArray, start: int, goal: int) -> IntArray:
    count, node = 1, goal
    while node != start:
        node = parent[node]
        count += 1
    nodes = np.empty(count, np.int64)
    for at in range(count - 1, -1, -1):
        nodes[at] = goal
        goal = parent[goal]
    return nodes


@compiled
def mutual_sight(points: FloatArray, outlines: Outlines) -> FloatArray:
    """Return the distances (P, P) between mutually visible points, inf between the others."""
    count = len(points)
    lengths = np.full((count, count), np.inf)
    for a in range(count):
        for b in range(a):
            ax, ay, bx, by = points[a, 0], points[a, 1], points[b, 0], points[b, 1]
            if sees(ax, ay, bx, by, outlines):
                lengths[a, b] = lengths[b, a] = _distance(ax, ay, bx, by)
    return lengths
