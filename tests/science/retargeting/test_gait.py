"""Tests of contacts, steps and leg angles of synthetic walks whose truth is known."""

import numpy as np
import pytest

from app.science.retargeting.contacts import find_contacts, mean_slide_m_s
from app.science.retargeting.gait import walk_figures
from app.science.retargeting.ground import Ramp
from app.science.retargeting.leg_angles import leg_angles
from app.science.retargeting.legs import legs_of
from app.science.retargeting.reference_avatars import reference_avatar
from app.science.retargeting.verification import lift_times_s
from app.science.rig import Rig, RigError, RigMotion
from app.science.rotations import from_rotation_vector, identity, multiply, rotate
from tests.science.retargeting.bodies import SAME, scaled
from tests.science.retargeting.walks import RATE_HZ, made_walk, mapped

_BODY = reference_avatar(1.75)
_WALK = made_walk(_BODY)


def _turned(motion: RigMotion, angle_rad: float) -> RigMotion:
    """Return the same movement in a world turned about the vertical."""
    turn = from_rotation_vector(np.array((0.0, angle_rad, 0.0)))
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(turn, rotations[:, 0])
    root = rotate(turn, motion.root_positions_m)
    return RigMotion(motion.rig, motion.rate_hz, root, rotations, motion.observed)


def _noisy(motion: RigMotion, rng: np.random.Generator, spread_m: float) -> RigMotion:
    root = motion.root_positions_m + rng.normal(0.0, spread_m, motion.root_positions_m.shape)
    return RigMotion(motion.rig, motion.rate_hz, root, motion.rotations, motion.observed)


def test_strides_of_a_made_walk_are_as_long_and_high_as_they_were_made() -> None:
    """Lengths and heights of strides are found; the first and the closing one are half as long."""
    walk = walk_figures(_WALK.motion, mapped(_BODY))
    assert [step.side for step in walk.strides] == ["left", "right", "left", "right", "left"]
    assert [step.length_m for step in walk.strides] == pytest.approx(_WALK.lengths_m, abs=1e-9)
    assert [step.height_m for step in walk.strides] == pytest.approx([_WALK.height_m] * 5, abs=1e-3)


def test_a_step_leads_from_one_foot_to_the_other() -> None:
    """Each step is half a stride: feet are set down 0.6 m apart, and closed at the end."""
    walk = walk_figures(_WALK.motion, mapped(_BODY))
    assert walk.step_lengths_m[-5:] == pytest.approx([0.6, 0.6, 0.6, 0.6, 0.0], abs=1e-9)
    assert walk.mean_stride_length_m == pytest.approx(np.mean(_WALK.lengths_m), abs=1e-9)


def test_lifts_are_found_when_the_feet_leave_and_come_down() -> None:
    """Lifts and contacts are found within 0.06 s of the truth."""
    walk = walk_figures(_WALK.motion, mapped(_BODY))
    found = [(step.lift_s, step.contact_s) for step in walk.strides]
    assert np.array(found) == pytest.approx(np.array(_WALK.lifts_s), abs=0.06)
    assert lift_times_s(walk, "right") == tuple(
        (step.lift_s, step.contact_s) for step in walk.strides if step.side == "right"
    )


def test_a_standing_foot_does_not_slide_in_its_middle() -> None:
    """A foot does not slide in the middle of a contact; at its edges, by a few cm/s at most."""
    legs = mapped(_BODY)
    slide = mean_slide_m_s(legs.balls_m(*_WALK.motion.world()), find_contacts(_WALK.motion, legs))
    assert slide is not None
    assert slide < 0.04


@pytest.mark.parametrize("factor", [0.01, 0.6, 1.7])
def test_contacts_do_not_depend_on_size(factor: float) -> None:
    """A scaled body with the same movement has contacts in the same frames."""
    motion = _WALK.motion
    other = RigMotion(
        scaled(motion.rig, factor),
        motion.rate_hz,
        factor * motion.root_positions_m,
        motion.rotations,
        motion.observed,
    )
    here = find_contacts(motion, mapped(_BODY)).down
    assert np.array_equal(here, find_contacts(other, mapped(other.rig)).down)


@pytest.mark.parametrize("angle_rad", [0.7, 2.0, -3.0])
def test_steps_do_not_depend_on_where_the_walk_heads(angle_rad: float) -> None:
    """Steps do not depend on the direction of the walk in the room."""
    turned = walk_figures(_turned(_WALK.motion, angle_rad), mapped(_BODY))
    assert [s.length_m for s in turned.strides] == pytest.approx(_WALK.lengths_m, abs=1e-9)


def test_noise_of_a_millimetre_adds_no_lift() -> None:
    """Noise of a millimetre on the positions adds no lift of a foot.

    Hysteresis and a shortest gap of 0.06 s prevent it.
    """
    rng = np.random.default_rng(11)
    walk = walk_figures(_noisy(_WALK.motion, rng, 0.001), mapped(_BODY))
    assert len(walk.strides) == len(_WALK.lengths_m)
    assert [step.length_m for step in walk.strides] == pytest.approx(_WALK.lengths_m, abs=0.01)


def test_a_floor_that_drifts_does_not_hide_contacts() -> None:
    """All steps are found on a floor that tilts by 2 cm per metre, as captured floors do."""
    root = _WALK.motion.root_positions_m.copy()
    root[:, 1] -= 0.02 * root[:, 2]
    tilted = RigMotion(_BODY, RATE_HZ, root, _WALK.motion.rotations, _WALK.motion.observed)
    assert len(walk_figures(tilted, mapped(_BODY)).strides) == len(_WALK.lengths_m)


def test_standing_still_is_one_contact_without_a_step() -> None:
    """While standing still both feet are down in all frames and there is no step."""
    still = RigMotion(
        _BODY,
        RATE_HZ,
        np.tile(_BODY.offsets_m[0], (60, 1)),
        identity(60, _BODY.joint_count),
        np.ones((60, _BODY.joint_count), dtype=np.bool_),
    )
    walk = walk_figures(still, mapped(_BODY))
    assert walk.contacts.intervals(0) == walk.contacts.intervals(1) == [(0, 59)]
    assert walk.strides == ()
    assert walk.mean_stride_length_m is None
    assert walk.slide_m_s == 0.0


def test_heights_are_above_the_ground() -> None:
    """On a ramp the height of the foot is counted from the ramp below it."""
    up = Ramp((0.0, 0.0), (0.0, -1.0), run_m=10.0, rise_m=1.0)
    flat = walk_figures(_WALK.motion, mapped(_BODY)).feet[0]
    over = walk_figures(_WALK.motion, mapped(_BODY), up).feet[0]
    start_z = _BODY.rest_world()[0][_BODY.index("LeftToes"), 2]
    walked = -start_z + flat.forward_m - flat.forward_m[0]
    assert flat.height_m - over.height_m == pytest.approx(0.1 * walked, abs=1e-9)


def _bent(joint: str, angle_rad: float) -> RigMotion:
    """Return two frames of a body at rest with one joint turned about the axis to its right."""
    rotations = identity(2, _BODY.joint_count)
    rotations[:, _BODY.index(joint)] = from_rotation_vector(np.array((angle_rad, 0.0, 0.0)))
    root = np.tile(_BODY.offsets_m[0], (2, 1))
    return RigMotion(
        _BODY, RATE_HZ, root, rotations, np.ones((2, _BODY.joint_count), dtype=np.bool_)
    )


def test_leg_angles_are_zero_standing_and_grow_with_flexion() -> None:
    """Thigh forward, shin back and toes up are positive, each by the angle turned."""
    rest = leg_angles(_bent("Head", 0.0), SAME)[0]
    hip = leg_angles(_bent("LeftUpperLeg", 0.5), SAME)[0]
    knee = leg_angles(_bent("LeftLowerLeg", -0.7), SAME)[0]
    ankle = leg_angles(_bent("LeftFoot", 0.2), SAME)[0]
    assert rest.hip_rad == pytest.approx([0.0, 0.0], abs=1e-12)
    assert rest.knee_rad == pytest.approx([0.0, 0.0], abs=1e-12)
    assert hip.hip_rad == pytest.approx([0.5, 0.5])
    assert knee.knee_rad == pytest.approx([0.7, 0.7])
    assert ankle.ankle_rad - rest.ankle_rad == pytest.approx([0.2, 0.2])
    assert leg_angles(_bent("LeftUpperLeg", 0.5), SAME)[1].hip_rad == pytest.approx([0.0, 0.0])


def test_legs_that_are_not_mapped_are_named() -> None:
    """Walk figures of an upper body raise an error with the leg joints that are not mapped."""
    upper = {name: name for name in SAME if "Leg" not in name}
    with pytest.raises(RigError, match="no LeftUpperLeg, LeftLowerLeg, RightUpperLeg"):
        legs_of(_BODY, upper)


def test_without_toe_joints_the_end_of_the_foot_is_followed() -> None:
    """Without mapped toes the free end of the foot is followed, or else the ankle."""
    no_toes = {name: name for name in SAME if "Toes" not in name}
    assert legs_of(_BODY, no_toes).left.ball == _BODY.index("LeftFoot")
    tip = (0.0, -0.04, -0.15)
    ended = Rig(
        _BODY.names,
        _BODY.parents,
        _BODY.offsets_m,
        _BODY.rest_rotations,
        ((_BODY.index("LeftFoot"), tip),),
    )
    assert legs_of(ended, no_toes).left.ball_in_joint_m == tip
