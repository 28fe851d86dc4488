"""Tests that converting a whole recording to angles equals converting frame by frame."""

import numpy as np
import pytest

from app.science.avatar.body.parts import AXES, AXIS_NAMES, PART_NAMES
from app.science.avatar.configuration.limits import ANATOMIC
from app.science.avatar.targets.targets import TargetAngles, Targets
from app.science.rotations import FloatArray, from_rotation_vector, multiply, normalise
from app.science.skeleton.joints import JOINT_COUNT, JOINT_INDEX

FRAMES = 1300
"""More than two of the blocks in which a batch is computed."""


def wild_movement(frames: int = FRAMES, seed: int = 1) -> FloatArray:
    """Return a movement in which every joint turns at random, through every gimbal lock."""
    rng = np.random.default_rng(seed)
    turns = from_rotation_vector(rng.normal(scale=0.15, size=(frames, JOINT_COUNT, 3)))
    poses = np.empty((frames, JOINT_COUNT, 4))
    poses[0] = normalise(rng.normal(size=(JOINT_COUNT, 4)))
    for frame in range(1, frames):
        poses[frame] = normalise(multiply(poses[frame - 1], turns[frame]))
    return poses


def _one_by_one(poses: FloatArray, fingers: dict[str, FloatArray], restarts: set[int]) -> Targets:
    follower = TargetAngles(ANATOMIC)
    found = []
    for frame, pose in enumerate(poses):
        if frame in restarts:
            follower.forget()
        found.append(follower.follow(pose, {name: q[frame] for name, q in fingers.items()}))
    return Targets(
        np.stack([one.angles_rad for one in found]),
        np.stack([one.unclamped_rad for one in found]),
        np.stack([one.residual_rad for one in found]),
    )


@pytest.mark.parametrize("restarts", [set(), {0, 1, 511, 512, 700, 1024}])
def test_a_recording_equals_its_frames_to_the_bit(restarts: set[int]) -> None:
    """A recording gives the same angles as its frames, also with fingers and with restarts."""
    poses = wild_movement()
    fingers = {"LeftIndexProximal": wild_movement(seed=2)[:, 3]}
    begins = np.isin(np.arange(FRAMES), list(restarts))
    together = TargetAngles(ANATOMIC).batch(poses, fingers, restarts=begins)
    alone = _one_by_one(poses, fingers, restarts)
    np.testing.assert_array_equal(together.unclamped_rad, alone.unclamped_rad)
    np.testing.assert_array_equal(together.angles_rad, alone.angles_rad)
    np.testing.assert_array_equal(together.residual_rad, alone.residual_rad)


def test_a_restart_gives_what_a_new_converter_gives() -> None:
    """After a restart the angles do not depend on the frames before it."""
    poses = wild_movement()
    begins = np.arange(FRAMES) == 700
    joined = TargetAngles(ANATOMIC).batch(poses, restarts=begins).unclamped_rad
    np.testing.assert_array_equal(
        joined[700:], TargetAngles(ANATOMIC).batch(poses[700:]).unclamped_rad
    )
    followed = TargetAngles(ANATOMIC).batch(poses).unclamped_rad
    assert not np.array_equal(joined[700:], followed[700:])


def test_a_rotation_that_is_not_finite_costs_its_frame_only() -> None:
    """A non-finite rotation makes its angles NaN in its own frame only."""
    poses = wild_movement(40)
    broken = poses.copy()
    broken[20, JOINT_INDEX["LeftLowerArm"]] = np.nan
    found = TargetAngles(ANATOMIC).batch(broken)
    # The upper arm takes over part of the rotation so that the elbow's hinge fits.
    lost = np.array([axis.part in {"LeftUpperArm", "LeftLowerArm"} for axis in AXES])
    np.testing.assert_array_equal(np.isnan(found.unclamped_rad[20]), lost)
    np.testing.assert_array_equal(np.isnan(found.angles_rad[20]), lost)
    assert not found.clipped[20, lost].any()
    unknown = {PART_NAMES[part] for part in np.flatnonzero(np.isnan(found.residual_rad[20]))}
    assert unknown == {"LeftUpperArm", "LeftLowerArm"}
    as_ever = TargetAngles(ANATOMIC).batch(poses)
    np.testing.assert_array_equal(found.unclamped_rad[:, ~lost], as_ever.unclamped_rad[:, ~lost])
    without = TargetAngles(ANATOMIC).batch(np.delete(poses, 20, axis=0))
    arm = [column for column, axis in enumerate(AXES) if axis.part == "LeftUpperArm"]
    np.testing.assert_array_equal(
        np.delete(found.unclamped_rad, 20, axis=0)[:, arm], without.unclamped_rad[:, arm]
    )


def test_rounding_at_a_limit_is_not_clipping() -> None:
    """An elbow at its limit, rounded as in transmission, does not count as clipped."""
    straight = np.zeros((1, len(AXIS_NAMES)))
    noise = np.full_like(straight, -1e-7)
    assert not Targets(straight, noise, straight).clipped.any()
    assert Targets(straight, 100.0 * noise, straight).clipped.all()
