"""Tests that an avatar's feet stay above flat ground, and that the price is stated."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures.reader import read_capture_file
from app.science.fitting import fit_skeleton
from app.science.retargeting.joint_map import propose_joint_map
from app.science.retargeting.pipeline import Retargeted, retarget_motion
from app.science.retargeting.reference_avatars import REFERENCE_JOINT_MAP, reference_avatar
from app.science.rig import RigMotion
from app.science.rotations import from_rotation_vector, multiply, rotate
from tests.science.retargeting.bodies import SAME, own_body
from tests.science.retargeting.walks import made_walk

DEEPEST_M = 0.01


def curved_and_sinking(sunk_m: float) -> RigMotion:
    """Return a walk whose path turns by a full circle and whose floor sinks evenly by `sunk_m`."""
    walk = made_walk(own_body(1.75)).motion
    share = np.linspace(0.0, 1.0, walk.frame_count)
    turns = from_rotation_vector(np.outer(share, (0.0, 2.0 * np.pi, 0.0)))
    steps = np.diff(walk.root_positions_m, axis=0, prepend=walk.root_positions_m[:1])
    root = walk.root_positions_m[0] + np.cumsum(rotate(turns, steps), axis=0)
    root[:, 1] -= sunk_m * share
    rotations = walk.rotations.copy()
    rotations[:, 0] = multiply(turns, rotations[:, 0])
    return replace(walk, root_positions_m=root, rotations=rotations)


def _onto(motion: RigMotion, stature_m: float = 1.65, *, lock: bool = False) -> Retargeted:
    joint_map = propose_joint_map(motion.rig).joint_map
    avatar = reference_avatar(stature_m)
    return retarget_motion(motion, joint_map, avatar, REFERENCE_JOINT_MAP, lock=lock)


@pytest.mark.parametrize("stature_m", [1.30, 1.65, 1.90])
def test_a_curved_walk_whose_floor_sinks_stays_above_the_ground(stature_m: float) -> None:
    """Where the floor of a curved capture sinks by 5 cm, joints end at most 1 cm under it."""
    walk = curved_and_sinking(0.05)
    found = _onto(walk, stature_m)
    assert found.floor.sunk_m > 0.03
    assert found.floor.left_m <= DEEPEST_M
    assert 0.0 < found.floor.raised_m < found.floor.sunk_m + 1e-9
    assert found.floor.mean_raised_m < found.floor.raised_m


def test_raising_a_body_changes_no_joint_and_no_stride() -> None:
    """A raised body has the same joint rotations and the same lengths of strides."""
    sinking, level = _onto(curved_and_sinking(0.05)), _onto(curved_and_sinking(0.0))
    np.testing.assert_allclose(sinking.motion.rotations, level.motion.rotations, atol=1e-12)
    assert sinking.walks is not None
    assert level.walks is not None
    walks = (sinking.walks.avatar, level.walks.avatar)
    lengths = [[stride.length_m for stride in walk.strides] for walk in walks]
    assert lengths[0] == pytest.approx(lengths[1], abs=1e-9)


def test_a_walk_on_level_ground_is_not_raised() -> None:
    """A walk whose feet rest at one height is neither sunk nor raised."""
    body = own_body(1.75)
    found = retarget_motion(made_walk(body).motion, SAME, reference_avatar(1.65), SAME)
    assert found.floor.sunk_m < 1e-6
    assert found.floor.raised_m == 0.0


@pytest.mark.parametrize("name", [
    "cmu_bvh/05_06.bvh", "cmu_bvh/06_01.bvh", "cmu_bvh/12_02.bvh", "bvh_toolbox/walk01.bvh",
    "c3d/Gait.c3d", "cmu_c3d/02_01.c3d",
])  # fmt: skip
def test_captured_walks_stay_above_the_ground(shared_data: Path, name: str) -> None:
    """Joints of captured walks, up to 20 cm under the floor before, are within 1 cm of it."""
    motion = read_capture_file(shared_data / "motion" / name).motion
    if not isinstance(motion, RigMotion):
        motion = fit_skeleton(motion).motion
    found = _onto(motion)
    assert found.floor.sunk_m > DEEPEST_M
    assert found.floor.left_m <= DEEPEST_M
    locked = _onto(motion, lock=True)
    assert locked.floor.raised_m == 0.0
