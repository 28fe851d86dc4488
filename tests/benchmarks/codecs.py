"""Chunk encodings that need only numpy and zstd, including ours.

Numbers in the names are zstd's levels. All of them reproduce their input bit by bit.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import zstandard
from numpy.typing import NDArray

from app.features.record.telemetry.encodings import f32_columns, f32_predicted
from app.features.record.telemetry.encodings.columns import Columns, from_planes, to_planes
from app.features.record.telemetry.encodings.integers import best_differences, summed
from app.features.record.telemetry.encodings.unit_quaternions import LeftOut, choose

Bits = NDArray[np.uint32]
LEVEL = 3
SIGN = np.uint32(0x80000000)
_STEPS = np.uint32(8)


@dataclass(frozen=True)
class Codec:
    """An encoding of chunks: `decode(encode(columns), n, w)` returns the columns."""

    name: str
    encode: Callable[[Columns], bytes]
    decode: Callable[[bytes, int, int], Columns]


def own_codecs() -> list[Codec]:
    """Return the codecs from the simplest to the one in use; the latter at several levels."""
    return [
        Codec("frames as they are, zstd 3", _encode_plain, _decode_plain),
        Codec(f"{f32_columns.NAME} (before)", encode_columns, f32_columns.decode),
        _planes("xor with the frame before", _xored, _unxored),
        _planes("1st differences", partial(_differenced, times=1), partial(_summed, times=1)),
        _planes("2nd differences", partial(_differenced, times=2), partial(_summed, times=2)),
        _planes("3 of 4 components, 2nd differences", _three, _four),
        *(_predicted(level) for level in (1, 3, 6, 9)),
    ]


def encode_columns(columns: Columns) -> bytes:
    """Encode in the previous format, which the application can read but no longer writes."""
    raw = (
        np.ascontiguousarray(columns.times_s, "<f8").tobytes(),
        columns.flags.tobytes(),
        to_planes(columns.values.T),
    )
    return zstandard.ZstdCompressor(level=LEVEL).compress(b"".join(raw))


def bits_of(columns: Columns) -> Bits:
    """Return the bits of the values as rows (w, n)."""
    return np.ascontiguousarray(columns.values.T).view(np.uint32)


def values_of(rows: Bits) -> NDArray[np.float32]:
    """Return the values (n, w) of rows of bits."""
    return np.ascontiguousarray(rows.T).view(np.float32)


def ordered(bits: Bits) -> Bits:
    """Convert floats' bits to integers in the order of the floats; `unordered` reverses it."""
    return np.where(bits & SIGN, ~bits, bits | SIGN)


def unordered(bits: Bits) -> Bits:
    """Convert the result of `ordered` back to the bits of the floats."""
    return np.where(bits & SIGN, bits ^ SIGN, ~bits)


def _encode_plain(columns: Columns) -> bytes:
    raw = (columns.times_s.tobytes(), columns.flags.tobytes(), columns.values.tobytes())
    return zstandard.ZstdCompressor(level=LEVEL).compress(b"".join(raw))


def _decode_plain(data: bytes, n: int, w: int) -> Columns:
    raw = zstandard.ZstdDecompressor().decompress(data)
    values = np.frombuffer(raw, np.float32, offset=9 * n).reshape(n, w)
    return Columns(
        np.frombuffer(raw, np.float64, n), np.frombuffer(raw, np.uint8, n, 8 * n), values
    )


def _planes(
    name: str,
    forward: Callable[[Bits], tuple[bytes, Bits]],
    backward: Callable[[NDArray[np.uint8], Bits], Bits],
) -> Codec:
    """Apply `forward` to rows (w, n), then byte planes and zstd; times are stored as differences.

    `forward` returns the same number of rows, and the side information that `backward` needs.
    """

    def encode(columns: Columns) -> bytes:
        order, times = best_differences(columns.times_s.view(np.int64).reshape(1, -1))
        beside, rows = forward(bits_of(columns))
        raw = (order.tobytes(), to_planes(times), columns.flags.tobytes(), to_planes(rows), beside)
        return zstandard.ZstdCompressor(level=LEVEL).compress(b"".join(raw))

    def decode(data: bytes, n: int, w: int) -> Columns:
        raw = np.frombuffer(zstandard.ZstdDecompressor().decompress(data), np.uint8)
        order, times, flags, rows, beside = np.split(
            raw, np.cumsum([1, 8 * n, n, 4 * n * w], dtype=np.int64)
        )
        time_bits = summed(order, from_planes(times, np.uint64).reshape(1, n))
        bits = backward(beside, from_planes(rows, np.uint32).reshape(w, n))
        return Columns(time_bits.ravel().view(np.float64), flags, values_of(bits))

    return Codec(f"{name}, byte planes, zstd {LEVEL}", encode, decode)


def _xored(rows: Bits) -> tuple[bytes, Bits]:
    result = rows.copy()
    result[:, 1:] ^= rows[:, :-1]
    return b"", result


def _unxored(_beside: NDArray[np.uint8], rows: Bits) -> Bits:
    return np.bitwise_xor.accumulate(rows, axis=1)


def _differenced(rows: Bits, *, times: int) -> tuple[bytes, Bits]:
    """Return differences in the floats' order, with small magnitudes mapped to small numbers."""
    current = ordered(rows).view(np.int32)
    for _ in range(times):
        current = np.diff(current, axis=1, prepend=np.int32(0))
    return b"", ((current << 1) ^ (current >> 31)).view(np.uint32)


def _summed(_beside: NDArray[np.uint8], rows: Bits, *, times: int) -> Bits:
    one = np.uint32(1)
    current = (rows >> one).view(np.int32) ^ -(rows & one).view(np.int32)
    for _ in range(times):
        current = np.cumsum(current, axis=1, dtype=np.int32)
    return unordered(current.view(np.uint32))


def _three(rows: Bits) -> tuple[bytes, Bits]:
    """Predict one component of each quaternion from the others, stored as second differences."""
    left_out = choose(rows)
    kept = rows[left_out.kept_rows]
    # A few steps in either direction become a small number.
    unforeseen = rows[left_out.rows] - left_out.expected(kept) + _STEPS
    return left_out.as_bytes(), np.concatenate((_differenced(kept, times=2)[1], unforeseen))


def _four(beside: NDArray[np.uint8], rows: Bits) -> Bits:
    left_out = LeftOut.of_bytes(beside, len(rows) % 4)
    kept_count = len(rows) - len(beside)
    bits = np.empty_like(rows)
    kept = _summed(beside, rows[:kept_count], times=2)
    bits[left_out.kept_rows] = kept
    bits[left_out.rows] = rows[kept_count:] - _STEPS + left_out.expected(kept)
    return bits


def _predicted(level: int) -> Codec:
    def encode(columns: Columns) -> bytes:
        return f32_predicted.encode(columns, level=level)

    return Codec(f"{f32_predicted.NAME}, zstd {level}", encode, f32_predicted.decode)
