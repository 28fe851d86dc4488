"""Split floats into integer multiples of one unit per row, and what is finer than the unit.

A float32 is significand x 2^(exponent - 150), the significand 24 bits long. Differences from frame
to frame are small only if all numbers have the same unit, so a row uses the unit of its greatest
member, `top`, and each float is split there:

    coarse = significand >> (top - exponent), with the float's sign
    rest   = the bits that were shifted out

The rest has as many bits as the coarse part is shorter than 24, so its length need not be stored. A
float without a coarse part (zero, denormal, NaN, infinite, or 2^24 times smaller than the row's
greatest) has coarse 0 and is stored whole, as an exception.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_SIGNIFICAND_BITS = 24
_STORED = np.uint32(0x7FFFFF)
_IMPLIED = np.uint32(0x800000)
_SIGN_AT = np.uint32(31)
_EXPONENT_AT = np.uint32(23)


@dataclass(frozen=True)
class Significands:
    """Rows of floats, split into coarse parts and rests.

    `top` (rows,) biased exponents 0 to 254; `coarse` (rows, n); `rest` (rows, n), each number of
    `rest_widths` (rows, n) bits; `exceptions` (m,) the bits of the floats with coarse 0.
    """

    top: NDArray[np.uint8]
    coarse: NDArray[np.int32]
    rest: NDArray[np.uint32]
    rest_widths: NDArray[np.int64]
    exceptions: NDArray[np.uint32]


def cut(bits: NDArray[np.uint32]) -> Significands:
    """Split the floats with these `bits` (rows, n)."""
    exponent = ((bits >> _EXPONENT_AT) & np.uint32(0xFF)).astype(np.int32)
    usable = (exponent > 0) & (exponent < 255)
    top = np.where(usable, exponent, 0).max(axis=1)
    shift = top[:, np.newaxis] - exponent
    usable &= shift < _SIGNIFICAND_BITS
    rest_widths = np.where(usable, shift, 0)
    shift = rest_widths.astype(np.uint32)
    significand = (bits & _STORED) | _IMPLIED
    magnitude = np.where(usable, significand >> shift, 0).astype(np.int32)
    return Significands(
        top=top.astype(np.uint8),
        coarse=np.where(bits >> _SIGN_AT, -magnitude, magnitude),
        rest=significand & ((np.uint32(1) << shift) - np.uint32(1)),
        rest_widths=rest_widths.astype(np.int64),
        exceptions=bits[~usable],
    )


def rest_widths(coarse: NDArray[np.int32]) -> NDArray[np.int64]:
    """Return how many bits are missing from each coarse part (rows, n): 0 to 23, and 0 for a 0."""
    lengths = np.frexp(np.abs(coarse).astype(np.float64))[1]
    return np.where(coarse == 0, 0, _SIGNIFICAND_BITS - lengths).astype(np.int64)


def joined(parts: Significands) -> NDArray[np.uint32]:
    """Return the bits (rows, n) of the floats; the inverse of `cut`."""
    shift = parts.rest_widths.astype(np.uint32)
    significand = (np.abs(parts.coarse).astype(np.uint32) << shift) | parts.rest
    # The implied bit of the significand adds 1 to the exponent, so subtract it first.
    exponent = parts.top[:, np.newaxis].astype(np.uint32) - shift - np.uint32(1)
    bits: NDArray[np.uint32] = (exponent << _EXPONENT_AT) + significand
    bits |= (parts.coarse < 0).astype(np.uint32) << _SIGN_AT
    bits[parts.coarse == 0] = parts.exceptions
    return bits
