"""A decoder of "f32-predicted-zstd/1" written from docs/telemetry-encoding.md with plain lists."""

import math
import struct
import zlib
from dataclasses import dataclass

import zstandard

U32, U64 = 1 << 32, 1 << 64


@dataclass(frozen=True)
class PlainChunk:
    """The bits of the times (n), the flags (n), and the bits of the values (n of w)."""

    times: list[int]
    flags: list[int]
    values: list[list[int]]


class Bits:
    """Read numbers of any width, highest bit first."""

    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0

    def take(self, width: int) -> int:
        """Return the next `width` bits as a number."""
        number = 0
        for _ in range(width):
            byte = self._data[self._at // 8]
            number = number << 1 | byte >> (7 - self._at % 8) & 1
            self._at += 1
        return number


def decode_plainly(data: bytes) -> PlainChunk:
    """Decode a chunk by following the document step by step."""
    crc, n, w, length = struct.unpack_from("<IIHI", data)
    assert zlib.crc32(data[4:]) == crc
    raw = memoryview(zstandard.ZstdDecompressor().decompress(data[14 : 14 + length]))
    bits = Bits(data[14 + length :])
    joint_count, root = divmod(w, 4)
    ends = [0]
    for size in (joint_count, w - joint_count, w, 1, n, 8 * n, 4 * w * n):
        ends.append(ends[-1] + size)
    joints, top, rows, time_order, flags, times, high, exceptions = (
        raw[begin:end] for begin, end in zip(ends, [*ends[1:], len(raw)], strict=True)
    )
    numbers = _planes(high, 4)
    low = [rows[at // n] & 31 for at in range(w * n)]
    zigzag = [number << k | bits.take(k) for number, k in zip(numbers, low, strict=True)]
    summed = [_summed(zigzag[row * n : (row + 1) * n], rows[row] >> 5, U32) for row in range(w)]
    whole = iter(_planes(exceptions, 4))
    kept = [
        [next(whole) if c == 0 else _float_bits(c, top[row], bits) for c in summed[row]]
        for row in range(w - joint_count)
    ]
    columns = kept[:root]
    for joint in range(joint_count):
        three = kept[root + 3 * joint : root + 3 + 3 * joint]
        off = summed[w - joint_count + joint]
        expected = [_expected(frame, joints[joint]) for frame in zip(*three, strict=True)]
        restored = [(e + d) % U32 for e, d in zip(expected, off, strict=True)]
        three.insert(joints[joint] & 3, restored)
        columns += three
    return PlainChunk(
        [number % U64 for number in _summed(_planes(times, 8), time_order[0], U64)],
        list(flags),
        [list(frame) for frame in zip(*columns, strict=True)],
    )


def _planes(planes: memoryview, size: int) -> list[int]:
    count = len(planes) // size
    return [sum(planes[p * count + at] << 8 * p for p in range(size)) for at in range(count)]


def _summed(zigzag: list[int], order: int, modulus: int) -> list[int]:
    d = [z >> 1 ^ -(z & 1) for z in zigzag]
    for t in range(order, 0, -1):
        for i in range(t, len(d)):
            d[i] += d[i - 1]
    return [(number + modulus // 2) % modulus - modulus // 2 for number in d]


def _float_bits(coarse: int, top: int, bits: Bits) -> int:
    missing = 24 - abs(coarse).bit_length()
    significand = abs(coarse) << missing | bits.take(missing)
    sign = 1 if coarse < 0 else 0
    return sign << 31 | (top - missing) << 23 | significand & 0x7FFFFF


def _expected(three: tuple[int, ...], joint: int) -> int:
    a, b, c = (struct.unpack("<f", struct.pack("<I", bits))[0] for bits in three)
    s = 1.0 - ((a * a + b * b) + c * c)
    root = math.sqrt(s) if s > 0.0 else 0.0
    negative = bool(joint & 4)
    bits: int = struct.unpack("<I", struct.pack("<f", root))[0]
    return bits | negative << 31
