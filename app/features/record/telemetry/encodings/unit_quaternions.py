"""Predict one component of a unit quaternion from the other three.

Of each joint, the component that is greatest in most frames is left out for the chunk, and expected
to be +-sqrt(1 - a^2 - b^2 - c^2) of the other three. Only its distance from there is stored, in
float32 steps: 0 or 1 for a quaternion that was normalised, anything for one that was not.

The square root is computed in float64. The squares of float32 are exact there, so that neither
fused multiplication nor the machine changes the result: the two sums, the difference, the root and
the rounding to float32 are each rounded once, to nearest, as IEEE 754 prescribes.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_SIGN_AT = np.uint32(31)
_NEGATIVE = 4


@dataclass(frozen=True)
class LeftOut:
    """The components left out of a chunk's quaternions.

    `component` (joints,): 0 to 3 of w, x, y, z; `negative` (joints,): whether it is negative;
    `before`: how many values precede the quaternions, 3 of a body's root, none of fingers.
    """

    component: NDArray[np.uint8]
    negative: NDArray[np.bool_]
    before: int

    @property
    def rows(self) -> NDArray[np.int64]:
        """Return the row indices of the left-out components, one per joint."""
        return self.before + 4 * np.arange(len(self.component)) + self.component

    @property
    def kept_rows(self) -> NDArray[np.int64]:
        """Return the row indices of the remaining components, in order."""
        width = self.before + 4 * len(self.component)
        return np.delete(np.arange(width), self.rows)

    def as_bytes(self) -> bytes:
        """Return one byte per joint: the component, plus 4 if it is negative."""
        return (self.component + _NEGATIVE * self.negative).astype(np.uint8).tobytes()

    @staticmethod
    def of_bytes(data: NDArray[np.uint8], before: int) -> "LeftOut":
        """Parse the bytes that `as_bytes` returns."""
        return LeftOut(data & np.uint8(3), (data & np.uint8(_NEGATIVE)) != 0, before)

    def expected(self, kept: NDArray[np.uint32]) -> NDArray[np.uint32]:
        """Return the expected bits (joints, n) of the left-out components.

        `kept` (before + 3 joints, n) are the bits of the components that remain.
        """
        three = kept[self.before :].view(np.float32).reshape(len(self.component), 3, kept.shape[1])
        with np.errstate(invalid="ignore"):  # frames may contain NaNs and infinities
            a, b, c = np.moveaxis(three.astype(np.float64), 1, 0)
            left = 1.0 - (a * a + b * b + c * c)
            root = np.sqrt(np.where(left > 0.0, left, 0.0)).astype(np.float32)
        sign = self.negative.astype(np.uint32) << _SIGN_AT
        return root.view(np.uint32) | sign[:, np.newaxis]


def choose(bits: NDArray[np.uint32]) -> LeftOut:
    """Choose which components to leave out of a chunk with these `bits` (before + 4 joints, n)."""
    before = bits.shape[0] % 4
    quaternions = bits[before:].reshape(-1, 4, bits.shape[1])
    # Without the sign, the bits of floats have the same order as their magnitudes, NaNs included.
    component = (quaternions & np.uint32(0x7FFFFFFF)).mean(axis=2).argmax(axis=1)
    greatest = quaternions[np.arange(len(component)), component]
    negative = (greatest >> _SIGN_AT).mean(axis=1) > 0.5
    return LeftOut(component.astype(np.uint8), negative, before)
