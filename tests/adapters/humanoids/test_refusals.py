"""Tests that files that are invalid or no humanoid raise an error with place and reason."""

import base64
import json
import math
import struct
import tracemalloc
from collections.abc import Callable
from typing import Any

import pytest

from app.adapters.humanoids import HumanoidFileError, Limits, read_humanoid
from app.science.avatar.body import PART_NAMES, REQUIRED_PARTS, HumanoidError, figure_of
from tests.support.humanoid_files import box_file, dog_file, glb, humanoid_file, taken_apart
from tests.support.humanoid_model import Model, without

Edit = Callable[[dict[str, Any]], None]


def rejected(data: bytes, limits: Limits | None = None) -> HumanoidFileError:
    """Return the error of reading a file."""
    with pytest.raises(HumanoidFileError) as caught:
        read_humanoid(data, limits)
    return caught.value


@pytest.mark.parametrize("part", REQUIRED_PARTS)
def test_a_missing_part_is_named(part: str) -> None:
    """A part that is missing from VRM's map is named in the error."""
    parts = tuple(one for one in PART_NAMES if one != part)
    error = rejected(humanoid_file(Model(parts=parts, vrm=1)))
    assert f"The model has no {part}, so" in str(error)


def test_all_missing_parts_are_named() -> None:
    """A model of a torso raises an error that lists all twelve missing parts."""
    torso = without("Arm", "Leg", "Hand", "Foot", "Toes")
    error = rejected(humanoid_file(Model(parts=torso, vrm=1)))
    assert all(part in str(error) for part in REQUIRED_PARTS if part[0] in "LR")
    assert "Spine," not in str(error).split("Its bones")[0]


def test_a_dog_is_no_humanoid() -> None:
    """A model of a dog raises an error that names the missing arms and the model's bones."""
    message = str(rejected(dog_file()))
    assert "no LeftUpperArm, LeftLowerArm, LeftHand" in message
    assert "front_paw.L" in message


def test_a_box_is_no_humanoid() -> None:
    """A model of a box, which has no bones, is rejected."""
    assert "The model has no Hips, Spine, Head" in str(rejected(box_file()))


def test_a_dog_with_a_humans_names_is_no_humanoid() -> None:
    """A dog's model with human bone names is rejected, as its body is not upright."""
    message = str(rejected(dog_file(humans_names=True)))
    assert "not a standing human body" in message


def test_exchanged_sides_are_found() -> None:
    """A model with left and right swapped, whose feet would point backwards, is rejected."""

    def exchanged(part: str) -> str:
        return part.replace("Left", "#").replace("Right", "Left").replace("#", "Right")

    assert "left and right are swapped" in str(rejected(humanoid_file(Model(name=exchanged))))


def test_a_bone_out_of_order_is_named() -> None:
    """A map whose hand is above its arm in the hierarchy raises an error that names that bone."""

    def crossed(document: dict[str, Any]) -> None:
        bones = document["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]
        bones["leftHand"], bones["leftUpperArm"] = bones["leftUpperArm"], bones["leftHand"]

    message = str(rejected(humanoid_file(Model(vrm=1, edit=crossed))))
    assert "is LeftHand, but is not below" in message


def test_a_bone_that_is_two_parts_is_named() -> None:
    """A bone that is mapped to both hands is rejected by name."""

    def doubled(document: dict[str, Any]) -> None:
        bones = document["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]
        bones["rightHand"] = bones["leftHand"]

    assert "is both" in str(rejected(humanoid_file(Model(vrm=1, edit=doubled))))


def test_impossible_lengths_are_rejected() -> None:
    """A forearm of a third of a millimetre is rejected."""

    def shortened(document: dict[str, Any]) -> None:
        for node in document["nodes"]:
            if node.get("name") in {"LeftHand", "RightHand"}:
                node["matrix"][12:15] = [one / 1000.0 for one in node["matrix"][12:15]]

    read = read_humanoid(humanoid_file(Model(edit=shortened)))
    with pytest.raises(HumanoidError, match=r"forearm of a model .* cannot be 0\.000 m"):
        figure_of(read.humanoid)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "an empty file"),
        (b'<mujoco model="humanoid">', "a MuJoCo model. Valid are VRM (.vrm)"),
        (b"<?xml version='1.0'?>\n<!-- made by hand -->\n<mujoco>", "a MuJoCo model"),
        (b"<!DOCTYPE html><html>", "a web page"),
        (b"<svg>", "an XML file"),
        (b"HIERARCHY\nROOT Hips", "on the page Captures"),
        (b"\x89PNG\r\n\x1a\n", "a picture"),
        (b"\x00\x01\x02", "neither glTF nor VRM. Valid are VRM (.vrm)"),
        (b"Kaydara FBX Binary  ", "FBX"),
        (b"PK\x03\x04....", "ZIP"),
        (b"{", "EOF"),
        (b"{}", "no nodes"),
        (b"glTF\x02\0\0\0", "ends after 8 bytes"),
        (b"glTF" + b"\x01\0\0\0" + b"\0" * 20, "version 1"),
        (b"[" * 100_000, "neither glTF nor VRM"),
        (b'{"a":' + b"[" * 100_000, "recursion"),
        (b'{"a":[' + b"1," * 2_000_001, "2000000 values"),
    ],
)
def test_files_that_are_no_model_are_rejected(data: bytes, message: str) -> None:
    """Files with wrong first bytes, header or JSON raise an error that states the reason."""
    assert message in str(rejected(data))


def test_a_truncated_file_is_rejected() -> None:
    """A file cut after any tenth is rejected, and one beyond the size limit is not parsed."""
    data = humanoid_file()
    for tenth in range(1, 10):
        assert f"of {len(data)} bytes" in str(rejected(data[: len(data) * tenth // 10]))
    assert "up to 1000 are read" in str(rejected(data, Limits(bytes=1000)))


def _set(*path: str | int, to: object) -> Edit:
    def edit(document: dict[str, Any]) -> None:
        found: Any = document
        for step in path[:-1]:
            found = found[step]
        found[path[-1]] = to

    return edit


@pytest.mark.parametrize(
    ("edit", "place"),
    [
        (_set("accessors", 0, "count", to=10**9), "accessors.0"),
        (_set("accessors", 0, "count", to=10**12), "accessors.0"),
        (_set("accessors", 0, "byteOffset", to=10**6), "accessors.0"),
        (_set("accessors", 0, "bufferView", to=99), "accessors.0"),
        (_set("accessors", 0, "componentType", to=7), "accessors.0"),
        (_set("accessors", 0, "type", to="VEC2"), "accessors.0"),
        (_set("accessors", 0, "sparse", to={"count": 1}), "accessors.0"),
        (_set("accessors", 1, "componentType", to=5126), "accessors.1"),
        (_set("bufferViews", 0, "byteLength", to=10**9), "bufferViews.0"),
        (_set("bufferViews", 0, "byteStride", to=4), "accessors.0"),
        (_set("bufferViews", 0, "buffer", to=3), "bufferViews.0"),
        (_set("buffers", 0, "byteLength", to=10**8), "buffers.0"),
        (_set("buffers", 0, "uri", to="model.bin"), "buffers.0"),
        (_set("buffers", 0, "uri", to="data:;base64,!!"), "buffers.0"),
        (_set("nodes", 5, "children", to=[0]), "nodes"),
        (_set("nodes", 5, "children", to=[5]), "nodes"),
        (_set("nodes", 5, "children", to=[-1]), "nodes.5.children.0"),
        (_set("nodes", 5, "children", to=[10**6]), "nodes.5.children"),
        (_set("nodes", 5, "matrix", to=[1e300] * 16), "nodes.5.matrix"),
        (_set("nodes", 5, "matrix", to=[1e9] * 16), "nodes"),
        (_set("nodes", -1, "skin", to=7), "nodes.53"),
        (_set("nodes", -1, "mesh", to=7), "nodes.53"),
        (_set("skins", 0, "joints", to=[1, 2]), "meshes.0.primitives.0"),
        (_set("skins", 0, "joints", to=[999]), "skins.0"),
        (_set("extensionsRequired", to="EXT_meshopt_compression"), "extensionsRequired"),
        (_set("meshes", 0, "primitives", 0, "attributes", "JOINTS_0", to=0), "accessors.0"),
        (_set("meshes", 0, "primitives", 0, "attributes", "POSITION", to=99), "accessors.99"),
        (_set("meshes", 0, "primitives", 0, "attributes", to="all"), "meshes.0.primitives.0"),
    ],
)
def test_inconsistent_values_are_rejected_with_their_place(edit: Edit, place: str) -> None:
    """Sizes and indices out of range, loops and invalid numbers raise an error with their place."""
    error = rejected(humanoid_file(Model(edit=edit)))
    assert error.place.startswith(place), str(error)


def test_numbers_that_are_not_finite_are_rejected() -> None:
    """Numbers that are not finite are rejected, in the JSON and in a buffer."""
    document, binary = taken_apart(humanoid_file())
    document["nodes"][3]["matrix"][0] = math.nan
    text = json.dumps(document).replace("NaN", "1e999")
    assert rejected(text.encode()).place.startswith("nodes.3")
    document, _ = taken_apart(humanoid_file())
    assert rejected(glb(document, b"\xff" * len(binary))).place.startswith("accessors")


def test_limits_are_enforced() -> None:
    """The numbers of vertices and values are limited, even if the same ones are repeated."""
    assert "more than 100 vertices" in str(rejected(humanoid_file(), Limits(vertices=100)))
    assert "more numbers" in str(rejected(humanoid_file(), Limits(values=1000)))

    def repeated(document: dict[str, Any]) -> None:
        document["meshes"][0]["primitives"] *= 5_000

    assert "more" in str(rejected(humanoid_file(Model(edit=repeated))))


def png(width: int, height: int) -> bytes:
    """Return the beginning of a PNG file of that size."""
    return b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR" + struct.pack(">II", width, height)


def ktx2(unpacked: int, faces: int = 1, packing: int = 2) -> bytes:
    """Return the beginning of a KTX2 file of 32 x 16 pixels whose one level has that length."""
    head = struct.pack("<9I", 0, 1, 32, 16, 0, 0, faces, 1, packing)
    return b"\xabKTX 20\xbb\r\n\x1a\n" + head + bytes(32) + struct.pack("<QQQ", 104, 1, unpacked)


def with_pictures(*pictures: bytes) -> bytes:
    """Return a model with these pictures in its JSON."""

    def edit(document: dict[str, Any]) -> None:
        uris = (base64.b64encode(one).decode() for one in pictures)
        document["images"] = [{"uri": f"data:image/png;base64,{uri}"} for uri in uris]

    return humanoid_file(Model(edit=edit))


@pytest.mark.parametrize(
    ("pictures", "place", "said"),
    [
        ([png(8192, 8193)], "images.0", "8,192 x 8,193 pixels; up to 8,192 a side"),
        ([png(4, 4), png(2**31 - 1, 1)], "images.1", "up to 8,192 a side are valid"),
        ([png(8192, 8192)] * 3, "images", "201,326,592 pixels together; up to 200,000,000"),
        ([b""] * 1001, "images", "1001 pictures; up to 1000 are read"),
        ([png(0, 16)], "images.0", "begins like image/png but states no size"),
        ([b"\xff\xd8\xff" + b"\xe0\0\x02\xff" * 2000], "images.0", "image/jpeg but states no"),
        ([b'<svg onload="alert(1)"/>'], "images.0", "is SVG; valid are PNG, JPEG, WebP and KTX2"),
        ([b"GIF89a" + bytes(20)], "images.0", "is GIF; valid are PNG, JPEG, WebP and KTX2"),
        ([bytes(4) + b"ftypavif" + bytes(20)], "images.0", "is AVIF or HEIF; valid are PNG"),
        ([ktx2(2**40)], "images.0", "32 x 16 pixels unpacks to 1,099,511,627,776 bytes"),
        ([ktx2(512, faces=6)], "images.0", "0 layers and 6 faces; valid is one"),
    ],
)
def test_pictures_that_cannot_be_drawn_are_refused(
    pictures: list[bytes], place: str, said: str
) -> None:
    """Pictures that are huge, damaged or of another kind are refused by their headers."""
    data = with_pictures(*pictures)
    error = rejected(data)
    assert (error.place, said in error.reason) == (place, True), error.reason
    assert read_humanoid(data, check_pictures=False).humanoid.parts


def test_a_model_whose_picture_is_in_another_file_is_refused() -> None:
    """A texture that is not in the file would be missing in silence, so the model is refused."""

    def edit(document: dict[str, Any]) -> None:
        document["images"] = [{"uri": "skin.png"}]

    error = rejected(humanoid_file(Model(edit=edit)))
    assert error.place == "images.0"
    assert "needs another one, 'skin.png'. Export the model as one file" in error.reason


def test_pictures_within_the_limits_are_read() -> None:
    """Two pictures of the largest side are read, as is a KTX2 picture."""
    read = read_humanoid(with_pictures(png(8192, 8192), png(8192, 8192), ktx2(512)))
    assert [(one.width, one.problem) for one in read.contents.textures] == [
        (8192, ""),
        (8192, ""),
        (32, ""),
    ]


def test_a_view_with_many_pictures_is_not_copied() -> None:
    """A thousand pictures in one large view take memory once, not for each of them."""

    def edit(document: dict[str, Any]) -> None:
        document["bufferViews"].append({"buffer": 0, "byteOffset": 0, "byteLength": 4_000_000})
        document["buffers"][0]["byteLength"] += 4_000_000
        document["images"] = [{"bufferView": len(document["bufferViews"]) - 1}] * 1000

    document, binary = taken_apart(humanoid_file(Model(edit=edit)))
    data = glb(document, binary + bytes(4_000_000))
    tracemalloc.start()
    try:
        read = read_humanoid(data)
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert len(read.contents.textures) == 1000
    assert most < 60_000_000
