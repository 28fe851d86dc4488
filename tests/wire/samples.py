"""Batches of plausible and of invalid frames."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.wire import FINGER_VALUES_PER_FRAME, VALUES_PER_FRAME, StreamName, encode_batch

RATE_HZ = 90.0
CONTACT_REPORT: dict[str, Any] = {
    "kind": "contact",
    "surface": "hand/2/left",
    "surface_kind": "side",
    "box": 2,
    "side": "left",
    "body_part": "RightHand",
    "begin_s": 1.0,
    "end_s": 2.0,
    "begin_active_s": 0.5,
    "end_active_s": 1.5,
    "effect": "side",
}
"""The body of a contact report without its phase."""


def standing(count: int) -> NDArray[np.float32]:
    """Return frames (count, 91) of a body in rest pose, 1 m above the floor."""
    values = np.zeros((count, VALUES_PER_FRAME), np.float32)
    values[:, 1] = 1.0
    values[:, 3::4] = 1.0
    return values


def resting_fingers(count: int) -> NDArray[np.float32]:
    """Return frames (count, 120) of fingers that lie flat, as in the T-pose."""
    values = np.zeros((count, FINGER_VALUES_PER_FRAME), np.float32)
    values[:, 0::4] = 1.0
    return values


def without_left_hand(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return frames of fingers (count, 120) in which the left hand is not tracked."""
    changed = values.copy()
    changed[:, : FINGER_VALUES_PER_FRAME // 2] = np.nan
    return changed


def bits(values: NDArray[np.float32]) -> NDArray[np.uint32]:
    """Return the raw bits, by which different NaNs can be distinguished."""
    return np.ascontiguousarray(values).view(np.uint32)


def every_odd_float() -> NDArray[np.float32]:
    """Return frames with quiet and signalling NaNs, infinities, denormals and -0."""
    odd = np.array(
        [
            *(0x7FC00000, 0x7FC12345, 0x7F800001, 0xFFC00001, 0xFFFFFFFF, 0x7F800000, 0xFF800000),
            *(0x00000001, 0x807FFFFF, 0x80000000, 0x7F7FFFFF),
        ],
        np.uint32,
    ).view(np.float32)
    values = standing(len(odd))
    bits(values)[:, 7] = bits(odd)
    return values


def message(
    values: NDArray[np.float32],
    *,
    stream: StreamName = StreamName.TARGET,
    epoch: int = 1,
    phase_id: int = 0,
    seq_first: int = 0,
    times_s: NDArray[np.float64] | None = None,
    active: bool = False,
    active_s: float = 0.0,
) -> bytes:
    """Return a batch of these frames at 90 per second."""
    count = len(values)
    if times_s is None:
        times_s = (seq_first + np.arange(count)) / RATE_HZ
    return encode_batch(
        stream,
        epoch=epoch,
        phase_id=phase_id,
        seq_first=seq_first,
        times_s=times_s,
        flags=np.full(count, active, np.uint8),
        values=values,
        active_s=active_s,
        closed_at_s=float(np.nan_to_num(times_s[-1])),
    )
