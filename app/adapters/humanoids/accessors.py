"""Read tables of numbers from a file's buffers; every size is checked against the data.

Source: Khronos, glTF 2.0 specification, sections 3.6.2 (accessors) and 3.11 (normalised integers).
"""

from typing import Any, Final

import numpy as np
import numpy.typing as npt

from app.adapters.humanoids.container import HumanoidFileError, embedded
from app.adapters.humanoids.document import Accessor, Document, Draco, Image, Meshopt
from app.science.rotations import FloatArray

_TYPES: Final[dict[int, np.dtype[Any]]] = {
    5120: np.dtype("<i1"), 5121: np.dtype("<u1"), 5122: np.dtype("<i2"), 5123: np.dtype("<u2"),
    5125: np.dtype("<u4"), 5126: np.dtype("<f4"),
}  # fmt: skip
_WIDTHS: Final = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
IndexArray = npt.NDArray[np.int64]


class Tables:
    """The accessors of one file.

    Args:
        document: the file's JSON.
        binary: the binary chunk of a GLB.
        most_values: the largest total number of values that may be read.
    """

    def __init__(self, document: Document, binary: bytes | None, most_values: int) -> None:
        self._document, self._binary, self._left = document, binary, most_values
        self._buffers: dict[int, bytes] = {}
        self._plain: dict[int, bytes] = {}

    def floats(self, number: int, kind: str) -> FloatArray:
        """Return (N, width) numbers; normalised integers are scaled to -1 or 0 to 1.

        Raises:
            HumanoidFileError: the accessor does not exist, is of another kind, extends beyond its
                buffer, or contains non-finite numbers.
        """
        accessor, place = self._accessor(number)
        return self.scaled(number, self._table(accessor, kind, place))

    def scaled(self, number: int, table: npt.NDArray[Any]) -> FloatArray:
        """Return the numbers of a table as an accessor says; raises the same errors as `floats`."""
        accessor, place = self._accessor(number)
        with np.errstate(invalid="ignore"):  # a signalling NaN is refused below like any other
            values = table.astype(np.float64)
        if accessor.normalized and table.dtype.kind in "iu":
            values = np.maximum(values / float(np.iinfo(table.dtype).max), -1.0)
        if not np.isfinite(values).all():
            raise HumanoidFileError("It has numbers that are not finite.", place)
        return values

    def whole(self, number: int, kind: str) -> IndexArray:
        """Return (N, width) non-negative integers; raises the same errors as `floats`."""
        accessor, place = self._accessor(number)
        table = self._table(accessor, kind, place)
        if table.dtype.kind != "u":
            raise HumanoidFileError(
                f"Its component type is {accessor.componentType}; valid are whole numbers without"
                " sign: 5121, 5123, 5125.",
                place,
            )
        return table.astype(np.int64)

    def _accessor(self, number: int) -> tuple[Accessor, str]:
        place = f"accessors.{number}"
        if number >= len(self._document.accessors):
            raise HumanoidFileError(
                f"There is no such accessor: the file has {len(self._document.accessors)}.", place
            )
        return self._document.accessors[number], place

    def _table(self, accessor: Accessor, kind: str, place: str) -> npt.NDArray[Any]:
        if accessor.type != kind or accessor.componentType not in _TYPES:
            raise HumanoidFileError(
                f"It is {accessor.type} of {accessor.componentType}; here {kind} of one of"
                f" {', '.join(map(str, _TYPES))} is valid.",
                place,
            )
        if accessor.bufferView is None or accessor.sparse is not None:
            raise HumanoidFileError(
                "It has no data of its own: the table is sparse, or compressed in an unknown way."
                " Export the model without sparse tables, or compressed by meshopt or Draco.",
                place,
            )
        width = _WIDTHS[kind]
        self.take(accessor.count * width, place)
        view, stride = self._view(accessor.bufferView, place)
        dtype = _TYPES[accessor.componentType]
        size = width * dtype.itemsize
        stride = size if stride is None else stride
        end = accessor.byteOffset + (accessor.count - 1) * stride + size
        if stride < size or end > len(view):
            raise HumanoidFileError(
                f"It wants {end} bytes, {stride} for each of {accessor.count}, of the"
                f" {len(view)} of its buffer view {accessor.bufferView}.",
                place,
            )
        return np.ndarray(
            (accessor.count, width), dtype, view, accessor.byteOffset, (stride, dtype.itemsize)
        )

    def draco(self, draco: Draco, place: str) -> bytes:
        """Return the Draco stream of a primitive; raises HumanoidFileError."""
        return bytes(self._view(draco.bufferView, place)[0])

    def image(self, image: Image, place: str) -> memoryview:
        """Return the bytes of an image in the file, not copied; raises HumanoidFileError."""
        if image.bufferView is not None:
            return self._view(image.bufferView, place)[0]
        return memoryview(embedded(image.uri or "", place))

    def accessor(self, number: int) -> Accessor:
        """Return an accessor's description; raises HumanoidFileError if there is none."""
        return self._accessor(number)[0]

    def take(self, values: int, place: str) -> None:
        """Count values that are about to be read; raises HumanoidFileError if they are too many."""
        self._left -= values
        if self._left < 0:
            raise HumanoidFileError(
                "The file has more numbers than are read. Export the model with fewer vertices.",
                place,
            )

    def _view(self, number: int, place: str) -> tuple[memoryview, int | None]:
        views = self._document.bufferViews
        if number >= len(views):
            raise HumanoidFileError(f"There is no buffer view {number} of {len(views)}.", place)
        view, at = views[number], f"bufferViews.{number}"
        if view.compressed is not None:
            return memoryview(self._decompressed(number, view.compressed)), view.byteStride
        data = self._slice(view.buffer, view.byteOffset, view.byteLength, at)
        return data, view.byteStride

    def _slice(self, buffer: int, start: int, length: int, place: str) -> memoryview:
        data = self._buffer(buffer, place)
        end = start + length
        if end > len(data):
            raise HumanoidFileError(
                f"It ends at byte {end}, but the buffer has {len(data)} bytes.", place
            )
        return memoryview(data)[start:end]

    def _decompressed(self, number: int, packed: Meshopt) -> bytes:
        """Decompress a view once; its size is checked before memory is taken for it."""
        place = f"bufferViews.{number}"
        if number in self._plain:
            return self._plain[number]
        if packed.filter not in ("NONE", "EXPONENTIAL"):
            raise HumanoidFileError(
                f"Its filter is {packed.filter!r}; for positions, bones and weights only NONE and"
                " EXPONENTIAL are valid.",
                place,
            )
        valid = packed.byteStride % 4 == 0 if packed.mode == "ATTRIBUTES" else packed.byteStride < 5
        if not valid or packed.byteStride == 3:
            raise HumanoidFileError(
                f"Its elements cannot have {packed.byteStride} bytes each; 2 or 4 are valid for"
                " indices, and multiples of 4 for others.",
                place,
            )
        # Bytes that nobody asks for count as well, because a view is decompressed as a whole.
        self.take(packed.count * max(1, packed.byteStride // 4), place)
        stream = self._slice(packed.buffer, packed.byteOffset, packed.byteLength, place)
        # Imported here because it loads a compiler, which few files need.
        from app.adapters.humanoids.meshopt import StreamError, decoded

        try:
            plain = decoded(
                packed.mode, bytes(stream), packed.count, packed.byteStride, packed.filter
            )
        except StreamError as error:
            raise HumanoidFileError(f"It cannot be decompressed: {error}.", place) from None
        self._plain[number] = plain
        return plain

    def _buffer(self, number: int, place: str) -> bytes:
        if number in self._buffers:
            return self._buffers[number]
        buffers = self._document.buffers
        if number >= len(buffers):
            raise HumanoidFileError(f"There is no buffer {number} of {len(buffers)}.", place)
        buffer, at = buffers[number], f"buffers.{number}"
        if buffer.uri is not None:
            data = embedded(buffer.uri, at)
        elif number == 0 and self._binary is not None:
            data = self._binary
        else:
            raise HumanoidFileError("The buffer is not in the file.", at)
        if len(data) < buffer.byteLength:
            raise HumanoidFileError(f"The buffer has {len(data)} of {buffer.byteLength} bytes.", at)
        self._buffers[number] = data[: buffer.byteLength]
        return self._buffers[number]
