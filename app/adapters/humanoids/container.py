"""Open the two forms of a glTF 2.0 file: JSON text, and the binary GLB with its chunks.

Source: Khronos, glTF 2.0 specification, sections 3.6.1.1 (buffers) and 4 (GLB).
"""

import base64
import binascii
import re
import struct
from dataclasses import dataclass
from typing import Final

_MAGIC: Final = b"glTF"
_JSON, _BIN = 0x4E4F534A, 0x004E4942
_MOST_JSON_VALUES: Final = 2_000_000
"""Maximum number of JSON values; in memory they take up to fifty times their size."""
_VALID: Final = "Valid are VRM (.vrm), glTF binary (.glb) and glTF in one file (.gltf)."
_AS_ONE_FILE = "Export the model as one file: glTF binary (.glb) or VRM."
_OTHERS: Final = {
    b"Kaydara FBX": "an FBX file",
    b"; FBX": "an FBX file",
    b"PK\x03\x04": "a ZIP archive",
    b"<mujoco": "a MuJoCo model",
    b"<robot": "a URDF robot",
    b"<collada": "a COLLADA file",
    b"<!doctype": "a web page",
    b"<html": "a web page",
    b"<": "an XML file",
    b"BLENDER": "a Blender file",
    b"OFF": "an OFF mesh",
    b"solid": "an STL mesh",
    b"PXR-USDC": "a USD scene",
    b"#usda": "a USD scene",
    b"ply\n": "a PLY mesh",
    b"ply\r": "a PLY mesh",
    b"HIERARCHY": "a recorded movement (BVH), which belongs on the page Captures",
    b"\x89PNG": "a picture",
    b"\xff\xd8\xff": "a picture",
    b"GIF8": "a picture",
    b"%PDF": "a PDF document",
}
"""What other files begin with, letters in either case; the first match counts."""
_XML_HEAD: Final = re.compile(rb"\s*(?:(?:<\?.*?\?>|<!--.*?-->)\s*)*", re.DOTALL)
"""White space, declarations and comments, which precede the first element of an XML file."""


class HumanoidFileError(ValueError):
    """A model's file cannot be read.

    Attributes:
        reason: what is wrong and what is valid.
        place: where in the file, such as `accessors.3`; empty for the whole file.
    """

    def __init__(self, reason: str, place: str = "") -> None:
        self.reason, self.place = reason, place
        super().__init__(f"{place}: {reason}" if place else reason)


@dataclass(frozen=True)
class Container:
    """The parts of a file: its JSON, and the binary chunk of a GLB."""

    text: bytes
    binary: bytes | None


def open_container(data: bytes) -> Container:
    """Split a file into its parts; raise HumanoidFileError if that is impossible."""
    found = _glb(data) if data[:4] == _MAGIC else Container(_plain(data), None)
    values = sum(found.text.count(mark) for mark in (b",", b"[", b"{"))
    if values > _MOST_JSON_VALUES:
        raise HumanoidFileError(
            f"Its JSON has more than {_MOST_JSON_VALUES} values. Export the model without"
            " animations."
        )
    return found


def embedded(uri: str, place: str) -> bytes:
    """Return the content of a buffer that is embedded in the JSON; raise HumanoidFileError."""
    head, comma, body = uri.partition(",")
    if not uri.startswith("data:"):
        raise HumanoidFileError(f"The file needs another one, {uri[:100]!r}. {_AS_ONE_FILE}", place)
    if not comma or not head.endswith(";base64"):
        raise HumanoidFileError(f"A buffer in the file must be base64. {_AS_ONE_FILE}", place)
    try:
        return base64.b64decode(body, validate=True)
    except (binascii.Error, ValueError) as error:
        raise HumanoidFileError(f"The buffer is not base64: {error}.", place) from None


def varint(data: bytes, at: int) -> tuple[int, int]:
    """Return a 32-bit number, stored in 7 bits per byte, lowest first, and the place after it.

    Raises IndexError if the data end before the number does.
    """
    value = 0
    for k in range(5):
        byte = data[at + k]
        value |= (byte & 127) << (7 * k)
        if byte < 128:
            break
    return value & 0xFFFFFFFF, at + k + 1


def _plain(data: bytes) -> bytes:
    text = data.removeprefix(b"\xef\xbb\xbf")
    if text[:100].lstrip()[:1] == b"{":
        return text
    raise HumanoidFileError(f"This is {_kind_of(text)}. {_VALID} {_AS_ONE_FILE}")


def _kind_of(data: bytes) -> str:
    """Return what a file is that is neither glTF nor VRM, in words."""
    if not data.strip():
        return "an empty file"
    head = data[:4096]
    found = _XML_HEAD.match(head)
    start = (head if found is None else head[found.end() :]).lower() or b"<"
    kinds = (kind for first, kind in _OTHERS.items() if start.startswith(first.lower()))
    return next(kinds, "neither glTF nor VRM")


def _glb(data: bytes) -> Container:
    if len(data) < 20:
        raise HumanoidFileError(f"The file ends after {len(data)} bytes. Copy it again.")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise HumanoidFileError(f"It is glTF version {version}; valid is 2. {_AS_ONE_FILE}")
    if length > len(data):
        raise HumanoidFileError(
            f"The file ends after {len(data)} of {length} bytes. Copy it again."
        )
    chunks: dict[int, bytes] = {}
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<II", data, at)
        if at + 8 + size > length:
            raise HumanoidFileError("The chunk goes on beyond the end of the file.", f"byte {at}")
        chunks.setdefault(kind, data[at + 8 : at + 8 + size])
        at += 8 + size
    if _JSON not in chunks:
        raise HumanoidFileError("The file has no JSON chunk, which describes its content.")
    return Container(chunks[_JSON], chunks.get(_BIN))
