"""Chunks in compressed columns, bit for bit what came.

"f32-columns-zstd/1": zstd over the concatenation of `times_s` f64[n], `flags` u8[n] and `values`
transposed to f32[w][n] with the four bytes of every float split into planes. Columns of one joint
change little from frame to frame, and their high bytes hardly at all, so planes compress well.
"""

from dataclasses import dataclass

import numpy as np
import zstandard
from numpy.typing import NDArray

ENCODING = "f32-columns-zstd/1"
LEVEL = 3


@dataclass(frozen=True)
class Frames:
    """Consecutive frames of a stream.

    `seq` (n,), `times_s` (n,) client monotonic s, `flags` (n,) bits, `values` (n, 91) as on the
    wire: root position (m, world), then 22 local rotations w, x, y, z.
    """

    seq: NDArray[np.int64]
    times_s: NDArray[np.float64]
    flags: NDArray[np.uint8]
    values: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.seq)

    @property
    def rotations(self) -> NDArray[np.float64]:
        """Local rotations (n, 22, 4), w x y z."""
        with np.errstate(invalid="ignore"):  # a signalling NaN is allowed to be there
            return self.values[:, 3:].reshape(len(self), -1, 4).astype(np.float64)

    @property
    def active(self) -> NDArray[np.bool_]:
        """Frames (n,) during which the phase's clock ran."""
        return (self.flags & 1).astype(np.bool_)


def encode_frames(
    times_s: NDArray[np.float64], flags: NDArray[np.uint8], values: NDArray[np.float32]
) -> bytes:
    """Compress columns; the inverse of `decode_frames`."""
    columns = np.ascontiguousarray(values.T, "<f4")
    planes = columns.view(np.uint8).reshape(-1, 4).T
    raw = b"".join(
        (
            np.ascontiguousarray(times_s, "<f8").tobytes(),
            np.ascontiguousarray(flags, "u1").tobytes(),
            np.ascontiguousarray(planes).tobytes(),
        )
    )
    return zstandard.ZstdCompressor(level=LEVEL).compress(raw)


def decode_frames(
    data: bytes, *, encoding: str, seq_first: int, frame_count: int, values_per_frame: int
) -> Frames:
    """The frames of a chunk; raises ValueError for an encoding this version does not know."""
    if encoding != ENCODING:
        raise ValueError(f"unknown encoding {encoding!r}; this version reads {ENCODING!r}")
    n, w = frame_count, values_per_frame
    raw = zstandard.ZstdDecompressor().decompress(data, max_output_size=9 * n + 4 * n * w)
    planes = np.frombuffer(raw, np.uint8, 4 * n * w, 9 * n).reshape(4, n * w)
    columns = np.ascontiguousarray(planes.T).view("<f4").reshape(w, n)
    return Frames(
        seq=np.arange(seq_first, seq_first + n),
        times_s=np.frombuffer(raw, "<f8", n, 0),
        flags=np.frombuffer(raw, np.uint8, n, 8 * n),
        values=np.ascontiguousarray(columns.T),
    )
