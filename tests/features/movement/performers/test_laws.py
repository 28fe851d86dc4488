"""A skeleton that comes through any door moves a body as the same movement does from a file."""

import numpy as np
import pytest

from app.adapters.live import SkeletonDefinition
from app.features.movement.live.sources import DoorKey, Sample
from app.features.movement.performers.assembly import BodyFrame
from app.features.movement.performers.on_body import GroundKey, OnBody, reference_body
from app.features.movement.performers.performer import Performer, PerformerName
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    Flat,
    Ground,
    Retargeter,
    named_avatar,
    propose_joint_map,
)
from app.science.rig import RigMotion, to_local
from app.science.rotations import FloatArray, from_rotation_vector, identity, multiply, rotate
from tests.adapters.live.packets import bundle, osc
from tests.features.movement.performers.senders import (
    as_sent,
    by_json,
    by_natnet,
    by_vmc,
    part_of_walk,
    samples,
)

AVATAR = "190cm"


@pytest.fixture(scope="module")
def walk() -> RigMotion:
    """Provide a second of a generated walk, from standing to a step; its arms swing."""
    walk = part_of_walk(40, 160)
    rng = np.random.default_rng(3)
    swings = 0.4 * np.sin(np.linspace(0.0, 6.0, 120))[:, None, None] * rng.normal(size=(1, 22, 3))
    swings[:, 0] = 0.0
    rotations = multiply(walk.rotations, from_rotation_vector(swings))
    return RigMotion(walk.rig, walk.rate_hz, walk.root_positions_m, rotations, walk.observed)


def performed(
    door: DoorKey, packets: list[Sample], skeleton: str = ""
) -> tuple[Performer, list[BodyFrame]]:
    """Return the performer of samples, and its frames."""
    performer = Performer(PerformerName(door, "x", skeleton), "127.0.0.1:5")
    frames: list[BodyFrame] = []
    for sample in packets:
        defined: SkeletonDefinition | None = next(iter(sample.skeletons), None)
        frames += performer.take(sample, defined)
    return performer, frames


def on_body(
    performer: Performer, frames: list[BodyFrame], ground: GroundKey = "flat"
) -> tuple[OnBody, FloatArray]:
    """Return a body, and its values in each frame, (N, 3 + 4 A)."""
    assert performer.agreed is not None
    joint_map = propose_joint_map(performer.agreed.rig).joint_map
    body = OnBody(performer.agreed, joint_map, reference_body(AVATAR), ground)
    return body, np.array([body.values(frame) for frame in frames])


def from_file(motion: RigMotion, ground: Ground | None = None) -> FloatArray:
    """Return what the same movement from a file gives."""
    joint_map = propose_joint_map(motion.rig).joint_map
    avatar = named_avatar(AVATAR)
    retargeter = Retargeter(motion.rig, joint_map, avatar, REFERENCE_JOINT_MAP)
    moved = retargeter.batch(motion, ground or Flat())
    return np.hstack((moved.root_positions_m, moved.rotations.reshape(motion.frame_count, -1)))


@pytest.mark.parametrize("ground", ["flat", "ramp", "kerb", "steps"])
def test_a_script_s_skeleton_gives_the_body_of_the_file(walk: RigMotion, ground: GroundKey) -> None:
    """By JSON every number of the body is within 1e-9 of `Retargeter.batch`, on every ground."""
    performer, frames = performed("json", list(samples("json", by_json(walk))))
    assert len(frames) == walk.frame_count
    body, values = on_body(performer, frames, ground)
    np.testing.assert_allclose(values, from_file(walk, body.ground), atol=1e-9)
    # The walk is a short one.
    rise_m = np.ptp(values[:, 1] - on_body(performer, frames)[1][:, 1])
    assert (rise_m > 0.01) == (ground != "flat")


@pytest.mark.parametrize("packets", [1, 3])
def test_a_vmc_performer_gives_the_body_of_the_file(walk: RigMotion, packets: int) -> None:
    """Also when a frame comes in several packets, of which the first frame shows how many."""
    sent = as_sent(walk)
    performer, frames = performed("osc", list(samples("osc", by_vmc(walk, packets=packets))))
    assert len(frames) == walk.frame_count
    np.testing.assert_allclose(on_body(performer, frames)[1], from_file(sent), atol=1e-9)


@pytest.mark.parametrize("in_parent", [True, False])
def test_a_motive_skeleton_gives_the_body_of_the_file(walk: RigMotion, *, in_parent: bool) -> None:
    """Bones in their parent or in the world, which packets do not tell, and in any order."""
    datagrams = by_natnet(walk, in_parent=in_parent, shuffled=True)
    performer, frames = performed("natnet", list(samples("natnet", datagrams)), "Skeleton 001")
    assert performer.agreed is not None
    assert performer.agreed.skeleton.in_parent == in_parent
    assert len(frames) == walk.frame_count
    sent = as_sent(walk)
    if not in_parent:
        _, world = walk.world()
        world = world.astype(np.float32).astype(np.float64)
        places = walk.world()[0][:, 0].astype(np.float32).astype(np.float64)
        local = to_local(walk.rig, world)
        sent = RigMotion(walk.rig, walk.rate_hz, places, local, walk.observed)
    np.testing.assert_allclose(on_body(performer, frames)[1], from_file(sent), atol=1e-6)


def test_the_root_of_a_unity_avatar_carries_its_hips(walk: RigMotion) -> None:
    """A root that is moved and turned moves and turns the whole body."""
    turn = from_rotation_vector(np.array((0.0, 0.7, 0.0)))
    w, x, y, z = turn.tolist()
    root = osc("/VMC/Ext/Root/Pos", "root", 1.0, 0.0, -2.0, -x, -y, z, w)
    plain = by_vmc(walk)
    turned = (bundle(root, datagram) for datagram in by_vmc(walk))
    _, still = performed("osc", list(samples("osc", plain)))
    _, moved = performed("osc", list(samples("osc", turned)))
    for before, after in zip(still, moved, strict=True):
        np.testing.assert_allclose(
            after.root_m - np.array((1.0, 0.0, 2.0)), rotate(turn, before.root_m), atol=1e-6
        )
        np.testing.assert_allclose(
            after.rotations[0], multiply(turn, before.rotations[0]), atol=1e-6
        )


def test_a_t_pose_that_is_shown_makes_any_rest_pose_comparable(walk: RigMotion) -> None:
    """A source whose bones lie along their own axes moves the body as before, once shown a T-pose.

    Its joints' frames are turned by any rotations; the performer stands in the T-pose at first.
    """
    rng = np.random.default_rng(8)
    axes = from_rotation_vector(rng.normal(size=(22, 3)))
    rig = walk.rig
    t_pose = identity(1, 22)
    rotations = np.concatenate((t_pose, walk.rotations))
    roots = np.concatenate((walk.root_positions_m[:1], walk.root_positions_m))
    roots[0, 1] = rig.offsets_m[0, 1]
    known = np.ones(rotations.shape[:2], dtype=np.bool_)
    plain = RigMotion(rig, walk.rate_hz, roots, rotations, known)
    places, world = plain.world()
    # world_from_bone' = world_from_bone axes: other frames for the same bones.
    other_world = multiply(world, axes)
    offsets = rig.offsets_m.copy()
    for joint, parent in enumerate(rig.parents):
        if parent >= 0:
            offsets[joint] = rotate(axes[parent] * (1.0, -1.0, -1.0, -1.0), rig.offsets_m[joint])
    other_rig = type(rig)(rig.names, rig.parents, offsets, identity(22))
    other = RigMotion(other_rig, walk.rate_hz, roots, to_local(other_rig, other_world), known)
    np.testing.assert_allclose(other.world()[0], places, atol=1e-9)
    packets = list(samples("json", by_json(other)))
    performer, frames = performed("json", packets[:1])
    assert performer.agree("t_pose")
    for sample in packets[1:]:
        frames += performer.take(sample, sample.skeletons[0])
    np.testing.assert_allclose(on_body(performer, frames)[1], from_file(plain), atol=1e-9)
