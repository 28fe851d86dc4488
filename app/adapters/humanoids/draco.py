"""Decompress primitives of `KHR_draco_mesh_compression`, by Google's decoder (DracoPy).

The package is optional, because it takes 19 MB. The sizes in a stream's header are compared with
those of the file's accessors before the decoder takes memory for them.

Source: Google, Draco 3D Graphics Compression, bitstream specification 2.2, sections 2 and 5 to 7;
Khronos, KHR_draco_mesh_compression.
"""

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from app.adapters.humanoids.accessors import IndexArray, Tables
from app.adapters.humanoids.container import HumanoidFileError, varint
from app.adapters.humanoids.document import Primitive
from app.science.rotations import FloatArray

_HEADER = struct.Struct("<5sBBBBH")
_VERSION = (2, 2)
_MESH, _EDGEBREAKER = 1, 1
_WITHOUT = "Export the model without compression, or compressed by meshopt."
_AXES = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


@dataclass(frozen=True, eq=False)
class DracoMesh:
    """A decompressed primitive: its attributes by their numbers in the stream, and its corners."""

    attributes: Mapping[int, npt.NDArray[Any]]
    corners: IndexArray


class PrimitiveTables:
    """The attributes of one primitive by name, plain or compressed.

    Raises HumanoidFileError, as do its methods.
    """

    def __init__(self, tables: Tables, primitive: Primitive, place: str) -> None:
        self._tables, self._primitive, self._place = tables, primitive, place
        self._draco: DracoMesh | None = None
        packed = None if primitive.extensions is None else primitive.extensions.draco
        if (
            packed is not None
            and tables.accessor(primitive.attributes["POSITION"]).bufferView is None
        ):
            self._draco = self._decompressed(tables.draco(packed, place))

    def floats(self, name: str, kind: str) -> FloatArray:
        """Return (N, width) numbers of an attribute; see `Tables.floats`."""
        found = self._unpacked(name, kind)
        number = self._primitive.attributes[name]
        return (
            self._tables.floats(number, kind)
            if found is None
            else self._tables.scaled(number, found)
        )

    def whole(self, name: str, kind: str) -> IndexArray:
        """Return (N, width) whole numbers of an attribute; see `Tables.whole`."""
        found = self._unpacked(name, kind)
        if found is None:
            return self._tables.whole(self._primitive.attributes[name], kind)
        if found.dtype.kind != "u":
            raise HumanoidFileError(
                f"{name} has signed numbers; only unsigned ones are valid.", self._place
            )
        return found.astype(np.int64)

    def corners(self) -> IndexArray | None:
        """Return the vertex of every triangle corner; None if the vertices are used in order."""
        if self._draco is not None:
            return self._draco.corners
        if self._primitive.indices is None:
            return None
        return self._tables.whole(self._primitive.indices, "SCALAR")[:, 0]

    def _unpacked(self, name: str, kind: str) -> npt.NDArray[Any] | None:
        packed = None if self._primitive.extensions is None else self._primitive.extensions.draco
        if self._draco is None or packed is None or name not in packed.attributes:
            return None
        found = self._draco.attributes.get(packed.attributes[name])
        accessor = self._tables.accessor(self._primitive.attributes[name])
        shape = (accessor.count, _AXES[kind])
        if found is None or found.shape != shape or accessor.type != kind:
            has = "is not there" if found is None else f"has the shape {found.shape}"
            raise HumanoidFileError(f"{name} {has} when decompressed, not {shape}.", self._place)
        return found

    def _decompressed(self, stream: bytes) -> DracoMesh:
        attributes, indices = self._primitive.attributes, self._primitive.indices
        vertices = self._tables.accessor(attributes["POSITION"]).count
        corners = 0 if indices is None else self._tables.accessor(indices).count
        for number in attributes.values():
            self._tables.take(16 * self._tables.accessor(number).count, self._place)
        self._tables.take(corners, self._place)
        try:
            _check_sizes(stream, faces=corners // 3, vertices=vertices)
        except IndexError:
            raise HumanoidFileError("The Draco data end too early.", self._place) from None
        except ValueError as error:
            raise HumanoidFileError(str(error), self._place) from None
        return _decoded(stream, self._place)


def _check_sizes(stream: bytes, *, faces: int, vertices: int) -> None:
    """Raise ValueError if the sizes in a header are wrong, IndexError if it is too short."""
    if len(stream) < _HEADER.size:
        raise ValueError("The Draco data are shorter than their header.")
    mark, major, minor, kind, method, flags = _HEADER.unpack_from(stream)
    if mark != b"DRACO" or (major, minor) != _VERSION or kind != _MESH or method > _EDGEBREAKER:
        raise ValueError(
            f"The Draco data begin with {stream[:9]!r}; a mesh of version 2.2 is valid. {_WITHOUT}"
        )
    if flags:
        raise ValueError(f"The Draco data contain metadata, which are not read. {_WITHOUT}")
    at = _HEADER.size
    if method == _EDGEBREAKER:  # the kind of traversal, then vertices and faces
        has_vertices, at = varint(stream, at + 1)
        has_faces, at = varint(stream, at)
    else:
        has_faces, at = varint(stream, at)
        has_vertices, at = varint(stream, at)
    if has_faces != faces or has_vertices > vertices:
        raise ValueError(
            f"The Draco data have {has_faces} triangles and {has_vertices} vertices; the file says"
            f" {faces} and {vertices}."
        )


def _decoded(stream: bytes, place: str) -> DracoMesh:
    # Imported here because it is optional, and few files need it.
    try:
        import DracoPy
    except ImportError:
        raise HumanoidFileError(
            "The mesh is compressed by Draco, for which the package DracoPy is not installed."
            f' {_WITHOUT} Or install "reembody[draco]" on the server.',
            place,
        ) from None
    try:
        mesh = DracoPy.decode(stream)
    except MemoryError:
        raise HumanoidFileError(
            "Decompressing the Draco data needs too much memory.", place
        ) from None
    except (DracoPy.FileTypeException, TypeError, ValueError, RuntimeError) as error:
        raise HumanoidFileError(f"The Draco data are damaged: {error}", place) from None
    faces = getattr(mesh, "faces", None)
    if faces is None:
        raise HumanoidFileError("The Draco data have no triangles.", place)
    attributes = {int(one["unique_id"]): np.asarray(one["data"]) for one in mesh.attributes}
    return DracoMesh(attributes, np.asarray(faces).reshape(-1).astype(np.int64))
