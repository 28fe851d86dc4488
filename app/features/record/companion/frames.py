"""Encode the poses in which a companion was shown as columns, and decode them.

A chunk has one row per pose that was sent to the headset while it showed the companion. Its
columns, little-endian, one after the other, are split into the first bytes of all rows, then the
second ones and so on (similar bytes side by side compress better): the times, then the pose. All
together is compressed by zlib:

    f64      source_s: time by the source's own clock, NaN if it sends none
    f64      arrival_s: when the packet arrived, by the server's monotonic clock
    f64      mapped_s: the source's time on the server's clock, or the arrival
    f64      sent_s: when the pose was sent to the headset, by the server's monotonic clock
    f32[3]   place of the hips x, y, z (m, the participant's room)
    f32[88]  rotations w, x, y, z of the 22 joints, each in its parent's frame
"""

import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.wire import VALUES_PER_FRAME

ENCODING = "companion_columns_1"
_TIMES = 4
_ROW_BYTES = 8 * _TIMES + 4 * VALUES_PER_FRAME


@dataclass(frozen=True, eq=False, slots=True)
class ShownFrame:
    """A pose of a companion as it was sent; `values` as in `app.wire.companion_pose`."""

    address: str
    source_s: float | None
    arrival_s: float
    mapped_s: float
    sent_s: float
    values: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class ShownFrames:
    """The poses of a chunk, in the order in which they were sent.

    Attributes:
        source_s, arrival_s, mapped_s, sent_s: (N,) seconds; see the module.
        values: (N, 91) place of the hips and rotations, as in `app.wire.companion_pose`.
    """

    source_s: NDArray[np.float64]
    arrival_s: NDArray[np.float64]
    mapped_s: NDArray[np.float64]
    sent_s: NDArray[np.float64]
    values: NDArray[np.float32]


def encode_frames(frames: Sequence[ShownFrame]) -> bytes:
    """Return the columns of at least one pose."""
    times = np.array(
        [
            (
                float("nan") if one.source_s is None else one.source_s,
                one.arrival_s,
                one.mapped_s,
                one.sent_s,
            )
            for one in frames
        ],
        dtype="<f8",
    )
    values = np.array([one.values for one in frames], dtype="<f4")
    return zlib.compress(b"".join(map(_planes, (times, values))), 1)


def decode_frames(count: int, data: bytes) -> ShownFrames:
    """Return the poses of a chunk; raises ValueError if its bytes are damaged."""
    try:
        raw = zlib.decompress(data)
    except zlib.error as error:
        raise ValueError(f"The poses of the companion are damaged: {error}.") from error
    if len(raw) != count * _ROW_BYTES:
        raise ValueError(
            f"The poses of the companion have {len(raw)} bytes; {count} have {count * _ROW_BYTES}."
        )
    split = 8 * _TIMES * count
    times = _rows(raw[:split], count).view("<f8")
    values = _rows(raw[split:], count).view("<f4")
    return ShownFrames(times[:, 0], times[:, 1], times[:, 2], times[:, 3], values)


def _planes(rows: NDArray[np.float64] | NDArray[np.float32]) -> bytes:
    return rows.view(np.uint8).reshape(len(rows), -1).T.tobytes()


def _rows(planes: bytes, count: int) -> NDArray[np.uint8]:
    return np.ascontiguousarray(np.frombuffer(planes, np.uint8).reshape(-1, count).T)
