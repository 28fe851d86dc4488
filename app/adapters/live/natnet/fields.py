"""Read the fields of a NatNet packet in order, never beyond its end."""

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from app.adapters.live.readings import Quaternion, Refused, Vector

MAX_TEXT = 256


class Fields:
    """The bytes of a packet and a position in it; each method reads a field and moves on.

    All raise Refused if the packet ends before the field does.
    """

    def __init__(self, data: bytes, version: tuple[int, int]) -> None:
        self.version = version
        self._data = data
        self._at = 0

    @property
    def left(self) -> int:
        """The number of bytes that were not read yet."""
        return len(self._data) - self._at

    def skip(self, size: int) -> None:
        """Move on by `size` bytes."""
        if not 0 <= size <= self.left:
            raise Refused("malformed")
        self._at += size

    def numbers(self, layout: str) -> tuple[float, ...]:
        """Return the numbers of a layout of `struct`, little-endian."""
        start = self._at
        self.skip(struct.calcsize(f"<{layout}"))
        return struct.unpack_from(f"<{layout}", self._data, start)

    def rows(self, layout: struct.Struct, count: int) -> Iterator[tuple[Any, ...]]:
        """Return rows of a layout of fixed size: much faster than reading field by field."""
        start = self._at
        self.skip(layout.size * count)
        return layout.iter_unpack(memoryview(self._data)[start : self._at])

    def integer(self, layout: str = "i") -> int:
        """Return one integer, of four bytes and signed unless `layout` says otherwise."""
        return int(self.numbers(layout)[0])

    def count(self, smallest: int) -> int:
        """Return how many items of at least `smallest` bytes follow, if so many can follow."""
        count = self.integer()
        if not 0 <= count * smallest <= self.left:
            raise Refused("malformed")
        return count

    def text(self) -> str:
        """Return a text that a zero byte ends; bytes that are not UTF-8 become question marks."""
        end = self._data.find(b"\0", self._at, self._at + MAX_TEXT)
        if end < 0:
            raise Refused("malformed")
        text = self._data[self._at : end].decode(errors="replace").replace("\ufffd", "?")
        self._at = end + 1
        return text

    def vector(self) -> Vector:
        """Return x, y, z."""
        x, y, z = self.numbers("3f")
        return (x, y, z)

    def quaternion(self) -> Quaternion:
        """Return a quaternion, sent as x, y, z, w, as w, x, y, z."""
        x, y, z, w = self.numbers("4f")
        return (w, x, y, z)

    @contextmanager
    def sized(self) -> Iterator[None]:
        """Read a part that from 4.1 on begins with its size in bytes, which must be right."""
        if self.version < (4, 1):
            yield
            return
        size = self.integer()
        if not 0 <= size <= self.left:
            raise Refused("malformed")
        end = self._at + size
        yield
        if self._at != end:
            raise Refused("malformed")

    def skip_sized(self) -> bool:
        """Skip a part that begins with its size; return False before 4.1, where it has none."""
        if self.version < (4, 1):
            return False
        self.skip(self.integer())
        return True
