"""Tests of generated fingers: possible poses that do what their names say."""

import numpy as np
import pytest

from app.science.avatar.configuration.limits import ANATOMIC
from app.science.avatar.targets import finger_rotations
from app.science.avatar.targets.targets import rotations_of
from app.science.rotations import identity, is_unit
from app.science.simulation import (
    GESTURES_DEG,
    FingerCapsules,
    SimulatedFingers,
    gesture_angles,
)
from app.science.skeleton import (
    FINGER_PARTS,
    FINGERS,
    JOINT_NAMES,
    body_part_segments,
    build_skeleton,
    forward_kinematics,
)


def tip_distances_m(gesture: str) -> dict[str, float]:
    """Return how far the thumb's tip is from that of every other finger of a right hand."""
    skeleton = build_skeleton(1.72)
    world = forward_kinematics(skeleton, np.array([0.0, 1.0, 0.0]), identity(22))
    fingers = finger_rotations(gesture_angles(gesture, "Right"))
    axes_m, radii_m = FingerCapsules(skeleton).added_to(
        body_part_segments(skeleton, world), world, fingers
    )
    assert axes_m.shape == (52, 2, 3)
    assert radii_m.shape == (52,)
    rows = (*JOINT_NAMES, *FINGER_PARTS)
    tips = {name: axes_m[rows.index(f"Right{name}Distal"), 1] for name in FINGERS}
    return {name: float(np.linalg.norm(tips["Thumb"] - tips[name])) for name in FINGERS[1:]}


def test_gestures_are_within_the_limits_of_a_human_hand() -> None:
    """No joint of a gesture is bent further than a human hand allows."""
    for angles in GESTURES_DEG.values():
        for axis, deg in angles.items():
            limits = ANATOMIC[f"Left{axis}"]
            assert limits.low_rad <= np.radians(deg) <= limits.high_rad


@pytest.mark.parametrize(
    ("gesture", "finger"), [("pinch", "Index"), ("thumb opposition", "Little")]
)
def test_a_thumb_meets_the_finger_that_its_gesture_names(gesture: str, finger: str) -> None:
    """In a pinch the thumb's tip is at that of the index, in opposition at the little finger's."""
    distances_m = tip_distances_m(gesture)
    assert min(distances_m, key=distances_m.__getitem__) == finger
    assert distances_m[finger] < 0.015
    assert tip_distances_m("open")[finger] > 0.1


def test_a_rotation_of_fingers_is_the_product_of_its_hinges() -> None:
    """All fingers at once have the same rotations as part by part."""
    angles = np.random.default_rng(5).uniform(-1.0, 1.0, (7, 91))
    each = rotations_of(angles, FINGER_PARTS)
    expected = np.stack([each[part] for part in FINGER_PARTS], axis=-2)
    np.testing.assert_allclose(finger_rotations(angles), expected, atol=1e-12)


def test_fingers_move_smoothly_point_when_reaching_and_repeat_with_their_seed() -> None:
    """Generated fingers never jump, and a reaching hand stretches its index finger only."""
    one, other = (SimulatedFingers(np.random.default_rng(4)) for _ in range(2))
    times_s = np.arange(0.0, 6.0, 1.0 / 90.0)
    poses = np.stack([one.pose(t, "RightHand" if t > 3.0 else None) for t in times_s])
    again = np.stack([other.pose(t, "RightHand" if t > 3.0 else None) for t in times_s])
    assert np.array_equal(poses, again)
    assert is_unit(poses).all()
    cosine = np.abs(np.einsum("njk,njk->nj", poses[1:], poses[:-1])).clip(max=1.0)
    assert np.degrees(2.0 * np.arccos(cosine)).max() < 15.0
    bent_rad = 2.0 * np.arccos(poses[-1, :, 0].clip(-1.0, 1.0))
    assert np.degrees(bent_rad[FINGER_PARTS.index("RightIndexIntermediate")]) < 5.0
    assert np.degrees(bent_rad[FINGER_PARTS.index("RightRingIntermediate")]) > 80.0
