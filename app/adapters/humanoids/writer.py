"""Write a skinned figure as binary glTF 2.0 with VRM 1.0's description of its bones.

The file has one mesh with one skin (positions, normals, colours, and four bones with weights for
each vertex) and a node for each of the 52 parts, at rest in the T-pose and facing +z, as both
formats require. Where two colours meet, the points of the border are written twice, at the same
place with the same normal: so the colours change abruptly and the shading smoothly. The same figure
always gives the same bytes.

Sources: Khronos, glTF 2.0 specification, sections 3.7 (meshes, skins) and 4 (GLB); VRM Consortium,
VRM 1.0 specification, VRMC_vrm.
"""

import json
import struct
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import PARENT_OF, PART_NAMES
from app.science.avatar.mannequin import TONES, Mannequin, Tone
from app.science.rotations import FloatArray

GENERATOR: Final = "Reembody"
LICENCE: Final = "Apache-2.0"
_LICENCE_URL: Final = "https://www.apache.org/licenses/LICENSE-2.0"
_VRM_LICENCE_URL: Final = "https://vrm.dev/licenses/1.0/"
_COLOURS: Mapping[Tone, tuple[int, int, int]] = {
    "skin": (205, 160, 130),
    "shirt": (126, 158, 172),
    "trousers": (84, 99, 118),
}
"""Colours as seen on a screen (sRGB): of medium lightness, so that they stand out from white and
from black pages."""
_ARRAY, _INDICES = 34962, 34963
_FLOAT, _BYTE, _SHORT = 5126, 5121, 5123
_WHOLE = 65535
_FACING_Z = np.array((-1.0, 1.0, -1.0))
"""Turns a figure that faces -z so that it faces +z."""
_VRM_THUMB = {"Proximal": "Metacarpal", "Intermediate": "Proximal", "Distal": "Distal"}


def write_mannequin(figure: Mannequin, name: str) -> bytes:
    """Return the file (.glb, also valid as .vrm) of a figure."""
    file = _File()
    vertices, triangles, tones = _split_by_tone(figure)
    primitive = {
        "attributes": {
            "POSITION": file.table(
                (figure.points_m[vertices] * _FACING_Z).astype("<f4"), "VEC3", bounds=True
            ),
            "NORMAL": file.table((figure.normals[vertices] * _FACING_Z).astype("<f4"), "VEC3"),
            "COLOR_0": file.table(_colours(tones), "VEC4", normalised=True),
            "JOINTS_0": file.table(figure.parts[vertices].astype("<u1"), "VEC4"),
            "WEIGHTS_0": file.table(
                _whole_weights(figure.weights[vertices]), "VEC4", normalised=True
            ),
        },
        "indices": file.table(triangles.reshape(-1, 1).astype("<u2"), "SCALAR", target=_INDICES),
        "material": 0,
        "mode": 4,
    }
    places = {part: np.array(place) for part, place in figure.body.places_m().items()}
    inverse = np.tile(np.eye(4), (len(PART_NAMES), 1, 1))
    inverse[:, :3, 3] = [-places[part] * _FACING_Z for part in PART_NAMES]
    matrices = inverse.swapaxes(1, 2).reshape(-1, 16).astype("<f4")
    tree = {
        "asset": {
            "version": "2.0",
            "generator": GENERATOR,
            "copyright": f"Reembody, {LICENCE}",
            "extras": {
                "licence": LICENCE,
                "stature_m": figure.body.stature_m,
                "segments_m": {key: float(m) for key, m in figure.body.segments_m.items()},
            },
        },
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": _nodes(places, name),
        "meshes": [{"name": name, "primitives": [primitive]}],
        "skins": [
            {
                "joints": [1 + number for number in range(len(PART_NAMES))],
                "skeleton": 1,
                "inverseBindMatrices": file.table(matrices, "MAT4", target=None),
            }
        ],
        "materials": [
            {
                "name": "body",
                "pbrMetallicRoughness": {
                    "baseColorFactor": [1.0, 1.0, 1.0, 1.0],
                    "metallicFactor": 0.0,
                    "roughnessFactor": 0.85,
                },
            }
        ],
        "extensionsUsed": ["VRMC_vrm"],
        "extensions": {"VRMC_vrm": _vrm(name)},
    }
    return file.glb(tree)


class _File:
    """The tables of a file while it is written."""

    def __init__(self) -> None:
        self._binary = bytearray()
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []

    def table(
        self,
        values: npt.NDArray[Any],
        kind: str,
        *,
        target: int | None = _ARRAY,
        normalised: bool = False,
        bounds: bool = False,
    ) -> int:
        """Add a table of (N, width) numbers; return the number of its accessor."""
        data = values.tobytes()
        view: dict[str, Any] = {
            "buffer": 0, "byteOffset": len(self._binary), "byteLength": len(data),
        }  # fmt: skip
        if target is not None:
            view["target"] = target
        self._views.append(view)
        self._binary += data + bytes(-len(data) % 4)
        component = {"f4": _FLOAT, "u1": _BYTE, "u2": _SHORT}[values.dtype.str[1:]]
        accessor: dict[str, Any] = {
            "bufferView": len(self._views) - 1,
            "componentType": component,
            "count": len(values),
            "type": kind,
        }
        if normalised:
            accessor["normalized"] = True
        if bounds:
            accessor["min"] = [float(value) for value in values.min(axis=0)]
            accessor["max"] = [float(value) for value in values.max(axis=0)]
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def glb(self, tree: dict[str, Any]) -> bytes:
        """Return the whole file: header, JSON and tables."""
        tree |= {
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._binary)}],
        }
        text = json.dumps(tree, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + len(self._binary)
        return b"".join(
            (
                struct.pack("<4sII", b"glTF", 2, size),
                struct.pack("<I4s", len(text), b"JSON"),
                text,
                struct.pack("<I4s", len(self._binary), b"BIN\0"),
                bytes(self._binary),
            )
        )


def _split_by_tone(
    figure: Mannequin,
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return the point and the tone of each vertex, and the triangles between vertices."""
    keys = figure.triangles * len(TONES) + figure.tones[:, np.newaxis]
    used, corners = np.unique(keys, return_inverse=True)
    return used // len(TONES), corners.reshape(-1, 3), used % len(TONES)


def _colours(tones: npt.NDArray[np.int64]) -> npt.NDArray[np.uint8]:
    """Return the colour of each vertex, (N, 4), linear as glTF wants it."""
    shown = np.array([_COLOURS[tone] for tone in TONES]) / 255.0
    linear = np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)
    table = np.column_stack((np.round(linear * 255.0), np.full(len(TONES), 255.0)))
    return table.astype(np.uint8)[tones]


def _whole_weights(weights: FloatArray) -> npt.NDArray[Any]:
    """Return the weights as integers whose sum is exactly one, (N, 4)."""
    whole = np.round(weights * _WHOLE).astype(np.int64)
    whole[:, 0] += _WHOLE - whole.sum(axis=1)
    return whole.astype("<u2")


def _nodes(places: Mapping[str, FloatArray], name: str) -> list[dict[str, Any]]:
    number = {part: 1 + index for index, part in enumerate(PART_NAMES)}
    skinned = 1 + len(PART_NAMES)
    nodes: list[dict[str, Any]] = [{"name": "Reembody", "children": [1, skinned]}]
    for part in PART_NAMES:
        parent = PARENT_OF[part]
        offset = (places[part] - (0.0 if parent is None else places[parent])) * _FACING_Z
        node: dict[str, Any] = {
            "name": part,
            "translation": [float(value) + 0.0 for value in np.round(offset, 9)],
        }
        children = [number[child] for child in PART_NAMES if PARENT_OF[child] == part]
        if children:
            node["children"] = children
        nodes.append(node)
    nodes.append({"name": name, "mesh": 0, "skin": 0})
    return nodes


def _vrm(name: str) -> dict[str, Any]:
    return {
        "specVersion": "1.0",
        "meta": {
            "name": name,
            "version": "1",
            "authors": [GENERATOR],
            "copyrightInformation": f"Reembody, {LICENCE}",
            "licenseUrl": _VRM_LICENCE_URL,
            "otherLicenseUrl": _LICENCE_URL,
            # The licence restricts no use; VRM treats what is left out as forbidden.
            "avatarPermission": "everyone",
            "allowExcessivelyViolentUsage": True,
            "allowExcessivelySexualUsage": True,
            "allowPoliticalOrReligiousUsage": True,
            "allowAntisocialOrHateUsage": True,
            "commercialUsage": "corporation",
            "creditNotation": "unnecessary",
            "allowRedistribution": True,
            "modification": "allowModificationRedistribution",
        },
        "humanoid": {
            "humanBones": {
                _vrm_name(part): {"node": 1 + index} for index, part in enumerate(PART_NAMES)
            }
        },
    }


def _vrm_name(part: str) -> str:
    """Return VRM 1.0's name of a part; it counts the thumb from its metacarpal bone."""
    side, thumb, segment = part.partition("Thumb")
    if thumb:
        part = f"{side}{thumb}{_VRM_THUMB[segment]}"
    return part[:1].lower() + part[1:]
