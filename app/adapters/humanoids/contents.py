"""Count what a model costs to draw: triangles, vertices, and the sizes of its textures.

Sizes of textures are read from the headers of PNG, JPEG, WebP and KTX2 images in the file; no image
is decoded, as the server draws none.

Source: W3C, PNG 3rd edition, 11.2.1; ITU-T T.81, B.2.2; RFC 9649 (WebP), 2.5 to 2.7; Khronos, KTX
2.0, 3.1.
"""

import struct
from collections.abc import Sequence
from dataclasses import dataclass

from app.adapters.humanoids.accessors import Tables
from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.document import Document, Primitive

_TRIANGLES, _STRIPS_AND_FANS = 4, (5, 6)
_KTX2 = b"\xabKTX 20\xbb\r\n\x1a\n"


@dataclass(frozen=True)
class Texture:
    """An image in a file; width and height are 0 where its header could not be read."""

    media_type: str
    width: int
    height: int
    size_bytes: int


@dataclass(frozen=True)
class Contents:
    """How much of a file has to be drawn.

    A mesh counts once for each node that has it. Textures count with their compressed bytes.
    """

    triangles: int
    vertices: int
    textures: tuple[Texture, ...]


def contents_of(document: Document, tables: Tables) -> Contents:
    """Count triangles, vertices and textures; what is damaged counts as nothing."""
    triangles = vertices = 0
    costs = [_cost(mesh.primitives, document) for mesh in document.meshes]
    for node in document.nodes:
        if node.mesh is not None and node.mesh < len(costs):
            triangles += costs[node.mesh][0]
            vertices += costs[node.mesh][1]
    return Contents(triangles, vertices, tuple(_textures(document, tables)))


def _cost(primitives: Sequence[Primitive], document: Document) -> tuple[int, int]:
    triangles = vertices = 0
    for primitive in primitives:
        number = primitive.attributes.get("POSITION", len(document.accessors))
        if number >= len(document.accessors):
            continue
        points = document.accessors[number].count
        corners = points
        if primitive.indices is not None and primitive.indices < len(document.accessors):
            corners = document.accessors[primitive.indices].count
        if primitive.mode == _TRIANGLES:
            triangles, vertices = triangles + corners // 3, vertices + points
        elif primitive.mode in _STRIPS_AND_FANS:
            triangles, vertices = triangles + max(0, corners - 2), vertices + points
    return triangles, vertices


def _textures(document: Document, tables: Tables) -> list[Texture]:
    found = []
    for number, image in enumerate(document.images):
        try:
            data = tables.image(image, f"images.{number}")
        except HumanoidFileError:
            data = b""
        media_type, width, height = size_of_image(data)
        found.append(Texture(media_type, width, height, len(data)))
    return found


def size_of_image(data: bytes) -> tuple[str, int, int]:
    """Return the media type, width and height in pixels that an image's header states.

    The type is empty for unknown formats; the sizes are 0 if the header does not have them.
    """
    try:
        if data[:8] == b"\x89PNG\r\n\x1a\n":
            return "image/png", *struct.unpack_from(">II", data, 16)
        if data[:3] == b"\xff\xd8\xff":
            return "image/jpeg", *_jpeg(data)
        if data[:4] == b"RIFF" and data[8:12] == b"WEBP":
            return "image/webp", *_webp(data)
        if data[:12] == _KTX2:
            return "image/ktx2", *struct.unpack_from("<II", data, 20)
    except (struct.error, IndexError):
        return "", 0, 0
    return "", 0, 0


def _jpeg(data: bytes) -> tuple[int, int]:
    at = 2
    while data[at] == 0xFF:
        marker = data[at + 1]
        # Any start of a frame; C4, C8 and CC are tables.
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            height, width = struct.unpack_from(">HH", data, at + 5)
            return width, height
        at += 2 + struct.unpack_from(">H", data, at + 2)[0]
    return 0, 0


def _webp(data: bytes) -> tuple[int, int]:
    kind = data[12:16]
    if kind == b"VP8X":
        return 1 + int.from_bytes(data[24:27], "little"), 1 + int.from_bytes(data[27:30], "little")
    if kind == b"VP8L":
        bits = struct.unpack_from("<I", data, 21)[0]
        return 1 + (bits & 0x3FFF), 1 + (bits >> 14 & 0x3FFF)
    width, height = struct.unpack_from("<HH", data, 26)
    return width & 0x3FFF, height & 0x3FFF
