"""Tests of following the paper's printed formulas literally, one mistake at a time.

Each test makes one mistake on the mannequin and shows how wrong its T-pose becomes, so that the
mistake is not reintroduced. Without a mistake `_aligned` gives the product's own T-pose.
"""

from collections.abc import Callable
from typing import cast

import numpy as np
import pytest

from app.science.retargeting.axes import UNREAL, swing, unit
from app.science.retargeting.bones import Bone
from app.science.retargeting.coordinates import from_rotator
from app.science.retargeting.mannequin import INITIAL_DEG, MANNEQUIN_MAP, mannequin
from app.science.retargeting.t_pose import UNREAL_LOCAL_AXES, TPose, t_pose
from app.science.rig import to_local, to_world
from app.science.rotations import (
    FloatArray,
    conjugate,
    from_euler,
    geodesic_angle,
    multiply,
    normalise,
    rotate,
)

Difference = Callable[[FloatArray, FloatArray], FloatArray]
ORIGIN = np.zeros(3)


@pytest.fixture(scope="module")
def right() -> TPose:
    """Return the mannequin's T-pose as the product computes it."""
    return t_pose(mannequin(), MANNEQUIN_MAP, UNREAL, local_axes=UNREAL_LOCAL_AXES)


def _aligned(
    right: TPose,
    *,
    sign: float = 1.0,
    difference: Difference = swing,
    inverse: bool = True,
    leaf_first: bool = False,
    fresh: bool = True,
) -> FloatArray:
    """Return local rotations of a T-pose computed as printed, with the given mistakes."""
    rig = right.rig
    rest, local = rig.rest_world()[1], rig.rest_rotations.copy()
    bones = {bone.joint: bone for bone in right.bones}
    feet = {rig.index("foot_l"), rig.index("foot_r")}
    joints = [*bones, *feet]
    for joint in sorted(joints, reverse=leaf_first):
        world = to_world(rig, ORIGIN, local)[1]
        if joint in feet:
            world[joint] = rest[joint]
        else:
            k = sign * unit(rotate((world if fresh else rest)[joint], bones[joint].direction))
            q_diff = difference(bones[joint].axis, k)
            world[joint] = multiply(conjugate(q_diff) if inverse else q_diff, world[joint])
        local[joint] = to_local(rig, world)[joint]
    return local


def _off_axis_deg(right: TPose, local: FloatArray) -> dict[str, float]:
    """Return the angle between each bone and its axis in degrees, by body joint."""
    world = to_world(right.rig, ORIGIN, local)[1]
    return {bone.body_joint: _angle_deg(bone, world[bone.joint]) for bone in right.bones}


def _angle_deg(bone: Bone, world: FloatArray) -> float:
    k = unit(rotate(world, bone.direction))
    sine, cosine = np.linalg.norm(np.cross(k, bone.axis)), np.dot(k, bone.axis)
    return float(np.degrees(np.arctan2(sine, cosine)))


def _turned_deg(right: TPose, local: FloatArray) -> dict[str, float]:
    """Return the angle from each joint's correct local rotation to the given one, in degrees."""
    angles = np.degrees(geodesic_angle(right.local_rotations, local))
    return dict(zip(right.rig.names, angles.tolist(), strict=True))


def _normalised_at_the_end(v: FloatArray, k: FloatArray) -> FloatArray:
    """Return q_diff as printed: the axis v x k is not normalised, only the quaternion is."""
    angle = np.arccos(np.clip(np.dot(v, k), -1.0, 1.0))
    return normalise(np.array((np.cos(angle / 2), *(np.sin(angle / 2) * np.cross(v, k)))))


def test_without_a_mistake_it_is_the_products_t_pose(right: TPose) -> None:
    """Without a mistake, the test's own computation gives the product's T-pose."""
    assert max(_turned_deg(right, _aligned(right)).values()) < 1e-9


def test_swapping_parent_and_child_turns_every_bone_round(right: TPose) -> None:
    """With k from child to parent, as the paper's text says, all bones end 180 degrees off."""
    off = _off_axis_deg(right, _aligned(right, sign=-1.0))
    assert min(off.values()) == pytest.approx(180.0, abs=1e-4)


def test_normalising_only_the_quaternion_leaves_up_to_19_degrees(right: TPose) -> None:
    """Without normalising the axis first, the lower arms are 19.3 degrees off."""
    turned = _turned_deg(right, _aligned(right, difference=_normalised_at_the_end))
    assert max(turned.values()) == pytest.approx(19.3, abs=0.05)
    assert turned["lowerarm_l"] == pytest.approx(max(turned.values()))


def test_without_the_inverse_the_upper_arm_is_a_right_angle_off(right: TPose) -> None:
    """With q_diff in place of its inverse, the upper arm is 99.7 degrees off."""
    off = _off_axis_deg(right, _aligned(right, inverse=False))
    assert off["LeftUpperArm"] == pytest.approx(99.7, abs=0.05)
    assert off["RightUpperArm"] == pytest.approx(99.7, abs=0.05)


def test_leaf_first_bends_what_was_straight(right: TPose) -> None:
    """Aligning a bone before its parent leaves the lower arms 49.8 degrees off."""
    off = _off_axis_deg(right, _aligned(right, leaf_first=True))
    assert off["LeftLowerArm"] == pytest.approx(49.8, abs=0.1)


def test_stale_positions_bend_as_much(right: TPose) -> None:
    """Using the bones of the rest pose, without forward kinematics, gives large errors."""
    off = _off_axis_deg(right, _aligned(right, fresh=False))
    assert max(off.values()) > 40.0
    assert off["LeftLowerArm"] > 40.0


def test_the_printed_rotation_of_k_holds_in_the_joints_own_frame_only(right: TPose) -> None:
    """k_rotated = q_rotated k q_rotated^-1 gives the axis for k in the joint's frame only.

    For k in component space, where the paper computes it, q_diff^-1 gives the axis.
    """
    bone = next(bone for bone in right.bones if bone.body_joint == "LeftUpperArm")
    parent = right.world_rotations[right.rig.index("clavicle_l")]
    before = multiply(parent, right.rig.rest_rotations[bone.joint])
    k_local, k = unit(bone.direction), rotate(before, unit(bone.direction))
    q_diff = swing(bone.axis, k)
    q_rotated = multiply(conjugate(q_diff), before)
    np.testing.assert_allclose(rotate(q_rotated, k_local), bone.axis, atol=1e-12)
    np.testing.assert_allclose(rotate(conjugate(q_diff), k), bone.axis, atol=1e-12)
    printed = rotate(q_rotated, k)
    assert np.degrees(np.arccos(np.dot(printed, bone.axis))) > 45.0


def test_textbook_euler_angles_put_the_head_below_the_pelvis() -> None:
    """Euler angles as Rz Ry Rx turn the initial pose upside down; Unreal's signs do not."""
    rig = mannequin()
    angles_deg = np.array(list(INITIAL_DEG.values()))
    textbook = from_euler("ZYX", np.radians(angles_deg)[:, ::-1])
    head = rig.index("head")
    assert to_world(rig, ORIGIN, textbook)[0][head, 2] < -0.5
    assert to_world(rig, ORIGIN, from_rotator(angles_deg))[0][head, 2] > 0.5


def test_an_arccosine_loses_half_the_digits_of_single_precision() -> None:
    """In float32 bones are off by 5e-4 with arccos(v.k), and by 1e-7 with half-vectors."""
    rng = np.random.default_rng(17)
    by_arccos, by_half_vector = 0.0, 0.0
    for _ in range(3000):
        v = _single(unit(rng.normal(size=3)))
        k = _single(unit(v + 10.0 ** rng.uniform(-5, 0) * rng.normal(size=3)))
        by_arccos = max(by_arccos, _gap(_by_arccos(v, k), v, k))
        by_half_vector = max(by_half_vector, _gap(swing(v, k), v, k))
    assert 2e-4 < by_arccos < 1e-3
    assert by_half_vector < 5e-7


def _single(direction: FloatArray) -> FloatArray:
    return cast("FloatArray", direction.astype(np.float32))


def _by_arccos(v: FloatArray, k: FloatArray) -> FloatArray:
    angle = np.arccos(np.clip(np.dot(v, k), np.float32(-1), np.float32(1)))
    axis = np.cross(v, k)
    length = np.linalg.norm(axis)
    if length == 0.0:
        return _single(np.array((1.0, 0.0, 0.0, 0.0)))
    half = angle / np.float32(2)
    return _single(np.array((np.cos(half), *(np.sin(half) * axis / length))))


def _gap(q: FloatArray, v: FloatArray, k: FloatArray) -> float:
    landed = rotate(q.astype(np.float64), v.astype(np.float64))
    return float(np.linalg.norm(landed - k))
