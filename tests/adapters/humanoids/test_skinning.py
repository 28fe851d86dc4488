"""Tests of the laws of a body's binding and of its posed skin."""

import json
import math

import numpy as np
import pytest

from app.adapters.humanoids import ReadHumanoid, ReadSkin, read_humanoid, read_skin
from app.science.avatar.body import Binding, posed_nodes, posed_vertices
from app.science.rotations import FloatArray, from_rotation_vector, identity, matrices, rotate
from tests.adapters.humanoids.vector_files import BODY, VECTORS, vectors
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import Model, mixamo_name, without

MODELS = {
    "T-pose": Model(hair=True),
    "A-pose, turned, rigid": Model(arms_down_rad=0.8, facing_rad=1.0, own_share=1.0),
    "VRM 0, facing -z, three fingers": Model(
        vrm=0, facing_rad=math.pi, parts=without("Little", "Ring")
    ),
    "z up, centimetres": Model(up="z", units_per_metre=100.0),
    "Mixamo, centimetres under a scaled root": Model(
        name=mixamo_name, units_per_metre=100.0, root_scale=0.01
    ),
}


@pytest.fixture(params=MODELS, scope="module")
def body(request: pytest.FixtureRequest) -> tuple[ReadHumanoid, ReadSkin]:
    """Return each model as a humanoid, and its skin."""
    data = humanoid_file(MODELS[request.param])
    return read_humanoid(data), read_skin(data)


def wild_pose(parts: int) -> FloatArray:
    """Return rotations (P, 4) that turn every part about another axis, by up to 100 degrees."""
    rng = np.random.default_rng(parts)
    return from_rotation_vector(rng.uniform(-1.0, 1.0, size=(parts, 3)))


def vertices(
    skin: ReadSkin, binding: Binding, hips_m: FloatArray, rotations: FloatArray
) -> list[FloatArray]:
    """Return the posed vertices of every piece of a skin."""
    world = posed_nodes(skin.tree, binding, binding.world_from_nodes(hips_m.tolist(), rotations))
    return [posed_vertices(piece, world) for piece in skin.pieces]


def strongest_part(skin: ReadSkin, binding: Binding) -> list[np.ndarray]:
    """Return, for every vertex of every piece, the row of the part that it follows most."""
    part_of = {node: row for row, node in enumerate(binding.nodes)}
    for node in skin.tree.order:
        above = skin.tree.parents[node]
        part_of.setdefault(node, part_of.get(above, 0))
    found = []
    for piece in skin.pieces:
        joints = piece.joints[np.arange(len(piece.joints)), piece.weights.argmax(axis=1)]
        found.append(np.array([part_of[int(node)] for node in piece.bones[joints]]))
    return found


def test_the_t_pose_is_where_the_body_was_measured(body: tuple[ReadHumanoid, ReadSkin]) -> None:
    """Skin posed by identities lies where the humanoid in the T-pose has it."""
    read, skin = body
    binding = read.binding
    posed = vertices(skin, binding, binding.joints_m[0], identity(len(binding.parts)))
    owners = np.concatenate(strongest_part(skin, binding))
    points = np.concatenate(posed)
    for row, part in enumerate(binding.parts):
        own = read.humanoid.parts[part]
        expected = own.vertices_m + np.array(own.place_m)
        assert np.abs(points[owners == row] - expected).max() < 1e-5, part


def test_a_rigid_part_moves_by_forward_kinematics() -> None:
    """A vertex with a single bone goes exactly where that bone's part takes it."""
    data = humanoid_file(Model(own_share=1.0, arms_down_rad=0.5))
    read, skin = read_humanoid(data), read_skin(data)
    binding, hips = read.binding, np.array((0.3, 0.8, -0.2))
    turns = wild_pose(len(binding.parts))
    world = binding.world_from_parts(hips.tolist(), turns)
    points = np.concatenate(vertices(skin, binding, hips, turns))
    owners = np.concatenate(strongest_part(skin, binding))
    for row, part in enumerate(binding.parts):
        own = read.humanoid.parts[part].vertices_m
        expected = own @ world[row, :3, :3].T + world[row, :3, 3]
        assert np.abs(points[owners == row] - expected).max() < 1e-5, part


def test_joints_are_connected(body: tuple[ReadHumanoid, ReadSkin]) -> None:
    """In any pose a joint keeps its distance to the joint above it; the hips are where asked."""
    binding = body[0].binding
    world = binding.world_from_parts((1.0, 2.0, 3.0), wild_pose(len(binding.parts)))
    assert world[0, :3, 3].tolist() == [1.0, 2.0, 3.0]
    for row, parent in enumerate(binding.parents[1:], start=1):
        there = np.linalg.norm(world[row, :3, 3] - world[parent, :3, 3])
        rest = np.linalg.norm(binding.joints_m[row] - binding.joints_m[parent])
        assert there == pytest.approx(rest, abs=1e-12)


def test_another_stature_is_the_same_body_scaled(body: tuple[ReadHumanoid, ReadSkin]) -> None:
    """With the stature and the place of the hips doubled, every vertex is twice as far away."""
    read, skin = body
    small, turns = read.binding, wild_pose(len(read.binding.parts))
    hips = np.array((0.2, 0.9, 0.4))
    for own, double in zip(
        vertices(skin, small, hips, turns),
        vertices(skin, small.scaled(2.0 * small.stature_m), 2.0 * hips, turns),
        strict=True,
    ):
        assert np.abs(double - 2.0 * own).max() < 1e-9


def test_the_whole_file_goes_with_the_hips(body: tuple[ReadHumanoid, ReadSkin]) -> None:
    """Turning and moving the hips alone turns and moves all nodes, also those above the hips."""
    read, skin = body
    binding, still = read.binding, identity(len(read.binding.parts))
    turn, way = from_rotation_vector(np.array((0.3, -1.1, 0.6))), np.array((0.5, 0.1, -2.0))
    at_rest = posed_nodes(
        skin.tree, binding, binding.world_from_nodes(binding.joints_m[0].tolist(), still)
    )
    turned = still.copy()
    turned[0] = turn
    moved = posed_nodes(skin.tree, binding, binding.world_from_nodes(way.tolist(), turned))
    expected = np.eye(4)
    expected[:3, :3] = matrices(turn)
    expected[:3, 3] = way - rotate(turn, binding.joints_m[0])
    assert np.abs(moved - expected @ at_rest).max() < 1e-9


def test_a_node_that_is_no_part_keeps_its_place_below_its_parent() -> None:
    """Hair moves rigidly with the head."""
    data = humanoid_file(Model(hair=True))
    binding, tree = read_humanoid(data).binding, read_skin(data).tree
    turns = wild_pose(len(binding.parts))
    world = posed_nodes(tree, binding, binding.world_from_nodes((0.0, 1.0, 0.0), turns))
    head = binding.nodes[binding.parts.index("Head")]
    (hair,) = (
        node
        for node, parent in enumerate(tree.parents)
        if parent == head and node not in binding.nodes
    )
    assert np.abs(world[hair] - world[head] @ tree.local[hair]).max() < 1e-12


def test_the_vectors_are_those_of_the_repository() -> None:
    """Vectors made now are those that the browser's implementation is held to, within 1e-6 m."""
    stored = json.loads(VECTORS.read_text(encoding="utf-8"))
    made = vectors(BODY.read_bytes())
    for case, now in zip(stored["cases"], made["cases"], strict=True):
        assert case["name"] == now["name"]
        for piece, other in zip(case["vertices"], now["vertices"], strict=True):
            assert piece["rows"] == other["rows"]
            places, there = (np.array(one["places_m"]) for one in (piece, other))
            assert np.abs(places - there).max() < 1e-6
    for name, value in stored["binding"].items():
        if name in ("parts", "parents", "nodes"):
            assert value == made["binding"][name]
        else:
            assert np.abs(np.array(value) - np.array(made["binding"][name])).max() < 1e-6
