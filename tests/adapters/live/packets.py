"""Packets of trackers for tests: OSC messages and bundles, NatNet of every version, JSON.

The encoders are written from the protocols' descriptions, not from the decoders.
"""

import struct
from collections.abc import Mapping, Sequence
from types import MappingProxyType

Version = tuple[int, int]
Row = tuple[int, tuple[float, float, float], tuple[float, float, float, float], bool]
"""A body of a frame: id, position, quaternion w, x, y, z, whether it is tracked."""
BUNDLE = b"#bundle\0" + bytes(7) + b"\1"


def osc(address: str, *arguments: float | int | str) -> bytes:
    """Return an OSC message with floats, 32-bit integers and strings."""
    tags = "".join({float: "f", int: "i", str: "s"}[type(one)] for one in arguments)
    body = b"".join(
        _padded(one) if isinstance(one, str) else struct.pack(f">{tag}", one)
        for tag, one in zip(tags, arguments, strict=True)
    )
    return _padded(address) + _padded(f",{tags}") + body


def bundle(*elements: bytes) -> bytes:
    """Return an OSC bundle to be processed immediately."""
    return BUNDLE + b"".join(struct.pack(">i", len(one)) + one for one in elements)


def vmc(name: str, *, what: str = "Tra", at: Sequence[float] = (0.1, 0.9, 0.2)) -> bytes:
    """Return a pose as VMC sends it, in Unity's axes, not rotated."""
    return osc(f"/VMC/Ext/{what}/Pos", name, *map(float, at), 0.0, 0.0, 0.0, 1.0)


def server_info(version: Version, name: str = "Motive") -> bytes:
    """Return the answer to a NatNet client that connects."""
    return _message(1, name.encode().ljust(256, b"\0") + bytes((2, 1, 0, 0, *version, 0, 0)))


def definitions(
    version: Version,
    rigid_bodies: Mapping[int, str],
    skeletons: Mapping[int, tuple[str, Mapping[int, str]]],
    tree: Mapping[int, tuple[int, Sequence[float]]] = MappingProxyType({}),
) -> bytes:
    """Return NatNet's definitions: a marker set, rigid bodies, skeletons with their bones.

    `tree` has the parent and the offset of each bone of a skeleton; others have no parent.

    From 4.1 on also a kind of definition that does not exist, which its size lets readers skip.
    """
    parts = [(0, b"all\0" + struct.pack("<i", 1) + b"Marker 1\0")]
    parts += [(1, _definition(version, key, name)) for key, name in rigid_bodies.items()]
    for key, (name, bones) in skeletons.items():
        body = name.encode() + b"\0" + struct.pack("<2i", key, len(bones))
        body += b"".join(
            _definition(version, one, bone, tree.get(one)) for one, bone in bones.items()
        )
        parts.append((2, body))
    if version >= (4, 1):
        parts.insert(0, (99, b"unknown"))
    body = struct.pack("<i", len(parts))
    for kind, part in parts:
        body += struct.pack("<i", kind) + _sized(version, part)
    return _message(5, body)


def frame(
    version: Version,
    number: int,
    time_s: float,
    rigid_bodies: Sequence[Row] = (),
    skeletons: Mapping[int, Sequence[Row]] | None = None,
) -> bytes:
    """Return a NatNet frame with an item in every section that the version has."""
    body = struct.pack("<i", number)
    body += _section(version, [b"all\0" + struct.pack("<i3f", 1, 0.1, 0.2, 0.3)])
    body += _section(version, [struct.pack("<3f", 0.1, 0.2, 0.3)])
    body += _section(version, [_row(version, row) for row in rigid_bodies])
    if version > (2, 0):
        body += _section(
            version,
            [
                struct.pack("<2i", key, len(rows))
                + b"".join(_row(version, (key << 16 | row[0], *row[1:])) for row in rows)
                for key, rows in (skeletons or {}).items()
            ],
        )
    if version >= (4, 1):
        asset = struct.pack("<2i", 9, 1) + _row(version, (1, (1, 2, 3), (1, 0, 0, 0), True))
        asset += struct.pack("<i", 1) + struct.pack("<i3ffhf", 5, 1, 2, 3, 0.01, 0, 0.001)
        body += _section(version, [asset])
    if version >= (2, 3):
        marker = struct.pack("<i3ff", 7, 0.1, 0.2, 0.3, 0.02)
        marker += struct.pack("<h", 10) if version >= (2, 6) else b""
        marker += struct.pack("<f", 0.001) if version >= (3, 0) else b""
        body += _section(version, [marker])
    plate = struct.pack("<2i", 1, 2) + 2 * struct.pack("<i2f", 2, 0.5, 0.6)
    body += _section(version, [plate]) if version >= (2, 9) else b""
    body += _section(version, [plate]) if version >= (2, 11) else b""
    body += struct.pack("<f", 0.002) if version < (3, 0) else b""
    body += struct.pack("<2I", 0, 0)
    body += struct.pack("<d" if version >= (2, 7) else "<f", time_s)
    body += struct.pack("<3Q", 1, 2, 3) if version >= (3, 0) else b""
    body += struct.pack("<2I", 4, 5) if version >= (4, 1) else b""
    return _message(7, body + struct.pack("<hi", 0, 0))


def _message(kind: int, body: bytes) -> bytes:
    return struct.pack("<HH", kind, len(body)) + body


def _sized(version: Version, part: bytes) -> bytes:
    return (struct.pack("<i", len(part)) if version >= (4, 1) else b"") + part


def _section(version: Version, items: Sequence[bytes]) -> bytes:
    return struct.pack("<i", len(items)) + _sized(version, b"".join(items))


def _row(version: Version, row: Row) -> bytes:
    identity, position, (w, x, y, z), tracked = row
    body = struct.pack("<i3f4f", identity, *position, x, y, z, w)
    if version < (3, 0):  # two markers: positions, ids, sizes
        body += struct.pack("<i6f2i2f", 2, *range(6), 1, 2, 0.02, 0.02)
    body += struct.pack("<f", 0.0005)
    return body + (struct.pack("<h", int(tracked)) if version >= (2, 6) else b"")


def _definition(
    version: Version, identity: int, name: str, place: tuple[int, Sequence[float]] | None = None
) -> bytes:
    parent, offset = place or (-1, (0.0, 0.0, 0.0))
    body = name.encode() + b"\0" + struct.pack("<2i3f", identity, parent, *offset)
    if version >= (3, 0):
        body += struct.pack("<i6f2i", 2, *range(6), 0, 0)
    return body + (b"Marker 1\0Marker 2\0" if version >= (4, 0) else b"")


def _padded(text: str) -> bytes:
    data = text.encode() + b"\0"
    return data + bytes(-len(data) % 4)
