"""Write files of skinned humanoid models, and of models that are not humanoid.

The models are those of `tests.support.humanoid_model`. Bones have rotations of their own at rest,
as those of real rigs have.
"""

import base64
import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import PARENT_OF, PART_NAMES
from app.science.rotations import from_rotation_vector, rotate
from tests.support.humanoid_model import Array, Model, is_arm, places, skin_of


def humanoid_file(model: Model | None = None) -> bytes:
    """Return the file of a humanoid model."""
    return _File(Model() if model is None else model).data()


def box_file() -> bytes:
    """Return the file of a model without bones: a box on a node."""
    return humanoid_file(Model(parts=(), skin=()))


_DOG: Mapping[str, tuple[str | None, tuple[float, float, float], str]] = {
    "spine": (None, (0.0, 0.5, -0.3), "Hips"),
    "spine.001": ("spine", (0.0, 0.5, 0.0), "Spine"),
    "neck": ("spine.001", (0.0, 0.6, 0.3), "Neck"),
    "head": ("neck", (0.0, 0.7, 0.4), "Head"),
    "tail": ("spine", (0.0, 0.55, -0.4), "Tail"),
    **{
        f"{bone}.{side[0]}": (
            above if above.startswith("spine") else f"{above}.{side[0]}",
            (x, y, z),
            f"{side}{part}",
        )
        for side, x in (("Left", 0.1), ("Right", -0.1))
        for bone, above, y, z, part in (
            ("front_thigh", "spine.001", 0.45, 0.2, "UpperArm"),
            ("front_shin", "front_thigh", 0.25, 0.2, "LowerArm"),
            ("front_paw", "front_shin", 0.05, 0.2, "Hand"),
            ("thigh", "spine", 0.45, -0.3, "UpperLeg"),
            ("shin", "thigh", 0.25, -0.3, "LowerLeg"),
            ("foot", "shin", 0.05, -0.3, "Foot"),
        )
    },
}


def dog_file(*, humans_names: bool = False) -> bytes:
    """Return the file of a dog model, with the bone names of an animal rig or of a human."""
    names = list(_DOG)
    nodes: list[dict[str, Any]] = []
    for name, (above, place, human) in _DOG.items():
        start = np.zeros(3) if above is None else np.array(_DOG[above][1])
        children = [names.index(one) for one, (parent, _, _) in _DOG.items() if parent == name]
        nodes.append(
            {
                "name": human if humans_names else name,
                "translation": (np.array(place) - start).tolist(),
            }
        )
        if children:
            nodes[-1]["children"] = children
    skins = [{"joints": list(range(len(names)))}]
    return glb({"asset": {"version": "2.0"}, "nodes": nodes, "skins": skins}, b"")


def glb(document: Mapping[str, Any], binary: bytes) -> bytes:
    """Return a GLB file of a JSON document and its binary chunk."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def taken_apart(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the JSON document and the binary chunk of a file made by `glb`."""
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + size]), data[28 + size :]


class _File:
    def __init__(self, model: Model) -> None:
        self._model = model
        self._parts = [part for part in PART_NAMES if part in model.parts]
        self._places = places()
        self._binary = bytearray()
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._world: list[Array] = [self._root()]
        self._nodes: list[dict[str, Any]] = [
            {"name": "Armature", "matrix": self._world[0].T.ravel().tolist()}
        ]
        self._node_of: dict[str, int] = {}

    def data(self) -> bytes:
        for part in self._parts:
            self._add_bone(part, self._above(part), self._places[part])
        if self._model.hair:
            self._add_bone("hair", "Head", self._places["Head"] + np.array((0.0, 0.15, 0.1)))
        for name, above in self._model.helpers.items():
            place = np.zeros(3) if above is None else self._places[above]
            self._add_bone(name, above, place + np.array((0.0, 0.01, 0.0)))
        self._add_mesh()
        document: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": self._nodes,
            "meshes": self._meshes,
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._binary)}],
        }
        if self._node_of:
            document["skins"] = [self._skin]
        if self._model.vrm is not None:
            document["extensions"] = self._vrm()
        self._model.edit(document)
        if self._model.binary:
            return glb(document, bytes(self._binary))
        uri = base64.b64encode(self._binary).decode()
        document["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{uri}"
        return json.dumps(document).encode()

    def _above(self, part: str) -> str | None:
        above = PARENT_OF[part]
        while above is not None and above not in self._parts:
            above = PARENT_OF[above]
        return above

    def _root(self) -> Array:
        """Return file_from_model: a rotation, and the change of the up axis."""
        # Facing -z becomes facing +z, then the requested turn is applied.
        turn = _matrix(np.array((0.0, np.pi + self._model.facing_rad, 0.0)))
        if self._model.up == "z":
            turn = _matrix(np.array((np.pi / 2.0, 0.0, 0.0))) @ turn
        return turn @ np.diag((*(self._model.root_scale,) * 3, 1.0))

    def _posed(self, part: str) -> Array:
        """Return model_from_T-pose: arms lowered by the requested angle."""
        side = next((side for side in ("Left", "Right") if part.startswith(side)), "")
        down = self._model.arms_down_rad
        if not side or not is_arm(part) or down == 0.0:
            return np.eye(4)
        turn = _matrix(np.array((0.0, 0.0, down if side == "Left" else -down)))
        pivot = self._places[f"{side}UpperArm"]
        turn[:3, 3] = pivot - turn[:3, :3] @ pivot
        return turn

    def _add_bone(self, name: str, above: str | None, place: Array) -> None:
        rng = np.random.default_rng(len(self._nodes))
        part = name if name in PART_NAMES else str(above)
        own = self._posed(part) @ _moved(place) @ _matrix(rng.normal(size=3))
        own[:3, 3] *= self._model.units_per_metre
        world = self._world[0] @ own
        node = 0 if above is None else self._node_of[above]
        local = np.linalg.inv(self._world[node]) @ world
        self._nodes[node].setdefault("children", []).append(len(self._nodes))
        self._node_of[name] = len(self._nodes)
        called = self._model.name(name) if name in PART_NAMES else name
        self._nodes.append({"name": called, "matrix": local.T.ravel().tolist()})
        self._world.append(world)

    def _add_mesh(self) -> None:
        points, joints = [], []
        rows = list(self._node_of)
        for part in self._parts:
            if part in self._model.skin:
                points.append(self._in_file(part, skin_of(part) + self._places[part]))
                joints += [rows.index(part)] * len(points[-1])
        if self._model.hair:
            lock = 0.02 * skin_of("Head") + self._places["Head"] + np.array((0.0, 0.25, 0.15))
            points.append(self._in_file("Head", lock))
            joints += [rows.index("hair")] * len(lock)
        if not points:
            corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
            points.append(corners.astype(float))
        table = np.concatenate(points)
        attributes = {"POSITION": self._table(table.astype("<f4"), "VEC3", 5126)}
        mesh: dict[str, Any] = {"name": "Body", "mesh": 0}
        if joints:
            above = [max(0, row - 1) for row in joints]
            four = np.array([(row, other, 0, 0) for row, other in zip(joints, above, strict=True)])
            own = self._model.own_share
            # The influence of a second bone changes nothing while the bones are at rest.
            shares = np.tile(np.array((own, 1.0 - own, 0.0, 0.0)), (len(joints), 1))
            attributes["JOINTS_0"] = self._table(four.astype("<u2"), "VEC4", 5123)
            attributes["WEIGHTS_0"] = self._table(shares.astype("<f4"), "VEC4", 5126)
            world = np.array([self._world[self._node_of[row]] for row in rows])
            inverse = np.linalg.inv(world).swapaxes(1, 2).reshape(-1, 16)
            matrices = self._table(inverse.astype("<f4"), "MAT4", 5126)
            self._skin = {"joints": list(self._node_of.values()), "inverseBindMatrices": matrices}
            mesh["skin"] = 0
        indices = self._table(np.arange(len(table), dtype="<u2")[:, np.newaxis], "SCALAR", 5123)
        self._meshes = [{"primitives": [{"attributes": attributes, "indices": indices}]}]
        self._nodes.append(mesh)
        self._nodes[0].setdefault("children", []).append(len(self._nodes) - 1)

    def _in_file(self, part: str, points: Array) -> Array:
        posed = self._posed(part)
        moved = (points @ posed[:3, :3].T + posed[:3, 3]) * self._model.units_per_metre
        world = self._world[0]
        found: Array = moved @ world[:3, :3].T + world[:3, 3]
        return found

    def _table(self, values: npt.NDArray[Any], kind: str, component: int) -> int:
        data = np.ascontiguousarray(values).tobytes()
        self._views.append({"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(data)})
        self._binary += data + b"\0" * (-len(data) % 4)
        self._accessors.append(
            {
                "bufferView": len(self._views) - 1,
                "componentType": component,
                "count": len(values),
                "type": kind,
            }
        )
        return len(self._accessors) - 1

    def _vrm(self) -> dict[str, Any]:
        bones = {part: self._node_of[part] for part in self._parts}
        if self._model.vrm == 0:
            rows = [{"bone": _small(part), "node": node} for part, node in bones.items()]
            return {"VRM": {"humanoid": {"humanBones": rows}}}
        thumbs = {"Proximal": "Metacarpal", "Intermediate": "Proximal", "Distal": "Distal"}
        named = {}
        for part, node in bones.items():
            before, thumb, segment = part.partition("Thumb")
            called = f"{before}{thumb}{thumbs[segment]}" if thumb else part
            named[_small(called)] = {"node": node}
        return {"VRMC_vrm": {"specVersion": "1.0", "humanoid": {"humanBones": named}}}


def _small(name: str) -> str:
    return name[:1].lower() + name[1:]


def _matrix(vector_rad: Array) -> Array:
    found = np.eye(4)
    found[:3, :3] = rotate(from_rotation_vector(vector_rad)[np.newaxis], np.eye(3)).T
    return found


def _moved(by: Array) -> Array:
    found = np.eye(4)
    found[:3, 3] = by
    return found


def ktx2_picture(side_px: int, colour: tuple[int, int, int]) -> bytes:
    """Return a KTX 2.0 file of one colour: RGBA of 8 bits in sRGB, one level, not packed.

    Source: Khronos, KTX File Format Specification 2.0, section 3; Data Format 1.3, section 5.
    """
    pixels = bytes((*colour, 255)) * side_px**2
    samples = b"".join(
        struct.pack("<HBBIII", 8 * at, 7, channel, 0, 0, 255)
        for at, channel in enumerate((0, 1, 2, 15 | 0x10))
    )
    srgb, rgb_colours, bytes_of_a_pixel = 43, 1, 4
    return _ktx2(side_px, srgb, (rgb_colours, 0, bytes_of_a_pixel), samples, pixels)


def uastc_picture(side_px: int) -> bytes:
    """Return a black KTX2 picture that is compressed as UASTC, which only a transcoder can read.

    Source: Khronos Data Format 1.3, 5.6.15: blocks of 4 x 4 pixels, 128 bits each.
    """
    blocks = bytes(16 * (side_px // 4) ** 2)
    uastc, up_to_3, bytes_of_a_block = 166, 3, 16
    sample = struct.pack("<HBBIII", 0, 127, 0, 0, 0, 2**32 - 1)
    return _ktx2(side_px, 0, (uastc, up_to_3, bytes_of_a_block), sample, blocks)


def _ktx2(
    side_px: int, vk_format: int, layout: tuple[int, int, int], samples: bytes, pixels: bytes
) -> bytes:
    """Return a KTX2 file of one level. `layout`: colour model, block side less 1, block bytes."""
    model, side, size = layout
    block = struct.pack(
        *("<IHHBBBB4B8B", 0, 2, 24 + len(samples), model, 1, 2, 0),
        *(side, side, 0, 0, size, *(0,) * 7),
    )
    descriptor = struct.pack("<I", 4 + len(block) + len(samples)) + block + samples
    head = 80 + 24
    return (
        b"\xabKTX 20\xbb\r\n\x1a\n"
        + struct.pack("<9I", vk_format, 1, side_px, side_px, 0, 0, 1, 1, 0)
        + struct.pack("<4I2Q", head, len(descriptor), 0, 0, 0, 0)
        + struct.pack("<3Q", head + len(descriptor), len(pixels), len(pixels))
        + descriptor
        + pixels
    )


def with_ktx2(document: dict[str, Any]) -> None:
    """Give a model's skin a KTX2 texture of one colour; its points lie at one place in it."""
    _with_texture(document, ktx2_picture(16, (200, 30, 120)))


def with_uastc(document: dict[str, Any]) -> None:
    """Give a model's skin a KTX2 texture that must be transcoded."""
    _with_texture(document, uastc_picture(16))


def _with_texture(document: dict[str, Any], ktx2: bytes) -> None:
    picture = base64.b64encode(ktx2).decode()
    document["images"] = [{"uri": f"data:image/ktx2;base64,{picture}", "mimeType": "image/ktx2"}]
    document["textures"] = [{"extensions": {"KHR_texture_basisu": {"source": 0}}}]
    document["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    for name in ("extensionsUsed", "extensionsRequired"):
        document[name] = [*document.get(name, ()), "KHR_texture_basisu"]
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            primitive["material"] = 0
