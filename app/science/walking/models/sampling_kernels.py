"""Draw from maps, compiled; deterministic, as random numbers are passed in as uniforms."""

import math

import numpy as np

from app.science.compiled import compiled
from app.science.rotations import FloatArray
from app.science.walking.maps import IntArray, MapArray
from app.science.walking.maps.interpolation_kernels import multilinear_point, radial_point
from app.science.walking.maps.neighbours_kernels import nearest, weigh


@compiled
def _from_tents(
    node: int,
    axis_values: FloatArray,
    shape: IntArray,
    uniforms: FloatArray,
    first_uniform: int,
    vector: FloatArray,
) -> None:
    """Draw a vector from the product of the tents around a node, given by its flat index.

    Two uniforms are used for each axis.
    """
    n, rest, first = len(shape), node, len(axis_values)
    for axis in range(n - 1, -1, -1):
        at = rest % shape[axis]
        rest //= shape[axis]
        first -= shape[axis]
        own = axis_values[first + at]
        left = axis_values[first + at - 1] if at > 0 else own
        right = axis_values[first + at + 1] if at + 1 < shape[axis] else own
        side = uniforms[first_uniform + 2 * axis] * (right - left)
        # The density decreases linearly from the node outwards.
        away = 1.0 - math.sqrt(uniforms[first_uniform + 2 * axis + 1])
        vector[axis] = (
            own - away * (own - left) if side < own - left else own + away * (right - own)
        )


@compiled
def _pick(parts: FloatArray, uniform: float) -> int:
    """Return a random index with probability proportional to its part; -1 if all are zero."""
    left, chosen = uniform * parts.sum(), -1
    for at in range(len(parts)):
        if parts[at] > 0.0:
            chosen = at
            if left < parts[at]:
                break
            left -= parts[at]
    return chosen


@compiled
def _pick_node(row: MapArray, node_weights: FloatArray, left: float) -> int:
    """Return the node of a map at which its cumulative mass exceeds `left`."""
    chosen = 0
    for node in range(len(node_weights)):
        own = row[node] * node_weights[node]
        if own > 0.0:
            chosen = node
            if left < own:
                break
            left -= own
    return chosen


@compiled
def mixture_draw(
    points: FloatArray,
    order: IntArray,
    axes: IntArray,
    splits: FloatArray,
    lows: IntArray,
    firsts: IntArray,
    lasts: IntArray,
    z: FloatArray,
    k: int,
    masses: FloatArray,
    values: MapArray,
    node_weights: FloatArray,
    axis_values: FloatArray,
    shape: IntArray,
    uniforms: FloatArray,
    vector: FloatArray,
) -> bool:
    """Draw one vector (n,): choose a neighbour, a node of its map, and a position in its tents.

    Returns False if all maps are zero.
    """
    indices, weights = np.empty(k, dtype=np.int64), np.empty(k)
    nearest(points, order, axes, splits, lows, firsts, lasts, z, indices, weights)
    weigh(weights)
    for at in range(k):
        weights[at] *= masses[indices[at]]
    at = _pick(weights, uniforms[0])
    if at < 0:
        return False
    node = _pick_node(values[indices[at]], node_weights, uniforms[1] * masses[indices[at]])
    _from_tents(node, axis_values, shape, uniforms, 2, vector)
    return True


@compiled
def blend_rows(indices: IntArray, weights: FloatArray, values: MapArray) -> FloatArray:
    """Return the weighted sum (K,) of the rows `indices` of (N, K).

    Memory bandwidth is the bottleneck, so eight rows are read at a time. Eight rows are added in
    the maps' single precision, and these sums in double precision. If rows are missing at the end,
    the last one is used with weight 0.
    """
    count, blended = len(indices), np.zeros(values.shape[1])
    for first in range(0, count, 8):
        chosen, w = np.zeros(8, dtype=np.int64), np.zeros(8, dtype=np.float32)
        for step in range(8):
            chosen[step] = indices[min(first + step, count - 1)]
            w[step] = weights[first + step] if first + step < count else 0.0
        w0, w1, w2, w3, w4, w5, w6, w7 = w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7]
        r0, r1, r2, r3 = values[chosen[0]], values[chosen[1]], values[chosen[2]], values[chosen[3]]
        r4, r5, r6, r7 = values[chosen[4]], values[chosen[5]], values[chosen[6]], values[chosen[7]]
        for at in range(len(blended)):
            near = w0 * r0[at] + w1 * r1[at] + w2 * r2[at] + w3 * r3[at]
            far = w4 * r4[at] + w5 * r5[at] + w6 * r6[at] + w7 * r7[at]
            blended[at] += near + far
    return blended


@compiled
def tent_draws(
    cumulative: FloatArray,
    axis_values: FloatArray,
    shape: IntArray,
    uniforms: FloatArray,
    vectors: FloatArray,
) -> None:
    """Draw vectors (S, n) from the tents of nodes with cumulative masses (K,), by inversion.

    Fills `vectors`; uses uniforms (S, 1 + 2n).
    """
    for at in range(len(vectors)):
        target = uniforms[at, 0] * cumulative[-1]
        low, high = 0, len(cumulative) - 1
        while low < high:
            middle = (low + high) // 2
            if cumulative[middle] > target:
                high = middle
            else:
                low = middle + 1
        _from_tents(low, axis_values, shape, uniforms[at], 1, vectors[at])


@compiled
def reject(
    coefficients: FloatArray,
    axis_values: FloatArray,
    shape: IntArray,
    inverse_width: float,
    bound: float,
    uniforms: FloatArray,
    vectors: FloatArray,
    done: int,
) -> int:
    """Draw by rejection sampling; an `inverse_width` of 0 selects the multilinear map.

    Each row of uniforms (T, n + 1) is one proposal. Fills vectors from `done` on and returns the
    new number of filled vectors.
    """
    n = len(shape)
    point = np.empty(n)
    for row in range(len(uniforms)):
        if done == len(vectors):
            break
        first = 0
        for axis in range(n):
            low, high = axis_values[first], axis_values[first + shape[axis] - 1]
            point[axis] = low + uniforms[row, axis] * (high - low)
            first += shape[axis]
        if inverse_width > 0.0:
            density = radial_point(coefficients, axis_values, shape, inverse_width, point)
        else:
            density = multilinear_point(coefficients, axis_values, shape, point)
        if uniforms[row, n] * bound < density:
            vectors[done] = point
            done += 1
    return done
