"""Tests of reference avatars: their proportions, names and limits."""

import numpy as np
import pytest

from app.science.retargeting.reference_avatars import (
    PAPER_STATURES_M,
    REFERENCE_JOINT_MAP,
    AvatarError,
    as_movement,
    named_avatar,
    reference_avatar,
)
from app.science.rig import Rig
from app.science.rotations import rotate
from app.science.skeleton import build_skeleton, forward_kinematics
from tests.science.retargeting.walks import made_walk, mapped


@pytest.mark.parametrize("stature_m", PAPER_STATURES_M)
def test_an_avatar_is_as_tall_as_its_name_and_stands_on_the_floor(stature_m: float) -> None:
    """An avatar's head is at its named stature, its soles are near zero, its left is -x."""
    avatar = named_avatar(f"{stature_m * 100:.0f}cm")
    positions, world = avatar.rest_world()
    tips = {avatar.names[j]: positions[j] + rotate(world[j], np.array(e)) for j, e in avatar.ends}
    assert tips["Head"][1] == pytest.approx(stature_m, abs=1e-12)
    assert 0.0 < tips["LeftToes"][1] < 0.02 * stature_m
    assert positions[avatar.index("LeftHand")][0] < 0.0
    assert tips["LeftToes"][2] < positions[avatar.index("LeftFoot")][2]


def test_two_statures_differ_by_one_number() -> None:
    """All offsets and ends of two avatars differ by the ratio of their statures."""
    small, large = reference_avatar(1.30), reference_avatar(1.95)
    assert large.offsets_m == pytest.approx(1.5 * small.offsets_m, abs=1e-12)
    assert np.array([e for _, e in large.ends]) == pytest.approx(
        1.5 * np.array([e for _, e in small.ends]), abs=1e-12
    )


@pytest.mark.parametrize("share", [0.43, 0.5, 0.57])
def test_another_thigh_share_moves_the_knee_and_nothing_else(share: float) -> None:
    """Another share of the thigh moves the knee and keeps the leg's length."""
    plain, other = reference_avatar(1.75), reference_avatar(1.75, thigh_share=share)
    assert mapped(other).left.thigh_share == pytest.approx(share, abs=1e-12)
    assert mapped(other).length_m == pytest.approx(mapped(plain).length_m, abs=1e-12)
    moved = np.linalg.norm(other.rest_world()[0] - plain.rest_world()[0], axis=1) > 1e-12
    assert {other.names[j] for j in np.flatnonzero(moved)} <= {"LeftLowerLeg", "RightLowerLeg"}


@pytest.mark.parametrize("key", ["165 CM", " 165cm ", "165.0cm"])
def test_a_key_may_be_written_as_people_write_it(key: str) -> None:
    """An avatar's key may have any case, blanks and decimals."""
    assert np.array_equal(named_avatar(key).offsets_m, reference_avatar(1.65).offsets_m)


@pytest.mark.parametrize("key", ["Faye", "1.65m", "cm", "-165cm", "165", "1e3cm"])
def test_an_unknown_key_is_rejected_with_what_is_valid(key: str) -> None:
    """The error about an unknown avatar names the paper's three and the valid range."""
    with pytest.raises(AvatarError, match="130cm, 165cm, 190cm and any other stature from 50cm"):
        named_avatar(key)


def test_impossible_bodies_are_rejected() -> None:
    """A stature or a thigh share out of range is rejected."""
    with pytest.raises(AvatarError, match=r"0\.5 to 2\.6 m"):
        named_avatar("400cm")
    with pytest.raises(AvatarError, match=r"0\.3 to 0\.7"):
        reference_avatar(1.7, thigh_share=0.9)


def test_its_kinematics_are_those_of_the_product() -> None:
    """Forward kinematics of the product's skeleton give the same joint positions."""
    motion = made_walk(reference_avatar(1.75)).motion
    movement = as_movement(motion)
    world = forward_kinematics(build_skeleton(1.75), movement.root_positions_m, movement.rotations)
    assert world.positions_m == pytest.approx(motion.world()[0], abs=1e-12)
    assert dict(REFERENCE_JOINT_MAP) == {name: name for name in motion.rig.names}


def test_another_skeletons_movement_is_rejected() -> None:
    """A movement whose joints have other names than the body's is rejected."""
    motion = made_walk(reference_avatar(1.75)).motion
    rig = motion.rig
    other = Rig(
        tuple(f"b_{name}" for name in rig.names), rig.parents, rig.offsets_m, rig.rest_rotations
    )
    renamed = type(motion)(
        other, motion.rate_hz, motion.root_positions_m, motion.rotations, motion.observed
    )
    with pytest.raises(AvatarError, match="reference avatar"):
        as_movement(renamed)
