"""Encode frames as compressed chunks without loss of a single bit, and decode them.

A chunk names its encoding, and every encoding that was ever written can be read: `encodings` has a
module for each. New chunks are written in `ENCODING`, described in docs/telemetry-encoding.md.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.features.record.telemetry.encodings import f32_columns, f32_predicted
from app.features.record.telemetry.encodings.columns import Columns, DamagedChunkError

__all__ = ["ENCODING", "DamagedChunkError", "Frames", "decode_frames", "encode_frames"]

ENCODING = f32_predicted.NAME
_DECODERS: dict[str, Callable[[bytes, int, int], Columns]] = {
    f32_predicted.NAME: f32_predicted.decode,
    f32_columns.NAME: f32_columns.decode,
}


@dataclass(frozen=True)
class Frames:
    """Consecutive frames of a stream.

    `seq` (n,), `times_s` (n,) client monotonic s, `flags` (n,) bits, `values` as on the wire:
    (n, 91) for a body: root position (m, world), then 22 local rotations w, x, y, z; (n, 120) for
    fingers: 30 local rotations.
    """

    seq: NDArray[np.int64]
    times_s: NDArray[np.float64]
    flags: NDArray[np.uint8]
    values: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.seq)

    @property
    def rotations(self) -> NDArray[np.float64]:
        """Return the local rotations w, x, y, z: (n, 22, 4) of a body, (n, 30, 4) of fingers."""
        with np.errstate(invalid="ignore"):  # the values may contain signalling NaNs
            joints, root = divmod(self.values.shape[1], 4)
            return self.values[:, root:].reshape(len(self), joints, 4).astype(np.float64)

    @property
    def active(self) -> NDArray[np.bool_]:
        """Return which frames (n,) were recorded while the phase's clock ran."""
        return (self.flags & 1).astype(np.bool_)


def encode_frames(
    times_s: NDArray[np.float64], flags: NDArray[np.uint8], values: NDArray[np.float32]
) -> bytes:
    """Compress the columns of at least one frame; the inverse of `decode_frames`."""
    return f32_predicted.encode(Columns(times_s, flags, values))


def decode_frames(
    data: bytes, *, encoding: str, seq_first: int, frame_count: int, values_per_frame: int
) -> Frames:
    """Decode the frames of a chunk.

    Raises:
        DamagedChunkError: the bytes are damaged, or belong to another chunk.
        ValueError: the encoding is unknown to this version.
    """
    decode = _DECODERS.get(encoding)
    if decode is None:
        names = ", ".join(repr(name) for name in _DECODERS)
        raise ValueError(f"unknown encoding {encoding!r}; this version reads {names}")
    columns = decode(data, frame_count, values_per_frame)
    return Frames(
        seq=np.arange(seq_first, seq_first + frame_count),
        times_s=columns.times_s,
        flags=columns.flags,
        values=columns.values,
    )
