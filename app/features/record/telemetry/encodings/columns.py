"""The parts that all encodings share: the columns, the error for a damaged chunk, and byte planes.

Byte planes contain first the lowest byte of every number, then the next higher one, and so on: the
high bytes of small numbers are zero or repeat, so next to each other they compress to almost
nothing. Planes are little-endian on every machine.
"""

from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Number = TypeVar("Number", bound=np.generic)


class DamagedChunkError(ValueError):
    """The bytes of a chunk are not what was written; says how that was detected and what to do."""

    def __init__(self, what: str) -> None:
        super().__init__(
            f"a chunk of movement is damaged: {what}; restore it from a backup of the database"
        )


@dataclass(frozen=True)
class Columns:
    """The frames of a chunk: `times_s` (n,), `flags` (n,), `values` (n, w), with arbitrary bits."""

    times_s: NDArray[np.float64]
    flags: NDArray[np.uint8]
    values: NDArray[np.float32]


def to_planes(numbers: NDArray[Any]) -> bytes:
    """Return the byte planes of numbers of any shape, in C order."""
    little = np.ascontiguousarray(numbers, numbers.dtype.newbyteorder("<"))
    return little.view(np.uint8).reshape(-1, little.itemsize).T.tobytes()


def from_planes(planes: NDArray[np.uint8], number: type[Number]) -> NDArray[Number]:
    """Return the numbers of byte planes (bytes,) as a flat array; the inverse of `to_planes`."""
    dtype = np.dtype(number)
    together = np.ascontiguousarray(planes.reshape(dtype.itemsize, -1).T)
    return together.view(dtype.newbyteorder("<")).ravel().astype(number, copy=False)
