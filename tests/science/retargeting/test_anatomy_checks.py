"""Tests that skeletons of files are checked by anatomy, and that walks without toes compare."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures.axes import turned_rig_motion
from app.adapters.captures.reader import read_capture_file
from app.science.anatomy import mirrored_skeleton, turned_over_skeleton
from app.science.retargeting.anatomy_checks import (
    checked_skeleton,
    foot_notice,
    stature_notice,
    step_height_notice,
    uneven_steps_notice,
)
from app.science.retargeting.joint_map import JointMap, propose_joint_map
from app.science.retargeting.pipeline import Retargeted, retarget_motion
from app.science.retargeting.reference_avatars import REFERENCE_JOINT_MAP, reference_avatar
from app.science.rig import Rig, RigMotion
from tests.science.retargeting.bodies import SAME, own_body
from tests.science.retargeting.walks import made_walk

_SKELETONS = (
    "cmu_asfamc/02_01.amc", "cmu_asfamc/02_06.amc", "cmu_bvh/02_01.bvh", "cmu_bvh/05_06.bvh",
    "cmu_bvh/06_01.bvh", "cmu_bvh/12_02.bvh", "bvh_toolbox/walk01.bvh",
    "vicon_tracker/HumanRobotHandover_0.bvh", "vicon_tracker/ObjectInspection_0.bvh",
)  # fmt: skip


def _read(shared_data: Path, name: str) -> RigMotion:
    motion = read_capture_file(shared_data / "motion" / name).motion
    assert isinstance(motion, RigMotion)
    return motion


def _onto(motion: RigMotion, *, check: bool = True) -> Retargeted:
    joint_map = propose_joint_map(motion.rig).joint_map
    if check:
        motion, _ = checked_skeleton(motion, joint_map)
    return retarget_motion(motion, joint_map, reference_avatar(1.65), REFERENCE_JOINT_MAP)


def _height_ratio(found: Retargeted) -> float:
    assert found.walks is not None
    avatar, source = found.walks.avatar, found.walks.source
    assert avatar.mean_step_height_m is not None
    assert source.mean_step_height_m is not None
    return avatar.mean_step_height_m / source.mean_step_height_m


def without_toes(motion: RigMotion) -> RigMotion:
    """Return the movement of the same skeleton without toe joints and ends of the feet."""
    kept = [i for i, name in enumerate(motion.rig.names) if "toe" not in name.lower()]
    new = {old: number for number, old in enumerate(kept)}
    rig = Rig(
        tuple(motion.rig.names[i] for i in kept),
        tuple(new.get(motion.rig.parents[i], -1) for i in kept),
        motion.rig.offsets_m[kept],
        motion.rig.rest_rotations[kept],
        tuple(
            (new[j], at) for j, at in motion.rig.ends if j in new and "foot" not in _name(motion, j)
        ),
    )
    seen, rotations = motion.observed[:, kept], motion.rotations[:, kept]
    return replace(motion, rig=rig, rotations=rotations, observed=seen)


def _name(motion: RigMotion, joint: int) -> str:
    return motion.rig.names[joint].lower()


@pytest.mark.parametrize("name", _SKELETONS)
def test_a_mirrored_skeleton_is_mirrored_back(shared_data: Path, name: str) -> None:
    """Every mirrored capture is noticed and becomes what it was; none of the captures is."""
    motion = _read(shared_data, name)
    joint_map = propose_joint_map(motion.rig).joint_map
    same, notices = checked_skeleton(motion, joint_map)
    assert same is motion
    assert {notice.rule for notice in notices} <= {"length"}
    back, found = checked_skeleton(mirrored_skeleton(motion), joint_map)
    assert ("mirrored", "mended") in {(notice.rule, notice.action) for notice in found}
    np.testing.assert_allclose(back.rig.offsets_m, motion.rig.offsets_m)
    np.testing.assert_allclose(back.rotations, motion.rotations)
    np.testing.assert_allclose(back.root_positions_m, motion.root_positions_m)


@pytest.mark.parametrize("rest_is_upright", [True, False])
def test_a_walk_upside_down_is_turned_over(*, rest_is_upright: bool) -> None:
    """A walk on its head, its root turned or all its axes, becomes what it was, and it is said."""
    walk = made_walk(own_body(1.75)).motion
    there = turned_over_skeleton(walk, rest_is_upright=rest_is_upright)
    back, notices = checked_skeleton(there, SAME)
    assert [(one.rule, one.action) for one in notices] == [("upright", "mended")]
    np.testing.assert_allclose(back.world()[0], walk.world()[0], atol=1e-9)
    assert checked_skeleton(walk, SAME) == (walk, ())
    both, told = checked_skeleton(mirrored_skeleton(there), SAME)
    assert [one.rule for one in told] == ["upright", "mirrored"]
    np.testing.assert_allclose(
        np.linalg.norm(np.diff(both.world()[0], axis=1), axis=-1),
        np.linalg.norm(np.diff(walk.world()[0], axis=1), axis=-1),
        atol=1e-9,
    )


def test_a_walk_with_another_axis_up_is_named() -> None:
    """A walk whose z axis is up but was read as y lies on its back: that is noted, with --up."""
    walk = made_walk(own_body(1.75)).motion
    lying, notices = checked_skeleton(turned_rig_motion(walk, "z"), SAME)
    assert [(one.rule, one.action) for one in notices] == [("upright", "noted")]
    assert "--up" in notices[0].remedy
    assert lying.frame_count == walk.frame_count


@pytest.mark.parametrize("name", ["cmu_asfamc/02_01.amc", "bvh_toolbox/walk01.bvh"])
def test_the_steps_of_a_mirrored_walk_have_the_persons_height(shared_data: Path, name: str) -> None:
    """Unchecked, a mirrored walk's steps are over 3 times as high and refused; checked, not."""
    motion = _read(shared_data, name)
    unchecked = _onto(mirrored_skeleton(motion), check=False)
    assert _height_ratio(unchecked) > 3.0
    assert [(one.rule, one.action) for one in unchecked.notices] == [
        ("mirrored", "refused"),
        ("step_height", "refused"),
    ]
    checked = _onto(mirrored_skeleton(motion))
    assert _height_ratio(checked) == pytest.approx(_height_ratio(_onto(motion)), abs=1e-9)
    assert checked.notices == ()


@pytest.mark.parametrize("name", ["cmu_asfamc/02_01.amc", "cmu_bvh/06_01.bvh"])
def test_a_walk_without_toes_has_the_same_steps(shared_data: Path, name: str) -> None:
    """Without toes steps are measured at the usual ball: within 5 % of those with toes.

    Measured at the ankle, they were 0.53 and 0.57 times as high.
    """
    motion = _read(shared_data, name)
    whole, toeless = _onto(motion), _onto(without_toes(motion))
    assert [(one.rule, one.action) for one in toeless.notices] == [("toes", "mended")]
    assert whole.notices == ()
    assert _height_ratio(toeless) == pytest.approx(_height_ratio(whole), rel=0.05)
    assert whole.walks is not None
    assert toeless.walks is not None
    assert len(toeless.walks.source.strides) == len(whole.walks.source.strides)


@pytest.mark.parametrize("name", ["cmu_asfamc/02_01.amc", "cmu_bvh/06_01.bvh"])
def test_a_foot_that_ends_at_its_ankle_has_no_toes(shared_data: Path, name: str) -> None:
    """An end or a toe joint on the ankle itself is none: the steps are those without toes."""
    motion = _read(shared_data, name)
    bare = without_toes(motion)
    feet = [i for i, joint in enumerate(bare.rig.names) if "foot" in joint.lower()]
    assert feet
    ended = replace(bare.rig, ends=(*bare.rig.ends, *((foot, (0.0, 0.0, 0.0)) for foot in feet)))
    offsets = motion.rig.offsets_m.copy()
    joint_map = propose_joint_map(motion.rig).joint_map
    for side in ("Left", "Right"):
        offsets[motion.rig.index(joint_map[f"{side}Toes"])] = 0.0
    short = replace(motion, rig=replace(motion.rig, offsets_m=offsets))
    expected = _onto(bare)
    assert expected.walks is not None
    for odd in (replace(bare, rig=ended), short):
        found = _onto(odd)
        assert [(one.rule, one.action) for one in found.notices] == [("toes", "mended")]
        assert found.walks is not None
        assert found.walks.source.mean_step_height_m == pytest.approx(
            expected.walks.source.mean_step_height_m, rel=1e-9
        )


def test_a_made_walk_without_toes_lifts_as_often_and_as_high() -> None:
    """A synthetic walk without toes has the same lifts, and steps that scale with the legs."""
    walk = made_walk(own_body(1.75)).motion
    joint_map = {part: name for part, name in SAME.items() if "Toes" not in part}
    bare = without_toes(walk)
    found = retarget_motion(bare, joint_map, reference_avatar(1.30), REFERENCE_JOINT_MAP)
    assert _height_ratio(found) == pytest.approx(1.30 / 1.75, rel=1e-6)


@pytest.mark.parametrize(
    ("avatar_m", "refused"), [(0.10, False), (0.19, False), (0.21, True), (0.04, True)]
)
def test_steps_that_do_not_scale_with_the_legs_are_refused(
    avatar_m: float, *, refused: bool
) -> None:
    """Step heights between half and twice the legs' ratio pass; others are refused with both."""
    notice = step_height_notice(0.10, avatar_m, 1.0)
    assert (notice is not None) is refused
    if notice is not None:
        assert notice.action == "refused"
        assert f"{avatar_m / 0.10:.2f} times" in notice.value


def test_shuffles_are_not_judged() -> None:
    """Steps lower than 2 cm have no meaningful ratio."""
    assert step_height_notice(0.01, 0.05, 1.0) is None
    assert step_height_notice(None, 0.05, 1.0) is None


def test_unequal_sides_and_short_arms_of_a_skeleton_are_noted() -> None:
    """A file's skeleton is left as it is; unlike sides and lengths are noted with their values."""
    walk = made_walk(own_body(1.75)).motion
    offsets = walk.rig.offsets_m.copy()
    offsets[walk.rig.index("LeftLowerArm")] *= 0.5
    odd = replace(walk, rig=replace(walk.rig, offsets_m=offsets))
    same, notices = checked_skeleton(odd, SAME)
    assert same is odd
    assert {(one.rule, one.action) for one in notices} == {("sides", "noted"), ("length", "noted")}
    assert any("16.3 cm left, 32.6 cm right" in one.value for one in notices)


def test_steps_of_very_different_height_on_both_sides_are_noted() -> None:
    """One exchanged foot gave 21.8 and 11.7 cm; captured walks and high dance lifts are silent."""
    noted = uneven_steps_notice(0.218, 0.117)
    assert noted is not None
    assert (noted.rule, noted.action) == ("step_height", "noted")
    assert "21.8 cm left, 11.7 cm right" in noted.value
    assert uneven_steps_notice(0.117, 0.218) is not None
    for left_m, right_m in ((0.0818, 0.1037), (0.906, 0.355), (0.019, 0.005)):
        assert uneven_steps_notice(left_m, right_m) is None
    assert uneven_steps_notice(None, 0.1) is None


def with_foot_turned(motion: RigMotion, joint_map: JointMap, side: str) -> RigMotion:
    """Return the movement of a skeleton of which one foot's toes are where its heel is."""
    foot = motion.rig.index(joint_map[f"{side}Foot"])
    offsets = motion.rig.offsets_m.copy()
    for joint, parent in enumerate(motion.rig.parents):
        if parent == foot:
            offsets[joint] *= (-1.0, 1.0, -1.0)
    ends = tuple(
        (joint, (-x, y, -z) if joint == foot else (x, y, z)) for joint, (x, y, z) in motion.rig.ends
    )
    return replace(motion, rig=replace(motion.rig, offsets_m=offsets, ends=ends))


@pytest.mark.parametrize("name", ["cmu_asfamc/02_01.amc", "cmu_bvh/12_02.bvh"])
@pytest.mark.parametrize("side", ["Left", "Right"])
def test_one_foot_of_a_skeleton_that_points_backwards_is_refused(
    shared_data: Path, name: str, side: str
) -> None:
    """A skeleton's foot with heel and toes exchanged is refused, in the words used for markers."""
    motion = _read(shared_data, name)
    turned = with_foot_turned(motion, propose_joint_map(motion.rig).joint_map, side)
    notice = _onto(turned).notices[0]
    assert (notice.rule, notice.action) == ("mirrored", "refused")
    assert f"The {side.lower()} foot points backwards, the other one forwards." in notice.sentence
    assert f"Exchange the labels of heel and toes of the {side.lower()} foot." in notice.sentence


def test_feet_are_judged_only_against_each_other() -> None:
    """Feet that both point forwards or both backwards, or that have no toes, are not judged."""
    walk = made_walk(own_body(1.75)).motion
    assert foot_notice(walk, SAME) is None
    left = with_foot_turned(walk, SAME, "Left")
    assert foot_notice(left, SAME) is not None
    assert foot_notice(with_foot_turned(left, SAME, "Right"), SAME) is None
    toeless = {part: name for part, name in SAME.items() if "Toes" not in part}
    assert foot_notice(without_toes(left), toeless) is None


def test_a_body_smaller_by_the_ratio_of_inch_and_centimetre_is_noted() -> None:
    """Legs of a stature of 0.67 m are noted with the ratio that would explain them."""
    leg_m = 0.491 * 1.70
    assert stature_notice(leg_m) is None
    small = stature_notice(leg_m / 2.54)
    assert small is not None
    assert "0.85 to 2.6 m (it would be 1.70 m if numbers read as cent" in small.valid
    assert "2.54" in small.valid
    large = stature_notice(leg_m * 2.54)
    assert large is not None
    assert "it would be 1.70 m if numbers read as inches are centimetres" in large.valid
