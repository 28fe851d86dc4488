"""Count what a model costs to draw: triangles, vertices, and the sizes of its textures.

Sizes of textures are read from the headers of PNG, JPEG, WebP and KTX2 images in the file; no image
is decoded, as the server draws none. Browsers and headsets do draw them, and a picture of a few
kilobytes can ask for gigabytes there, so `check_textures` limits what the headers state.

Source: W3C, PNG 3rd edition, 11.2.1; ITU-T T.81, B.2.2; RFC 9649 (WebP), 2.5 to 2.7; Khronos, KTX
2.0, 3.1.
"""

import struct
from collections.abc import Sequence
from dataclasses import dataclass

from app.adapters.humanoids.accessors import Tables
from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.document import Document, Image, Primitive

Bytes = bytes | memoryview
_TRIANGLES, _STRIPS_AND_FANS = 4, (5, 6)
MOST_TEXTURES = 1_000
MOST_SIDE_PX = 8_192
MOST_PIXELS = 200_000_000
"""Total number of pixels; with four bytes each and smaller copies (mipmaps), about 1 GiB."""
_MOST_JPEG_SEGMENTS = 1_000
_VALID = "PNG, JPEG, WebP and KTX2"
_UNSIZED = {b"GIF8": "GIF", b"BM": "BMP", b"\0\0\x01\0": "ICO", b"<": "SVG"}
_KTX2 = b"\xabKTX 20\xbb\r\n\x1a\n"


@dataclass(frozen=True)
class Texture:
    """An image in a file; width and height are 0 where its header could not be read.

    `problem`: why the image must not be drawn; empty if nothing is wrong with its header, or if it
    is no image that any browser draws.
    """

    media_type: str
    width: int
    height: int
    size_bytes: int
    problem: str = ""


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


def check_textures(textures: Sequence[Texture]) -> None:
    """Raise HumanoidFileError if an image is damaged or too large, or if all are together."""
    if len(textures) > MOST_TEXTURES:
        raise HumanoidFileError(
            f"The model has {len(textures)} pictures; up to {MOST_TEXTURES} are read. Export it"
            " with fewer textures.",
            "images",
        )
    for number, one in enumerate(textures):
        if one.problem:
            raise HumanoidFileError(one.problem, f"images.{number}")
        if max(one.width, one.height) > MOST_SIDE_PX:
            raise HumanoidFileError(
                f"The picture has {one.width:,} x {one.height:,} pixels; up to {MOST_SIDE_PX:,} a"
                " side are valid. Reduce the texture, to 2,048 for a standalone headset, and"
                " export the model again.",
                f"images.{number}",
            )
    pixels = sum(one.width * one.height for one in textures)
    if pixels > MOST_PIXELS:
        raise HumanoidFileError(
            f"The {len(textures)} pictures have {pixels:,} pixels together; up to {MOST_PIXELS:,}"
            " are valid. Reduce the largest textures and export the model again.",
            "images",
        )


def _textures(document: Document, tables: Tables) -> list[Texture]:
    if len(document.images) > MOST_TEXTURES:
        return [Texture("", 0, 0, 0)] * len(document.images)
    found = []
    for number, image in enumerate(document.images):
        try:
            data = tables.image(image, f"images.{number}")
            problem = ""
        except HumanoidFileError as error:
            # Without its other file the skin would silently be drawn without this texture.
            data, problem = memoryview(b""), error.reason if _is_elsewhere(image) else ""
        media_type, width, height = size_of_image(data)
        problem = problem or _problem(data, media_type, width, height)
        found.append(Texture(media_type, width, height, len(data), problem))
    return found


def _is_elsewhere(image: Image) -> bool:
    return image.bufferView is None and not (image.uri or "data:").startswith("data:")


def _problem(data: Bytes, media_type: str, width: int, height: int) -> str:
    """Return why an image must not be drawn, from its header; empty if it may."""
    other = next((kind for start, kind in _UNSIZED.items() if data[: len(start)] == start), "")
    if data[4:8] == b"ftyp":
        other = "AVIF or HEIF"
    if other:
        return f"The picture is {other}; valid are {_VALID}. Convert it and export the model again."
    if media_type and not (width and height):
        return (
            f"The picture begins like {media_type} but states no size, so it is damaged. Replace"
            " the texture and export the model again."
        )
    if media_type != "image/ktx2":
        return ""
    try:
        depth, layers, faces, levels, packing = struct.unpack_from("<IIIII", data, 28)
        # The index of the levels: place, length, and length without the packing (ZSTD, ZLIB).
        plain = [struct.unpack_from("<QQQ", data, 80 + 24 * at)[2] for at in range(min(levels, 32))]
    except struct.error:
        return ""  # Without an index no level can be read, so nothing is drawn.
    if depth or layers > 1 or faces > 1:
        return (
            f"The KTX2 picture has depth {depth}, {layers} layers and {faces} faces; valid is one"
            " flat picture. Export the texture as one picture."
        )
    # At most 16 bytes a pixel, twice, because smaller copies add a third.
    if packing and max(plain, default=0) > 32 * width * height + 65_536:
        return (
            f"The KTX2 picture of {width} x {height} pixels unpacks to {max(plain):,} bytes, which"
            " cannot be right. Compress the texture again."
        )
    return ""


def size_of_image(data: Bytes) -> tuple[str, int, int]:
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


def _jpeg(data: Bytes) -> tuple[int, int]:
    at = 2
    for _ in range(_MOST_JPEG_SEGMENTS):
        if data[at] != 0xFF:
            break
        marker = data[at + 1]
        if marker == 0xFF or marker == 1 or 0xD0 <= marker <= 0xD8:
            at += 1 if marker == 0xFF else 2  # A byte of padding; a marker without a length.
            continue
        # Any start of a frame; C4, C8 and CC are tables.
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            height, width = struct.unpack_from(">HH", data, at + 5)
            return width, height
        at += 2 + struct.unpack_from(">H", data, at + 2)[0]
    return 0, 0


def _webp(data: Bytes) -> tuple[int, int]:
    kind = data[12:16]
    if kind == b"VP8X":
        return 1 + int.from_bytes(data[24:27], "little"), 1 + int.from_bytes(data[27:30], "little")
    if kind == b"VP8L":
        bits = struct.unpack_from("<I", data, 21)[0]
        return 1 + (bits & 0x3FFF), 1 + (bits >> 14 & 0x3FFF)
    width, height = struct.unpack_from("<HH", data, 26)
    return width & 0x3FFF, height & 0x3FFF
