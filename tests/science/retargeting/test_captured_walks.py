"""Tests of captured walks on avatars of three sizes, with the proposed joint maps."""

from pathlib import Path

import numpy as np
import pytest

from app.adapters.bvh import read_bvh
from app.science.retargeting.joint_map import propose_joint_map
from app.science.retargeting.transfer import Retargeter
from app.science.rig import Rig, RigMotion
from app.science.rotations import FloatArray, identity, rotate
from tests.science.retargeting.bodies import SAME, own_body

METRES_PER_UNIT = 0.056444
WALKS = ("02_01", "05_06", "06_01", "12_02")
# Not the neck: it has a second joint that no avatar joint corresponds to.
SAME_BONES = (
    ("LeftUpperArm", "LeftLowerArm"),
    ("RightLowerArm", "RightHand"),
    ("LeftUpperLeg", "LeftLowerLeg"),
    ("RightLowerLeg", "RightFoot"),
)


def _walk(shared_data: Path, name: str) -> RigMotion:
    path = shared_data / "motion" / "cmu_bvh" / f"{name}.bvh"
    clip = read_bvh(path, metres_per_unit=METRES_PER_UNIT)
    rig = Rig(clip.names, clip.parents, clip.offsets_m, identity(len(clip.names)))
    seen = np.ones(clip.rotations.shape[:2], dtype=bool)
    # The converter puts its rest pose first.
    return RigMotion(rig, 120.0, clip.translations_m[1:, 0], clip.rotations[1:].copy(), seen[1:])


def _direction(places: FloatArray, start: int, end: int) -> FloatArray:
    bone = places[:, end] - places[:, start]
    return np.asarray(bone / np.linalg.norm(bone, axis=-1, keepdims=True))


@pytest.mark.parametrize("name", WALKS)
@pytest.mark.parametrize("stature_m", [1.3, 1.65, 1.9])
def test_a_walk_is_the_same_walk_on_any_avatar(
    shared_data: Path, name: str, stature_m: float
) -> None:
    """Limbs keep their directions, travel scales with the legs, and feet start on the floor."""
    motion, avatar = _walk(shared_data, name), own_body(stature_m)
    joint_map = propose_joint_map(motion.rig).joint_map
    retargeter = Retargeter(motion.rig, joint_map, avatar, SAME)
    result = retargeter.batch(motion)
    theirs, ours = motion.world()[0], result.world()[0]
    for start, end in SAME_BONES:
        source = _direction(
            theirs, motion.rig.index(joint_map[start]), motion.rig.index(joint_map[end])
        )
        moved = _direction(ours, avatar.index(start), avatar.index(end))
        np.testing.assert_allclose(moved, source, atol=1e-9)
    assert retargeter.leg_ratio is not None
    travel = np.diff(result.root_positions_m, axis=0)
    expected = retargeter.leg_ratio * np.diff(motion.root_positions_m, axis=0)
    np.testing.assert_allclose(travel, expected, atol=1e-9)
    points = retargeter.foot_points.places_m(result.root_positions_m[0], result.rotations[0])
    assert abs(float(points[:, 1].min())) < 1e-3


@pytest.mark.parametrize("name", ["02_01", "06_01", "12_02"])
def test_an_avatar_looks_where_it_walks(shared_data: Path, name: str) -> None:
    """Hips and head face along the walk, though captures face +z at rest and avatars -z."""
    motion, avatar = _walk(shared_data, name), own_body(1.65)
    joint_map = propose_joint_map(motion.rig).joint_map
    result = Retargeter(motion.rig, joint_map, avatar, SAME).batch(motion)
    world = result.world()[1]
    travel = result.root_positions_m[-1] - result.root_positions_m[0]
    ahead = travel * (1.0, 0.0, 1.0) / np.linalg.norm(travel[[0, 2]])
    for part, least in (("Hips", 0.85), ("Head", 0.75)):
        q = world[:, avatar.index(part)]
        assert float(np.median(rotate(q, np.array((0.0, 0.0, -1.0))) @ ahead)) > least
        assert float(np.min(rotate(q, np.array((0.0, 1.0, 0.0)))[:, 1])) > 0.8
