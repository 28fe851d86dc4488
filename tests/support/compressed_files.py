"""Compress the model files of `humanoid_files` by meshopt or Draco.

The meshopt encoder is a plain one of our own: it uses every code of the format, but does not look
for the smallest result. Draco's is Google's.
"""

from collections.abc import Sequence
from typing import Any

import DracoPy
import numpy as np
import numpy.typing as npt

from tests.support.humanoid_files import glb, taken_apart

Json = dict[str, Any]
_SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
_WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_TYPES = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}


def meshopt_file(data: bytes) -> bytes:
    """Return a file with every view that vertices and triangles need compressed by meshopt."""
    document, binary = taken_apart(data)
    packed = bytearray()
    for number, view in enumerate(document["bufferViews"]):
        plain = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        accessor = next(one for one in document["accessors"] if one["bufferView"] == number)
        stride = _SIZES[accessor["componentType"]] * _WIDTHS[accessor["type"]]
        if accessor["type"] == "SCALAR":
            corners = np.frombuffer(plain, _TYPES[accessor["componentType"]]).tolist()
            whole = len(corners) % 3 == 0
            mode = "TRIANGLES" if whole else "INDICES"
            stream = triangles_stream(corners) if whole else indices_stream(corners)
        else:
            table = np.frombuffer(plain, np.uint8).reshape(-1, stride)
            mode, stream = "ATTRIBUTES", attributes_stream(table)
        view["extensions"] = {
            "EXT_meshopt_compression": {
                "buffer": 0,
                "byteOffset": len(packed),
                "byteLength": len(stream),
                "byteStride": stride,
                "mode": mode,
                "count": len(plain) // stride,
            }
        }
        view.update(buffer=1, byteOffset=0)
        packed += stream + bytes(-len(stream) % 4)
    document["buffers"] = [
        {"byteLength": len(packed)},
        {
            "byteLength": max(view["byteLength"] for view in document["bufferViews"]),
            "extensions": {"EXT_meshopt_compression": {"fallback": True}},
        },
    ]
    document["extensionsUsed"] = document["extensionsRequired"] = ["EXT_meshopt_compression"]
    return glb(document, bytes(packed))


def draco_file(data: bytes) -> bytes:
    """Return a file with its one mesh compressed by Draco, places to 18 bits."""
    document, binary = taken_apart(data)
    primitive = document["meshes"][0]["primitives"][0]
    tables = {
        name: _table(document, binary, number) for name, number in primitive["attributes"].items()
    }
    corners = _table(document, binary, primitive["indices"])[:, 0]
    corners = corners[: len(corners) // 3 * 3]
    stream = DracoPy.encode(
        tables["POSITION"],
        faces=corners.reshape(-1, 3).astype(np.uint32),
        quantization_bits=18,
        preserve_order=True,
        generic_attributes={
            1: tables["JOINTS_0"].astype(np.uint16),
            2: tables["WEIGHTS_0"].astype(np.float32),
        },
    )
    # The encoder numbers places after all others.
    numbers = {"POSITION": 3, "JOINTS_0": 1, "WEIGHTS_0": 2}
    offset = len(binary)
    for number in (*primitive["attributes"].values(), primitive["indices"]):
        del document["accessors"][number]["bufferView"]
    document["accessors"][primitive["indices"]]["count"] = len(corners)
    document["bufferViews"].append({"buffer": 0, "byteOffset": offset, "byteLength": len(stream)})
    primitive["extensions"] = {
        "KHR_draco_mesh_compression": {
            "bufferView": len(document["bufferViews"]) - 1,
            "attributes": numbers,
        }
    }
    document["buffers"][0]["byteLength"] = offset + len(stream)
    document["extensionsUsed"] = document["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    return glb(document, binary + stream)


def _table(document: Json, binary: bytes, number: int) -> npt.NDArray[Any]:
    accessor = document["accessors"][number]
    view = document["bufferViews"][accessor["bufferView"]]
    width = _WIDTHS[accessor["type"]]
    values = np.frombuffer(
        binary, _TYPES[accessor["componentType"]], accessor["count"] * width, view["byteOffset"]
    )
    return values.reshape(-1, width)


def attributes_stream(table: npt.NDArray[np.uint8], *, channel: int | None = None) -> bytes:
    """Return (N, stride) elements as a stream, each group with the fewest bits that it needs.

    Args:
        table: the elements.
        channel: the kind of difference, for version 1: 0 of bytes, 1 of pairs of bytes, 2 + 16 r of
            four by exclusive or, turned by r bits; None for version 0.
    """
    count, stride = table.shape
    columns = _differences(table, channel or 0)
    stream = bytearray(b"\xa0" if channel is None else b"\xa1")
    most = min((8192 // stride) & ~15, 256)
    for start in range(0, count, most):
        block = columns[start : start + most].T
        if channel is None:
            stream += b"".join(_column(column, (0, 2, 4, 8)) for column in block)
            continue
        control, packed = bytearray(stride // 4), bytearray()
        for number, column in enumerate(block):
            forms = (
                _column(column, (0, 1, 2, 4)),
                _column(column, (1, 2, 4, 8)),
                None if column.any() else b"",
                bytes(column.tolist()),
            )
            kind, form = min(
                ((kind, form) for kind, form in enumerate(forms) if form is not None),
                key=lambda one: len(one[1]),
            )
            control[number // 4] |= kind << (2 * (number % 4))
            packed += form
        stream += control + packed
    tail = table[0].tobytes()
    if channel is None:
        return bytes(stream + bytes(max(0, 32 - stride)) + tail)
    tail += bytes([channel]) * (stride // 4)
    return bytes(stream + bytes(max(0, 24 - len(tail))) + tail)


def _differences(table: npt.NDArray[np.uint8], channel: int) -> npt.NDArray[np.int64]:
    """Return the coded differences of elements to the ones before, (N, stride) bytes."""
    wide = 1 << (channel & 3)
    bits = 8 * wide
    numbers = table.view(f"<u{wide}").astype(np.int64)
    before = np.vstack((numbers[0], numbers[:-1]))
    if wide == 4:
        changed, turn = numbers ^ before, channel >> 4
        codes = (changed << turn | changed >> (32 - turn)) & 0xFFFFFFFF
    else:
        half = 1 << (bits - 1)
        difference = (numbers - before + half) % (1 << bits) - half
        codes = np.where(difference < 0, -2 * difference - 1, 2 * difference)
    found: npt.NDArray[np.int64] = codes.astype(f"<u{wide}").view(np.uint8).astype(np.int64)
    return found.reshape(table.shape)


def _column(column: npt.NDArray[np.int64], widths: Sequence[int]) -> bytes:
    """Return a column of bytes in groups of 16, each in the shortest of four widths."""
    groups = np.append(column, np.zeros(-len(column) % 16, dtype=np.int64)).reshape(-1, 16)
    header, packed = bytearray((len(groups) + 3) // 4), bytearray()
    for number, group in enumerate(groups):
        usable = [row for row, bits in enumerate(widths) if bits or not group.any()]
        mode = min(usable, key=lambda row: len(_group(group, widths[row])))
        header[number // 4] |= mode << (2 * (number % 4))
        packed += _group(group, widths[mode])
    return bytes(header + packed)


def _group(group: npt.NDArray[np.int64], bits: int) -> bytes:
    if bits in (0, 8):
        return b"" if bits == 0 else bytes(group.tolist())
    full = (1 << bits) - 1
    # Single bits begin with the lowest of a byte.
    order = group.reshape(2, 8)[:, ::-1].ravel() if bits == 1 else group
    packed = 0
    for code in order.tolist():
        packed = packed << bits | min(code, full)
    return packed.to_bytes(2 * bits, "big") + bytes(code for code in group.tolist() if code >= full)


def _number(value: int) -> bytes:
    found = bytearray()
    while value > 127:
        found.append(value & 127 | 128)
        value >>= 7
    return bytes((*found, value))


def _zigzag(difference: int) -> int:
    return -2 * difference - 1 if difference < 0 else 2 * difference


def indices_stream(indices: Sequence[int]) -> bytes:
    """Return a sequence of indices as a stream; each continues the nearer of two earlier ones."""
    stream, last = bytearray(b"\xd1"), [0, 0]
    for index in indices:
        which = min((0, 1), key=lambda one: abs(index - last[one]))
        stream += _number(_zigzag(index - last[which]) << 1 | which)
        last[which] = index
    return bytes(stream) + bytes(4)


def triangles_stream(corners: Sequence[int]) -> bytes:
    """Return triangles as a stream, in their order, each perhaps turned to begin elsewhere."""
    edges: list[tuple[int, int]] = []
    queue: list[int] = []
    following = last = 0
    codes, data = bytearray(), bytearray()
    for start in range(0, len(corners), 3):
        a, b, c = corners[start : start + 3]
        turns = ((a, b, c), (b, c, a), (c, a, b))
        shared = next(
            (
                (row, turn)
                for turn in turns
                for row, edge in enumerate(edges[:-16:-1])
                if edge == turn[:2]
            ),
            None,
        )
        if shared is not None:
            row, (a, b, c) = shared
            recent = queue[:-14:-1]
            if c == following:
                code, following = 0, following + 1
            elif c in recent[1:13]:
                code = recent.index(c, 1)
            elif c - last in (-1, 1):
                code, last = 13 + (c > last), c
            else:
                code = 15
                data += _number(_zigzag(c - last))
                last = c
            codes.append(row << 4 | code)
            if code == 0 or code >= 13:
                queue.append(c)
        elif (a, b, c) == (following, following + 1, following + 2):
            codes.append(0xF0)  # the first of the table: three new corners
            following += 3
            queue += [a, b, c]
            edges.append((b, a))
        else:
            codes.append(0xFF)
            data.append(0xFF)
            for corner in (a, b, c):
                data += _number(_zigzag(corner - last))
                last = corner
                queue.append(corner)
            edges.append((b, a))
        edges += [(c, b), (a, c)]
    return b"\xe1" + bytes(codes) + bytes(data) + bytes(16)
