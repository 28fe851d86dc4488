"""Multilinear and radial interpolation at points, compiled."""

import math

import numpy as np

from app.science.compiled import compiled
from app.science.rotations import FloatArray
from app.science.walking.maps.densifying import IntArray


@compiled
def multilinear_point(
    grid: FloatArray, axis_values: FloatArray, shape: IntArray, point: FloatArray
) -> float:
    """Return a map (K,) at one point (n,): its cell's corners, weighted by proximity."""
    n = len(shape)
    lows, shares = np.empty(n, dtype=np.int64), np.empty(n)
    first = 0
    for axis in range(n):
        low = 0
        while low + 2 < shape[axis] and axis_values[first + low + 1] <= point[axis]:
            low += 1
        lows[axis], shares[axis] = low, 0.0
        if shape[axis] > 1:
            below = axis_values[first + low]
            shares[axis] = (point[axis] - below) / (axis_values[first + low + 1] - below)
        first += shape[axis]
    total = 0.0
    for corner in range(1 << n):
        weight, index = 1.0, 0
        for axis in range(n):
            up = (corner >> axis) & 1
            weight *= shares[axis] if up else 1.0 - shares[axis]
            index = index * shape[axis] + min(lows[axis] + up, shape[axis] - 1)
        total += weight * grid[index]
    return total


@compiled
def multilinear_at(
    grid: FloatArray, axis_values: FloatArray, shape: IntArray, points: FloatArray
) -> FloatArray:
    """Return a map (K,) at points (P, n)."""
    found = np.empty(len(points))
    for at in range(len(points)):
        found[at] = multilinear_point(grid, axis_values, shape, points[at])
    return found


@compiled
def _squares(
    axis_values: FloatArray, shape: IntArray, inverse_width: float, point: FloatArray
) -> FloatArray:
    """Return squared distances from a point to the values of each axis, in units of the width."""
    squares, at = np.empty(len(axis_values)), 0
    for axis in range(len(shape)):
        for _ in range(shape[axis]):
            step = (point[axis] - axis_values[at]) * inverse_width
            squares[at] = step * step
            at += 1
    return squares


@compiled
def radial_point(
    coefficients: FloatArray,
    axis_values: FloatArray,
    shape: IntArray,
    inverse_width: float,
    point: FloatArray,
) -> float:
    """Return the sum of multiquadrics with coefficients (K,) at one point (n,).

    Squares are computed once for each value of an axis. Along the last axis each node has its own
    sum, which lets the processor compute several square roots simultaneously and still add in a
    fixed order.
    """
    n, last = len(shape), shape[-1]
    squares = _squares(axis_values, shape, inverse_width, point)
    tail = squares[len(squares) - last :]
    sums, index = np.zeros(last), np.zeros(n, dtype=np.int64)
    for row in range(len(coefficients) // last):
        base, first = 1.0, 0
        for axis in range(n - 1):
            base += squares[first + index[axis]]
            first += shape[axis]
        own = coefficients[row * last : (row + 1) * last]
        for node in range(last):
            sums[node] += own[node] * math.sqrt(base + tail[node])
        turning = n - 2
        while turning >= 0:
            index[turning] += 1
            if index[turning] < shape[turning]:
                break
            index[turning] = 0
            turning -= 1
    total = 0.0
    for node in range(last):
        total += sums[node]
    return total


@compiled
def radial_at(
    coefficients: FloatArray,
    axis_values: FloatArray,
    shape: IntArray,
    inverse_width: float,
    points: FloatArray,
) -> FloatArray:
    """Return the sums of multiquadrics with coefficients (K,) at points (P, n)."""
    found = np.empty(len(points))
    for at in range(len(points)):
        found[at] = radial_point(coefficients, axis_values, shape, inverse_width, points[at])
    return found
