"""Numbers as byte planes: first the lowest byte of every number, then the next higher, and so on.

High bytes of small numbers are zero or repeat, and beside each other they compress to nothing.
Planes are little-endian on every machine.
"""

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Number = TypeVar("Number", bound=np.generic)


def to_planes(numbers: NDArray[Any]) -> bytes:
    """The planes of numbers of any shape, in C order."""
    little = np.ascontiguousarray(numbers, numbers.dtype.newbyteorder("<"))
    return little.view(np.uint8).reshape(-1, little.itemsize).T.tobytes()


def from_planes(planes: NDArray[np.uint8], number: type[Number]) -> NDArray[Number]:
    """The flat numbers whose planes (bytes,) these are; the inverse of `to_planes`."""
    dtype = np.dtype(number)
    together = np.ascontiguousarray(planes.reshape(dtype.itemsize, -1).T)
    return together.view(dtype.newbyteorder("<")).ravel().astype(number, copy=False)
