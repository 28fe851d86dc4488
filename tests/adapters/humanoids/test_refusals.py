"""What is no humanoid, or no file, is refused with the place and what is missing."""

import json
import math
from collections.abc import Callable
from typing import Any

import pytest

from app.adapters.humanoids import HumanoidFileError, Limits, read_humanoid
from app.science.avatar.body import PART_NAMES, REQUIRED_PARTS, HumanoidError, figure_of
from tests.support.humanoid_files import box_file, dog_file, glb, humanoid_file, taken_apart
from tests.support.humanoid_model import Model, without

Edit = Callable[[dict[str, Any]], None]


def refused(data: bytes, limits: Limits | None = None) -> HumanoidFileError:
    """The error of a file."""
    with pytest.raises(HumanoidFileError) as caught:
        read_humanoid(data, limits)
    return caught.value


@pytest.mark.parametrize("part", REQUIRED_PARTS)
def test_a_missing_part_is_named(part: str) -> None:
    """By VRM's map, where names cannot stand in for each other."""
    parts = tuple(one for one in PART_NAMES if one != part)
    error = refused(humanoid_file(Model(parts=parts, vrm=1)))
    assert f"The model has no {part}, so" in str(error)


def test_all_missing_parts_are_named() -> None:
    """A torso lacks twelve, and keeps what it has."""
    torso = without("Arm", "Leg", "Hand", "Foot", "Toes")
    error = refused(humanoid_file(Model(parts=torso, vrm=1)))
    assert all(part in str(error) for part in REQUIRED_PARTS if part[0] in "LR")
    assert "Spine," not in str(error).split("Its bones")[0]


def test_a_dog_is_no_humanoid() -> None:
    """It has no arms, and its bones are told."""
    told = str(refused(dog_file()))
    assert "no LeftUpperArm, LeftLowerArm, LeftHand" in told
    assert "front_paw.L" in told


def test_a_box_is_no_humanoid() -> None:
    """It has no bones at all."""
    assert "The model has no Hips, Spine, Head" in str(refused(box_file()))


def test_a_dog_with_a_humans_names_is_none() -> None:
    """Its legs do not hang from where its head is above."""
    told = str(refused(dog_file(humans_names=True)))
    assert "not a standing human body" in told


def test_exchanged_sides_are_found() -> None:
    """Feet that would point backwards."""

    def exchanged(part: str) -> str:
        return part.replace("Left", "#").replace("Right", "Left").replace("#", "Right")

    assert "left and right are swapped" in str(refused(humanoid_file(Model(name=exchanged))))


def test_a_bone_out_of_order_is_named() -> None:
    """A map whose hand is above its arm."""

    def crossed(document: dict[str, Any]) -> None:
        bones = document["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]
        bones["leftHand"], bones["leftUpperArm"] = bones["leftUpperArm"], bones["leftHand"]

    told = str(refused(humanoid_file(Model(vrm=1, edit=crossed))))
    assert "is LeftHand, but is not below" in told


def test_a_bone_that_is_two_parts_is_named() -> None:
    """One bone cannot be both hands."""

    def doubled(document: dict[str, Any]) -> None:
        bones = document["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]
        bones["rightHand"] = bones["leftHand"]

    assert "is both" in str(refused(humanoid_file(Model(vrm=1, edit=doubled))))


def test_lengths_that_are_no_persons_are_refused() -> None:
    """A forearm of a third of a millimetre."""

    def shortened(document: dict[str, Any]) -> None:
        for node in document["nodes"]:
            if node.get("name") in {"LeftHand", "RightHand"}:
                node["matrix"][12:15] = [one / 1000.0 for one in node["matrix"][12:15]]

    read = read_humanoid(humanoid_file(Model(edit=shortened)))
    with pytest.raises(HumanoidError, match=r"forearm of a model .* cannot be 0\.000 m"):
        figure_of(read.humanoid)


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "begins with b''"),
        (b"Kaydara FBX Binary  ", "FBX"),
        (b"PK\x03\x04....", "ZIP"),
        (b"{", "EOF"),
        (b"{}", "no nodes"),
        (b"glTF\x02\0\0\0", "ends after 8 bytes"),
        (b"glTF" + b"\x01\0\0\0" + b"\0" * 20, "version 1"),
        (b"[" * 100_000, "begins with"),
        (b'{"a":' + b"[" * 100_000, "recursion"),
        (b'{"a":[' + b"1," * 2_000_001, "2000000 values"),
    ],
)
def test_what_is_no_file_of_a_model_is_told(data: bytes, told: str) -> None:
    """By its first bytes, its header, or its JSON."""
    assert told in str(refused(data))


def test_a_file_that_was_cut_says_where() -> None:
    """At every tenth of it, and a file beyond the limit is not looked at."""
    data = humanoid_file()
    for tenth in range(1, 10):
        assert f"of {len(data)} bytes" in str(refused(data[: len(data) * tenth // 10]))
    assert "up to 1000 are read" in str(refused(data, Limits(bytes=1000)))


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
        (_set("extensionsRequired", to=["KHR_draco_mesh_compression"]), "extensionsRequired"),
        (_set("meshes", 0, "primitives", 0, "attributes", "JOINTS_0", to=0), "accessors.0"),
        (_set("meshes", 0, "primitives", 0, "attributes", "POSITION", to=99), "accessors.99"),
        (_set("meshes", 0, "primitives", 0, "attributes", to="all"), "meshes.0.primitives.0"),
    ],
)
def test_what_does_not_fit_says_its_place(edit: Edit, place: str) -> None:
    """Sizes and indices beyond what is there, loops, numbers that are none."""
    error = refused(humanoid_file(Model(edit=edit)))
    assert error.place.startswith(place), str(error)


def test_numbers_that_are_none_are_refused() -> None:
    """In the JSON, and in a buffer."""
    document, binary = taken_apart(humanoid_file())
    document["nodes"][3]["matrix"][0] = math.nan
    text = json.dumps(document).replace("NaN", "1e999")
    assert refused(text.encode()).place.startswith("nodes.3")
    document, _ = taken_apart(humanoid_file())
    assert refused(glb(document, b"\xff" * len(binary))).place.startswith("accessors")


def test_a_file_cannot_ask_for_more_than_it_may() -> None:
    """Vertices and numbers have an end, however often the same ones are named."""
    assert "more than 100 vertices" in str(refused(humanoid_file(), Limits(vertices=100)))
    assert "more numbers" in str(refused(humanoid_file(), Limits(values=1000)))

    def again(document: dict[str, Any]) -> None:
        document["meshes"][0]["primitives"] *= 5_000

    assert "more" in str(refused(humanoid_file(Model(edit=again))))
