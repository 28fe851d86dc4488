"""Rows of whole numbers as what is new in them: differences, chosen for each row.

The difference of order p predicts a number from the p before it: by nothing, by the last one, by a
straight line, a parabola, a cubic. Smooth movement is best in high orders, noise in low ones. The
first numbers of a row have fewer before them and take the order they can: number i is differenced
min(i, p) times.

Differences d are handed on as unsigned numbers that are small where the magnitude is (0, -1, 1, -2
as 0, 1, 2, 3): z = (d << 1) ^ (d >> bits - 1), d = (z >> 1) ^ -(z & 1). All arithmetic is modulo
2^bits, so that it can be undone whatever the numbers are.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

HIGHEST_ORDER = 4


def best_differences(rows: NDArray[Any]) -> tuple[NDArray[np.uint8], NDArray[Any]]:
    """The order (rows,) that makes each row smallest, and its differences as unsigned numbers.

    `rows` (rows, n) are int32 or int64, the differences uint32 or uint64.
    """
    best, order = rows.copy(), np.zeros(len(rows), np.uint8)
    smallest = _magnitude(rows)
    current = rows
    for tried in range(1, min(HIGHEST_ORDER, rows.shape[1] - 1) + 1):
        following = current.copy()
        following[:, tried:] -= current[:, tried - 1 : -1]
        current = following
        magnitude = _magnitude(current[:, tried:])
        better = magnitude < smallest
        best[better], order[better] = current[better], tried
        smallest = np.where(better, magnitude, smallest)
    sign = best >> (8 * best.itemsize - 1)
    return order, ((best << 1) ^ sign).view(f"u{best.itemsize}")


def summed(order: NDArray[np.uint8], differences: NDArray[Any]) -> NDArray[Any]:
    """The rows (rows, n) whose differences of these orders are given; undoes the other."""
    one = differences.dtype.type(1)
    signed = f"i{differences.itemsize}"
    rows: NDArray[Any] = (differences >> one).view(signed) ^ -(differences & one).view(signed)
    for again in range(int(order.max(initial=0)), 0, -1):
        chosen = np.flatnonzero(order >= again)
        part = rows[chosen, again - 1 :]
        rows[chosen, again - 1 :] = np.cumsum(part, axis=1, dtype=rows.dtype)
    return rows


def _magnitude(differences: NDArray[Any]) -> NDArray[np.float64]:
    return np.asarray(np.abs(differences.astype(np.float64)).mean(axis=1))
