"""Numbers of 0 to 32 bits each, one behind the other without gaps, highest bit first.

The first number begins at the highest bit of the first byte; zeros fill the last byte.
"""

import numpy as np
from numpy.typing import NDArray

_WORD = np.uint64(32)
_LOW_WORD = np.uint64(0xFFFFFFFF)


def pack(numbers: NDArray[np.uint32], widths: NDArray[np.int64]) -> bytes:
    """Write `numbers` (n,), each below 2^width, with `widths` (n,) bits each."""
    if not len(numbers):
        return b""
    ends = np.cumsum(widths)
    first = ends - widths
    total = int(ends[-1])
    word = first >> 5
    # Each number lies in a window of two words that begins with the word of its first bit.
    window = numbers.astype(np.uint64) << (64 - widths - (first & 31)).astype(np.uint64)
    count = (total + 31) // 32 + 2
    # Numbers do not overlap, so adding them up sets bits; sums below 2^32 are exact in float64.
    words = np.bincount(word, (window >> _WORD).astype(np.float64), count)
    words[1:] += np.bincount(word, (window & _LOW_WORD).astype(np.float64), count)[:-1]
    return words.astype(">u4").tobytes()[: (total + 7) // 8]


def unpack(data: bytes, widths: NDArray[np.int64], first_bit: int = 0) -> NDArray[np.uint32]:
    """Read numbers (n,) of `widths` (n,) bits that begin at bit `first_bit`."""
    # A window reaches into the next word, and an empty number at the end begins behind the last.
    words = np.frombuffer(data.ljust(-(-len(data) // 4) * 4 + 8, b"\0"), ">u4").astype(np.uint64)
    windows = (words[:-1] << _WORD) | words[1:]
    first = np.cumsum(widths) - widths + first_bit
    begun = windows[first >> 5] << (first & 31).astype(np.uint64)
    numbers: NDArray[np.uint32] = (begun >> (64 - widths).astype(np.uint64)).astype(np.uint32)
    return numbers
