"""Flag bad frames without changing them.

Bad samples are stored unchanged. Their flags go into the stream's counters, to the console as an
alarm, back to the client as a notice, and into every export.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.wire.batch import FINGER_VALUES_PER_FRAME, Batch

UNIT_TOLERANCE = 1e-3
"""A float32 unit quaternion that is the product of a few keeps its length within this of 1."""
FARTHEST_M = 1000.0
"""How far from the start square hips can be, along each axis: beyond every room."""
FRAMES_AT_ONCE = 2048
"""Frames checked together: enough for little overhead, few enough to keep copies small."""


@dataclass(frozen=True)
class FrameFlags:
    """The flags of n frames, each (n,).

    `non_finite`: any value is not finite, or the hips are beyond `FARTHEST_M`. `non_unit`: any
    rotation is not of unit length.
    """

    non_finite: NDArray[np.bool_]
    non_unit: NDArray[np.bool_]

    @property
    def bad(self) -> NDArray[np.bool_]:
        """Frames that must not be used in any summary."""
        return self.non_finite | self.non_unit


def untracked_hands(values: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Return which hands (n, 2), left and right, `values` (n, 120) of fingers say nothing about."""
    return np.asarray(np.isnan(values).reshape(len(values), 2, -1).all(axis=2))


def flag_frames(times_s: NDArray[np.float64], values: NDArray[np.float32]) -> FrameFlags:
    """Flag frames: `times_s` (n,) in s, `values` (n, 91) or, of fingers, (n, 120) as in a batch.

    A hand that is not tracked is no fault.
    """
    if values.shape[1] == FINGER_VALUES_PER_FRAME:
        untracked = np.repeat(untracked_hands(values), FINGER_VALUES_PER_FRAME // 2, axis=1)
        if untracked.any():
            values = np.where(untracked, np.float32(0.5), values)
    finite = np.isfinite(values).all(axis=1) & np.isfinite(times_s)
    # The values of the root come first; fingers have none.
    root = values.shape[1] % 4
    with np.errstate(invalid="ignore", over="ignore"):
        finite &= (np.abs(values[:, :root]) <= FARTHEST_M).all(axis=1)
        rotations = values[:, root:].reshape(len(values), -1, 4).astype(np.float64)
        length = np.sqrt(np.einsum("njk,njk->nj", rotations, rotations))
        unit = (np.abs(length - 1.0) <= UNIT_TOLERANCE).all(axis=1)
    return FrameFlags(non_finite=~finite, non_unit=finite & ~unit)


def flag_batches(batches: Sequence[Batch]) -> Iterator[FrameFlags]:
    """Yield the flags of each batch. Checking many together is much cheaper than one by one."""
    widths = {batch.header.values_per_frame for batch in batches}
    flags = {
        width: _flags([one for one in batches if one.header.values_per_frame == width])
        for width in widths
    }
    for batch in batches:
        yield next(flags[batch.header.values_per_frame])


def _flags(batches: Sequence[Batch]) -> Iterator[FrameFlags]:
    """Yield the flags of batches of the same width."""
    for group in _grouped(batches):
        flags = flag_frames(
            np.concatenate([batch.times_s for batch in group]),
            np.concatenate([batch.values for batch in group]),
        )
        end = 0
        for batch in group:
            first, end = end, end + batch.header.frame_count
            yield FrameFlags(flags.non_finite[first:end], flags.non_unit[first:end])


def _grouped(batches: Sequence[Batch]) -> Iterator[list[Batch]]:
    group: list[Batch] = []
    frames = 0
    for batch in batches:
        group.append(batch)
        frames += batch.header.frame_count
        if frames >= FRAMES_AT_ONCE:
            yield group
            group, frames = [], 0
    if group:
        yield group
