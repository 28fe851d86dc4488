"""Store integers in few bits: rows as differences, and bit fields of any width without gaps.

The difference of order p predicts a number from the p numbers before it: by zero, by the last one,
by a straight line, a parabola, a cubic. Smooth movement is best in high orders, noise in low ones.
The first numbers of a row have fewer before them and use the highest order possible: number i is
differenced min(i, p) times.

Differences d are converted to unsigned numbers that are small if the magnitude is (0, -1, 1, -2 as
0, 1, 2, 3): z = (d << 1) ^ (d >> bits - 1), d = (z >> 1) ^ -(z & 1). All arithmetic is modulo
2^bits, so that it can be reversed whatever the numbers are.

Numbers of 0 to 32 bits each are packed one after the other without gaps, highest bit first. The
first number begins at the highest bit of the first byte; zeros fill the last byte.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

HIGHEST_ORDER = 4
_WORD = np.uint64(32)
_LOW_WORD = np.uint64(0xFFFFFFFF)


def best_differences(rows: NDArray[Any]) -> tuple[NDArray[np.uint8], NDArray[Any]]:
    """Return the order (rows,) that makes each row smallest, and its unsigned differences.

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
    """Return the rows (rows, n) with these differences: the inverse of `best_differences`."""
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


def pack(numbers: NDArray[np.uint32], widths: NDArray[np.int64]) -> bytes:
    """Pack `numbers` (n,), each below 2^width, into `widths` (n,) bits each."""
    if not len(numbers):
        return b""
    ends = np.cumsum(widths)
    first = ends - widths
    total = int(ends[-1])
    word = first >> 5
    # Each number fits into a window of two words that begins with the word of its first bit.
    window = numbers.astype(np.uint64) << (64 - widths - (first & 31)).astype(np.uint64)
    count = (total + 31) // 32 + 2
    # Numbers do not overlap, so adding them up sets bits; sums below 2^32 are exact in float64.
    words = np.bincount(word, (window >> _WORD).astype(np.float64), count)
    words[1:] += np.bincount(word, (window & _LOW_WORD).astype(np.float64), count)[:-1]
    return words.astype(">u4").tobytes()[: (total + 7) // 8]


def unpack(data: bytes, widths: NDArray[np.int64], first_bit: int = 0) -> NDArray[np.uint32]:
    """Unpack numbers (n,) of `widths` (n,) bits that begin at bit `first_bit`."""
    # A window extends into the next word, and a number of 0 bits at the end begins after the last.
    words = np.frombuffer(data.ljust(-(-len(data) // 4) * 4 + 8, b"\0"), ">u4").astype(np.uint64)
    windows = (words[:-1] << _WORD) | words[1:]
    first = np.cumsum(widths) - widths + first_bit
    aligned = windows[first >> 5] << (first & 31).astype(np.uint64)
    numbers: NDArray[np.uint32] = (aligned >> (64 - widths).astype(np.uint64)).astype(np.uint32)
    return numbers
