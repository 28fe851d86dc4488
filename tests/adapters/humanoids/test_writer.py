"""Tests of the bodies that come with the product, and of the writer of their files."""

import json
import struct
from functools import cache
from typing import Any

import numpy as np
import pytest

from app.adapters.humanoids import read_humanoid, read_skin
from app.adapters.humanoids.writer import write_mannequin
from app.cli.figure.run import POPULATIONS
from app.cli.figure.shipped import STATURE_M, measures_of, tuned_standard
from app.features.movement.humanoids.shipped import SHIPPED_BODIES
from app.protocol.avatar import parse_avatar_json
from app.resources import bodies_dir
from app.science.avatar.body import PARENT_OF, PART_NAMES, figure_of, proportions
from app.science.avatar.mannequin import make_mannequin
from app.science.avatar.mjcf import avatar_model

_TYPES = {5121: "<u1", 5123: "<u2", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@cache
def shipped(name: str) -> bytes:
    """Return the file of a shipped body."""
    return (bodies_dir() / f"{name}.glb").read_bytes()


@cache
def made(name: str) -> bytes:
    """Make a shipped body anew."""
    figure = make_mannequin(proportions(STATURE_M), POPULATIONS[name])
    return write_mannequin(figure, name)


def opened(data: bytes) -> tuple[dict[str, Any], list[np.ndarray]]:
    """Return the JSON of a GLB and all its tables, read without the product's reader."""
    magic, version, size = struct.unpack_from("<4sII", data)
    assert (magic, version, size) == (b"glTF", 2, len(data))
    length, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    tree = json.loads(data[20 : 20 + length])
    binary = data[28 + length :]
    tables = []
    for accessor in tree["accessors"]:
        start = tree["bufferViews"][accessor["bufferView"]]["byteOffset"]
        assert start % 4 == 0
        width = _WIDTHS[accessor["type"]]
        count = accessor["count"] * width
        values = np.frombuffer(binary, _TYPES[accessor["componentType"]], count, start)
        tables.append(values.reshape(-1, width))
    return tree, tables


@pytest.mark.parametrize("name", SHIPPED_BODIES)
def test_shipped_bodies_are_what_the_code_makes(name: str) -> None:
    """Made anew, a shipped body has the same triangles and bones, and places to a micrometre."""
    stored, again = opened(shipped(name)), opened(made(name))
    for key in ("accessors", "nodes", "materials", "extensions", "scenes", "meshes"):
        if key != "accessors":  # bounds may differ in the last digit
            assert stored[0][key] == again[0][key]
    assert len(stored[1]) == len(again[1])
    for one, other in zip(stored[1], again[1], strict=True):
        limit = 1e-6 if one.dtype.kind == "f" else 1
        assert np.abs(one.astype(np.float64) - other).max() <= limit
    attributes = stored[0]["meshes"][0]["primitives"][0]
    assert (stored[1][attributes["indices"]] == again[1][attributes["indices"]]).all()


@pytest.mark.parametrize("name", SHIPPED_BODIES)
def test_shipped_bodies_are_read_without_a_remark(name: str) -> None:
    """The reader finds all 52 parts where they belong, a convex piece of each, and no remark."""
    read = read_humanoid(shipped(name))
    figure = figure_of(read.humanoid)
    assert (read.bones_by, figure.notes, figure.absent) == ("vrm", (), ())
    assert figure.without_piece == ()
    assert figure.stature_m == STATURE_M
    expected = proportions(STATURE_M).places_m()
    for part in PART_NAMES:
        assert figure.places_m[part] == pytest.approx(expected[part], abs=2e-6), part
    measures = json.loads((bodies_dir() / f"{name}.json").read_text(encoding="utf-8"))
    again = json.loads(measures_of(bodies_dir() / f"{name}.glb"))
    assert measures.keys() == again.keys()
    assert {**again, "figure": measures["figure"]} == measures
    assert len(shipped(name)) <= 400_000


def test_the_file_says_who_made_it_and_what_is_allowed() -> None:
    """Generator and licence stand in the file, and VRM's map names all bones."""
    tree, _ = opened(shipped("neutral"))
    assert tree["asset"]["generator"] == "Reembody"
    assert tree["asset"]["extras"]["licence"] == "Apache-2.0"
    vrm = tree["extensions"]["VRMC_vrm"]
    assert vrm["meta"]["otherLicenseUrl"].endswith("LICENSE-2.0")
    assert (vrm["meta"]["avatarPermission"], vrm["meta"]["allowRedistribution"]) == (
        "everyone",
        True,
    )
    bones = vrm["humanoid"]["humanBones"]
    assert len(bones) == len(PART_NAMES)
    assert tree["nodes"][bones["leftThumbMetacarpal"]["node"]]["name"] == "LeftThumbProximal"
    number = {node["name"]: row for row, node in enumerate(tree["nodes"])}
    for part, parent in PARENT_OF.items():
        if parent is not None:
            assert number[part] in tree["nodes"][number[parent]]["children"]


def test_weights_in_the_file_add_up_exactly() -> None:
    """Integer weights of every vertex add up to one exactly, and normals have length one."""
    tree, tables = opened(shipped("neutral"))
    attributes = tree["meshes"][0]["primitives"][0]["attributes"]
    assert (tables[attributes["WEIGHTS_0"]].sum(axis=1, dtype=np.int64) == 65535).all()
    assert tables[attributes["JOINTS_0"]].max() < len(PART_NAMES)
    lengths = np.linalg.norm(tables[attributes["NORMAL"]], axis=1)
    assert lengths == pytest.approx(1.0, abs=1e-6)
    # Where colours meet, vertices are written twice: the surface is closed once they are joined.
    points = tables[attributes["POSITION"]]
    _, joined = np.unique(points, axis=0, return_inverse=True)
    corners = joined.reshape(-1)[tables[tree["meshes"][0]["primitives"][0]["indices"]].ravel()]
    triangles = corners.reshape(-1, 3)
    edges = np.concatenate([triangles[:, [n, (n + 1) % 3]] for n in range(3)])
    assert set(map(tuple, edges.tolist())) == set(map(tuple, edges[:, ::-1].tolist()))


def test_the_skin_reads_back() -> None:
    """The product's reader of skins finds one piece with the vertices and bones of the file."""
    skin = read_skin(shipped("female"))
    tree, tables = opened(shipped("female"))
    attributes = tree["meshes"][0]["primitives"][0]["attributes"]
    (piece,) = skin.pieces
    assert len(piece.joints) == len(tables[attributes["POSITION"]])


def test_the_standard_avatar_wears_the_neutral_body() -> None:
    """The shipped configuration builds a model in which every part collides by its convex piece."""
    text = (bodies_dir() / "standard.json").read_text(encoding="utf-8")
    configuration = parse_avatar_json(text)
    figure = figure_of(read_humanoid(shipped("neutral")).humanoid)
    built = avatar_model(configuration, 1.62, figure=figure)
    assert built.fallback_parts == ()
    assert built.mjcf.count("<mesh ") == len(PART_NAMES)


def test_a_tuning_that_knows_no_inertia_confirms_the_shipped_gains() -> None:
    """Trunk, head and left arm are tuned to within 10 % of the shipped kp, and 5 % of kd."""
    held = ("left_leg", "right_leg", "right_arm", "left_fingers", "right_fingers")
    shipped_gains = parse_avatar_json((bodies_dir() / "standard.json").read_text(encoding="utf-8"))
    found = parse_avatar_json(tuned_standard(bodies_dir(), held))
    tuned = [name for name in found.axes if name not in found.locked_axes]
    assert len(tuned) == 23
    for name in tuned:
        own, was = found.axes[name], shipped_gains.axes[name]
        assert own.kp == pytest.approx(was.kp, rel=0.10), name
        assert own.kd == pytest.approx(was.kd, rel=0.05), name
