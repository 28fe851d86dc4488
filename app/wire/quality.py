"""What is wrong with a frame, told without touching it.

Bad samples are stored as they came. These flags travel beside them: into the stream's counters, to
the console as an alarm, back to the client as a notice, and into every export.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.wire.batch import BODY_JOINTS

UNIT_TOLERANCE = 1e-3
"""A float32 unit quaternion that went through a few products stays within this of length 1."""


@dataclass(frozen=True)
class FrameFlags:
    """Per frame (n,): any non-finite value, any rotation that is not of unit length."""

    non_finite: NDArray[np.bool_]
    non_unit: NDArray[np.bool_]

    @property
    def bad(self) -> NDArray[np.bool_]:
        """Frames that no summary may use."""
        return self.non_finite | self.non_unit


def flag_frames(times_s: NDArray[np.float64], values: NDArray[np.float32]) -> FrameFlags:
    """Judge frames: `times_s` (n,) in s, `values` (n, 91) as on the wire."""
    finite = np.isfinite(values).all(axis=1) & np.isfinite(times_s)
    with np.errstate(invalid="ignore", over="ignore"):
        rotations = values[:, 3:].reshape(len(values), BODY_JOINTS, 4).astype(np.float64)
        length = np.sqrt(np.einsum("njk,njk->nj", rotations, rotations))
        unit = (np.abs(length - 1.0) <= UNIT_TOLERANCE).all(axis=1)
    return FrameFlags(non_finite=~finite, non_unit=finite & ~unit)
