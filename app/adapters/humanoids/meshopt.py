"""Decode the buffer views of `EXT_meshopt_compression` and `KHR_meshopt_compression`.

Three codecs: columns of bytes for vertices, a pair of queues for triangles, and differences for
other indices. They are written here, because the only package for Python has no wheels and is an
alpha version. Every read is checked against the data, and loops are bounded by the number of
elements, so a damaged stream gives an error or wrong numbers, and nothing else.

Versions 0 and 1 of the vertex codec are read: `EXT_meshopt_compression` has the first,
`KHR_meshopt_compression` both.

Source: Khronos, EXT_meshopt_compression and KHR_meshopt_compression, sections "Bitstream" and
"Filters".
"""

from array import array

import numpy as np
import numpy.typing as npt

from app.adapters.humanoids.container import varint
from app.science.compiled import compiled_checked

Bytes = npt.NDArray[np.uint8]
_TAIL_BYTES, _GROUP, _CODES = 32, 16, 16
_LARGEST = 0xFFFFFFFF
_TRIANGLES, _ATTRIBUTES, _INDICES = 0xE1, 0xA0, 0xD1


class StreamError(ValueError):
    """A compressed stream is damaged, or of an unknown version."""


def decoded(mode: str, stream: bytes, count: int, stride: int, filter_: str) -> bytes:
    """Return the `count` elements, of `stride` bytes each, that a stream contains.

    Args:
        mode: ATTRIBUTES, TRIANGLES or INDICES.
        stream: the compressed bytes.
        count: how many elements; for TRIANGLES a multiple of 3.
        stride: 2 or 4 for indices, a multiple of 4 up to 256 for attributes.
        filter_: NONE or EXPONENTIAL. Others are for normals and rotations.

    Raises:
        StreamError: the stream ends too early, is not of this mode, or refers to an element that
            does not exist.
    """
    try:
        if mode == "ATTRIBUTES":
            data = np.frombuffer(stream, dtype=np.uint8)
            return _filtered(_attributes(data, count, stride), filter_)
        found = (_triangles if mode == "TRIANGLES" else _indices)(stream, count)
    except IndexError as error:
        raise StreamError("the compressed data end too early") from error
    except StreamError:
        raise
    except ValueError as error:
        raise StreamError(str(error)) from error
    words = np.frombuffer(found, dtype=np.uintc)
    if stride == 2 and words.max(initial=0) > np.iinfo(np.uint16).max:
        raise StreamError("an index does not fit into its 2 bytes")
    return words.astype("<u2" if stride == 2 else "<u4").tobytes()


def _filtered(elements: Bytes, filter_: str) -> bytes:
    if filter_ == "NONE":
        return bytes(elements.tobytes())
    words = elements.reshape(-1).view("<i4")
    # An eight-bit exponent above a twenty-four-bit mantissa, both with a sign.
    exponent, mantissa = words >> 24, (words << 8) >> 8
    with np.errstate(over="ignore"):
        return bytes(np.ldexp(mantissa.astype(np.float64), exponent).astype("<f4").tobytes())


@compiled_checked
def _column(data: Bytes, at: int, groups: int, narrowest: int, column: Bytes) -> int:
    """Decode one byte of each element of a block, in groups of 16; return where the next begins.

    For each group two bits say in how many bits its bytes are stored: `narrowest` or one of the
    next three of 0, 1, 2, 4 and 8 (in version 0 without 1). A narrow byte whose bits are all set
    means that the whole byte is stored after the group.
    """
    header = at
    at += (groups + 3) // 4
    for group in range(groups):
        mode = (data[header + group // 4] >> (2 * (group % 4))) & 3
        bits = (0, 2, 4, 8, 0, 1, 2, 4, 8)[narrowest + mode]
        start = group * _GROUP
        if bits == 0:
            column[start : start + _GROUP] = 0
        elif bits == 8:
            for k in range(_GROUP):
                column[start + k] = data[at + k]
            at += _GROUP
        else:
            full, per_byte = (1 << bits) - 1, 8 // bits
            extra = at + _GROUP // per_byte
            for k in range(_GROUP):
                within = k % per_byte
                # Single bits begin with the lowest, all others with the highest.
                shift = within if bits == 1 else 8 - bits * (within + 1)
                value = (data[at + k // per_byte] >> shift) & full
                if value == full:
                    value = data[extra]
                    extra += 1
                column[start + k] = value
            at = extra
    return at


@compiled_checked
def _block_columns(
    data: Bytes, at: int, size: int, stride: int, version: int, columns: Bytes
) -> int:
    """Decode the columns of a block of `size` elements; return where the next block begins.

    Version 1 has two bits for each column: narrow groups, wide groups, all zero, or not packed.
    """
    groups = (size + _GROUP - 1) // _GROUP
    control = at
    at += version * (stride // 4)
    for number in range(stride):
        kind = 0
        if version > 0:
            kind = (data[control + number // 4] >> (2 * (number % 4))) & 3
        if kind == 3:
            for k in range(size):
                columns[number, k] = data[at + k]
            at += size
        elif kind == 2:
            columns[number] = 0
        else:
            narrowest = 0 if version == 0 else 4 + kind
            at = _column(data, at, groups, narrowest, columns[number])
    return at


@compiled_checked
def _attributes(data: Bytes, count: int, stride: int) -> Bytes:
    """Decode `count` elements of `stride` bytes, (count, stride).

    A block holds one column of bytes after the other, as differences from each element to the
    next. The first element is stored as its difference to an element at the end of the stream.
    Differences are between single bytes; in version 1 a byte at the very end says for every four
    columns whether they are between bytes, between pairs, or the exclusive or of all four.
    """
    version = data[0] & 15 if len(data) else 0
    channels = version * (stride // 4)
    tail = max(24 if version > 0 else _TAIL_BYTES, stride + channels)
    if len(data) < 1 + tail:
        raise ValueError("the compressed vertices are shorter than their beginning and end")
    if data[0] & 240 != _ATTRIBUTES or version > 1:
        raise ValueError("the compressed vertices are of an unknown version")
    elements = np.zeros((count, stride), dtype=np.uint8)
    last = data[len(data) - stride - channels : len(data) - channels].copy()
    most = min((8192 // stride) & ~15, 256)
    columns = np.zeros((stride, 256), dtype=np.uint8)
    at = 1
    for first in range(0, count, most):
        size = min(most, count - first)
        at = _block_columns(data, at, size, stride, version, columns)
        if at > len(data) - tail:
            raise ValueError("the compressed vertices end too early")
        for four in range(0, stride, 4):
            channel = 0 if version == 0 else int(data[len(data) - channels + four // 4])
            if channel & 3 == 3:
                raise ValueError("the compressed vertices have an unknown kind of difference")
            wide = 1 << (channel & 3)
            for column in range(four, four + 4, wide):
                _add(columns, column, wide, channel, elements[first : first + size], last)
    return elements


@compiled_checked
def _add(
    columns: Bytes, column: int, wide: int, channel: int, elements: Bytes, last: Bytes
) -> None:
    """Add up the differences of numbers of 1, 2 or 4 bytes, lowest first, from `last` on."""
    every = (1 << (8 * wide)) - 1
    turn = channel >> 4
    value = 0
    for byte in range(wide):
        value |= int(last[column + byte]) << (8 * byte)
    for k in range(len(elements)):
        code = 0
        for byte in range(wide):
            code |= int(columns[column + byte, k]) << (8 * byte)
        if wide == 4:
            value ^= ((code >> turn) | (code << (32 - turn))) & every
        else:
            value = (value + ((code >> 1) ^ -(code & 1))) & every
        for byte in range(wide):
            elements[k, column + byte] = (value >> (8 * byte)) & 255
    for byte in range(wide):
        last[column + byte] = (value >> (8 * byte)) & 255


def _indices(data: bytes, count: int) -> "array[int]":
    """Decode a sequence of indices, each stored as its difference to one of two earlier ones."""
    if len(data) < 1 + count + 4:
        raise StreamError("the compressed indices are shorter than their number")
    if data[0] != _INDICES:
        raise StreamError("the compressed indices are of an unknown version")
    found = array("I")
    last = [0, 0]
    at = 1
    for _ in range(count):
        value, at = varint(data, at)
        which = value & 1
        last[which] = _changed(last[which], value >> 1)
        found.append(last[which])
    return found


def _triangles(data: bytes, count: int) -> "array[int]":
    """Decode triangles: each shares one of the last 16 edges, or has three corners of its own."""
    if count % 3 or len(data) < 1 + count // 3 + _CODES:
        raise StreamError("the compressed triangles are shorter than their number")
    if data[0] != _TRIANGLES:
        raise StreamError("the compressed triangles are of an unknown version")
    return _TriangleDecoder(data, 1 + count // 3).decoded(count // 3)


class _TriangleDecoder:
    """The state of the triangle codec: two queues, the next new vertex, and the last one."""

    def __init__(self, data: bytes, at: int) -> None:
        self._data, self._at = data, at
        self._table = len(data) - _CODES
        self._edges = [(0, 0)] * _CODES
        self._corners = [0] * _CODES
        self._edge = self._corner = 0
        self._next = self._last = 0

    def decoded(self, triangles: int) -> "array[int]":
        found = array("I")
        for code in self._data[1 : 1 + triangles]:
            a, b, c = self._continued(code) if code < 0xF0 else self._anew(code)
            found.extend((a, b, c))
            self._push_edge(c, b)
            self._push_edge(a, c)
            if self._at > self._table:
                raise StreamError("the compressed triangles end too early")
        return found

    def _continued(self, code: int) -> tuple[int, int, int]:
        """Return a triangle that shares an earlier edge."""
        a, b = self._edges[(self._edge - 1 - (code >> 4)) & 15]
        which = code & 15
        if 0 < which < 13:
            return a, b, self._corners[(self._corner - 1 - which) & 15]
        if which == 0:
            c = self._following()
        elif which == 15:
            c = self._spelled()
        else:
            c = self._last = (self._last + (1 if which == 14 else -1)) & _LARGEST
        self._push_corner(c)
        return a, b, c

    def _anew(self, code: int) -> tuple[int, int, int]:
        """Return a triangle that shares no edge.

        A code below 0xFE refers to the table of codes at the end, in which 15 means an earlier
        corner like any other. Otherwise the corners follow here, and 15 means one in full.
        """
        here = code >= 0xFE
        if here:
            pair = self._data[self._at]
            self._at += 1
            if pair == 0:
                self._next = 0
        else:
            pair = self._data[self._table + (code & 15)]
        which = (15 if code == 0xFF else 0, pair >> 4, pair & 15)
        # First all corners that refer to earlier ones, and only then those stored in full.
        corners = [
            self._following() if one == 0 else self._corners[(self._corner - one) & 15]
            for one in which
        ]
        for row, one in enumerate(which):
            if here and one == 15:
                corners[row] = self._spelled()
        for corner, one in zip(corners, which, strict=True):
            if one == 0 or (here and one == 15):
                self._push_corner(corner)
        a, b, c = corners
        self._push_edge(b, a)
        return a, b, c

    def _following(self) -> int:
        self._next += 1
        return self._next - 1

    def _spelled(self) -> int:
        value, self._at = varint(self._data, self._at)
        self._last = _changed(self._last, value)
        return self._last

    def _push_corner(self, corner: int) -> None:
        self._corners[self._corner & 15] = corner
        self._corner += 1

    def _push_edge(self, start: int, end: int) -> None:
        self._edges[self._edge & 15] = (start, end)
        self._edge += 1


def _changed(last: int, value: int) -> int:
    """Return a number that a zigzag-coded difference leads to, as 32 bits."""
    return (last + ((value >> 1) ^ -(value & 1))) & _LARGEST
