"""The current encoding: compress what cannot be predicted (see docs/telemetry-encoding.md).

"f32-predicted-zstd/1" in steps, each reversed by its own module:

1. of every joint's unit quaternion one component follows from the other three (`unit_quaternions`);
2. the floats that remain become integer multiples of a unit per row (`significands`);
3. these, the left-out components and the frame times are predicted from the previous frames
   (`integers`);
4. of every row the low bits, which are noise and would not compress, are cut off and stored as they
   are, together with the remainders of step 2 (`integers`); the high bits, of the same small size
   in all rows, go through zstd as byte planes.

    offset  type    field
    0       u32     CRC-32 of everything after it
    4       u32     n, the number of frames
    8       u16     w, values per frame: 4 for each joint, after the r = w mod 4 of the root
    10      u32     length z of the zstd frame
    14      u8[z]   zstd frame of the parts below
    14 + z  bits    low bits of all rows, then the remainders of the floats

    u8[joints]          the component that is left out, and its sign
    u8[r + 3 joints]    exponent of the unit of each kept column
    u8[w]               per row: 32 x order of its differences + number of its low bits
    u8                  order of the differences of the times
    u8[n]               flags
    u64[n] in planes    differences of the times' bits
    u32[w, n] in planes high bits of the differences: kept columns first, left-out components last
    u32[...] in planes  exceptions of the floats

All numbers are little-endian; bits begin at the highest of a byte.
"""

import struct
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
import zstandard
from numpy.typing import NDArray

from app.features.record.telemetry.encodings.columns import (
    Columns,
    DamagedChunkError,
    from_planes,
    to_planes,
)
from app.features.record.telemetry.encodings.integers import best_differences, pack, summed, unpack
from app.features.record.telemetry.encodings.significands import (
    Significands,
    cut,
    joined,
    rest_widths,
)
from app.features.record.telemetry.encodings.unit_quaternions import LeftOut, choose

NAME = "f32-predicted-zstd/1"
LEVEL = 1
_HEADER = struct.Struct("<IIHI")
_CHECKED_FROM = 4
_LOW_BITS = np.uint8(31)
_ORDER_AT = np.uint8(5)
# Enough for zstd to model the distribution of the noise, so that its code is close to the entropy.
_BITS_TO_COMPRESS = 4


def encode(columns: Columns, *, level: int = LEVEL) -> bytes:
    """Encode a chunk of at least one frame: 3 values of a root, or none, and 4 of each joint.

    Raises ValueError for other shapes.

    `level` is the compression level of zstd; decoding does not depend on it.
    """
    n, w = columns.values.shape
    if n < 1 or w % 4 not in (0, 3):
        raise ValueError(f"values of shape ({n}, {w}); expected (n >= 1, 0 or 3 + 4 x joints)")
    bits = np.ascontiguousarray(columns.values.T, np.float32).view(np.uint32)
    left_out = choose(bits)
    kept = bits[left_out.kept_rows]
    floats = cut(kept)
    unforeseen = (bits[left_out.rows] - left_out.expected(kept)).view(np.int32)
    order, differences = best_differences(np.concatenate((floats.coarse, unforeseen)))
    time_bits = np.ascontiguousarray(columns.times_s, np.float64).view(np.int64)
    time_order, time_differences = best_differences(time_bits.reshape(1, n))
    low_bits = _noisy_bits(differences)
    parts = (
        left_out.as_bytes(),
        floats.top.tobytes(),
        ((order << _ORDER_AT) | low_bits.astype(np.uint8)).tobytes(),
        time_order.tobytes(),
        columns.flags.astype(np.uint8, copy=False).tobytes(),
        to_planes(time_differences),
        to_planes(differences >> low_bits[:, np.newaxis]),
        to_planes(floats.exceptions),
    )
    low = differences & ((np.uint32(1) << low_bits) - np.uint32(1))[:, np.newaxis]
    noise = pack(
        np.concatenate((low.ravel(), floats.rest.ravel())),
        np.concatenate((_each(low_bits, n), floats.rest_widths.ravel())),
    )
    return _sealed(n, w, zstandard.ZstdCompressor(level=level).compress(b"".join(parts)), noise)


def decode(data: bytes, frame_count: int, values_per_frame: int) -> Columns:
    """Decode a chunk; raises DamagedChunkError if the data are not what was encoded."""
    compressed, noise = _checked(data, frame_count, values_per_frame)
    n, w = frame_count, values_per_frame
    joints = w // 4
    parts = _Parts(zstandard.ZstdDecompressor().decompress(compressed))
    left_out = LeftOut.of_bytes(parts.take(joints, np.uint8), w % 4)
    top = parts.take(w - joints, np.uint8)
    row_bytes = parts.take(w, np.uint8)
    time_order = parts.take(1, np.uint8)
    flags = parts.take(n, np.uint8)
    time_bits = summed(time_order, parts.take(n, np.uint64).reshape(1, n))
    high = parts.take(n * w, np.uint32).reshape(w, n)
    low_bits = (row_bytes & _LOW_BITS).astype(np.uint32)
    low = unpack(noise, _each(low_bits, n)).reshape(w, n)
    rows = summed(row_bytes >> _ORDER_AT, (high << low_bits[:, np.newaxis]) | low)
    coarse = rows[: w - joints]
    widths = rest_widths(coarse)
    rest = unpack(noise, widths.ravel(), n * int(low_bits.sum())).reshape(coarse.shape)
    kept = joined(Significands(top, coarse, rest, widths, parts.rest(np.uint32)))
    bits = np.empty((w, n), np.uint32)
    bits[left_out.kept_rows] = kept
    bits[left_out.rows] = rows[w - joints :].view(np.uint32) + left_out.expected(kept)
    return Columns(
        time_bits.ravel().view(np.float64), flags, np.ascontiguousarray(bits.T).view(np.float32)
    )


def _sealed(frame_count: int, values_per_frame: int, compressed: bytes, noise: bytes) -> bytes:
    header = _HEADER.pack(0, frame_count, values_per_frame, len(compressed))
    checked = b"".join((header[_CHECKED_FROM:], compressed, noise))
    return struct.pack("<I", zlib.crc32(checked)) + checked


def _checked(data: bytes, frame_count: int, values_per_frame: int) -> tuple[bytes, bytes]:
    """Verify a chunk, and return its zstd frame and the bits after it."""
    if len(data) < _HEADER.size:
        raise DamagedChunkError(f"it has {len(data)} bytes, fewer than its header")
    crc, n, w, length = _HEADER.unpack_from(data)
    found = zlib.crc32(memoryview(data)[_CHECKED_FROM:])
    if found != crc:
        raise DamagedChunkError(f"its checksum is {found:#010x} and was {crc:#010x} when written")
    if (n, w) != (frame_count, values_per_frame):
        raise DamagedChunkError(
            f"it holds {n} frames of {w} values, its row says {frame_count} of {values_per_frame}"
        )
    return data[_HEADER.size : _HEADER.size + length], data[_HEADER.size + length :]


@dataclass
class _Parts:
    """Reads the decompressed parts of a chunk one after the other."""

    raw: bytes
    at: int = 0

    def take(self, count: int, number: type[Any]) -> NDArray[Any]:
        length = count * np.dtype(number).itemsize
        part = np.frombuffer(self.raw, np.uint8, length, self.at)
        self.at += length
        return from_planes(part, number)

    def rest(self, number: type[Any]) -> NDArray[Any]:
        return from_planes(np.frombuffer(self.raw, np.uint8, offset=self.at), number)


def _noisy_bits(differences: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Return how many low bits (rows,) of each row's differences are incompressible, 0 to 28."""
    lengths: NDArray[np.float64] = np.frexp(differences.astype(np.float64))[1].mean(axis=1)
    noisy: NDArray[np.uint32] = np.maximum(np.rint(lengths) - _BITS_TO_COMPRESS, 0.0).astype(
        np.uint32
    )
    return noisy


def _each(widths: NDArray[np.uint32], count: int) -> NDArray[np.int64]:
    return np.repeat(widths.astype(np.int64), count)
