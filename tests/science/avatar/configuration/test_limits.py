"""Tests of the ranges of the axes, and of the layers of the body that collide."""

from math import degrees, pi

import pytest

from app.science.avatar.body.layers import COLLIDING, LAYER_OF, LAYERS, collide, collision_bits
from app.science.avatar.body.parts import AXIS_NAMES, PART_NAMES, mirrored_name
from app.science.avatar.configuration.limits import ANATOMIC, ESTIMATE, FREE, limits_of


@pytest.mark.parametrize("limits", [ANATOMIC, FREE])
def test_every_axis_has_limits_around_the_t_pose(limits: dict[str, object]) -> None:
    """Every axis has limits that include the T-pose; both are zero for a locked axis."""
    assert tuple(limits) == AXIS_NAMES
    for name in AXIS_NAMES:
        bounds = limits_of("free" if limits is FREE else "anatomic")[name]
        assert -pi <= bounds.low_rad <= 0.0 <= bounds.high_rad <= pi, name
        assert bounds.low_rad < bounds.high_rad or bounds.low_rad == bounds.high_rad == 0.0, name
        assert bounds.source, name


def test_both_sides_turn_equally_far() -> None:
    """Left and right axes have equal limits, since their directions are already mirrored."""
    for name in AXIS_NAMES:
        assert ANATOMIC[name] == ANATOMIC[mirrored_name(name)]


@pytest.mark.parametrize(
    ("axis", "low_deg", "high_deg"),
    [
        ("LeftLowerArmY", 0.0, 150.0),  # AAOS: elbow flexion
        ("RightLowerArmX", -80.0, 80.0),  # AAOS: supination, pronation
        ("LeftHandZ", -70.0, 80.0),  # AAOS: wrist extension, flexion
        ("LeftHandY", -30.0, 20.0),  # AAOS: ulnar and radial deviation
        ("LeftUpperLegX", -15.0, 125.0),  # Merck: hyperextension, flexion
        ("RightLowerLegX", 0.0, 130.0),  # Merck: knee flexion
        ("LeftFootX", -50.0, 20.0),  # Merck: plantar flexion, dorsiflexion
        ("LeftFootZ", -25.0, 35.0),  # Merck: eversion, inversion
    ],
)
def test_published_ranges(axis: str, low_deg: float, high_deg: float) -> None:
    """Ranges from handbooks equal the published values and are not marked as estimates."""
    bounds = ANATOMIC[axis]
    assert (degrees(bounds.low_rad), degrees(bounds.high_rad)) == pytest.approx((low_deg, high_deg))
    assert not bounds.estimated


def test_the_neck_turns_as_far_as_published_in_all() -> None:
    """The limits of neck and head together are 45 degrees forward, back and to each side."""
    for letter in "XZ":
        both = sum(ANATOMIC[f"{part}{letter}"].high_rad for part in ("Neck", "Head"))
        assert degrees(both) == pytest.approx(45.0)


def test_the_presets_differ_only_in_the_elbows_third_axis() -> None:
    """`anatomic` locks the elbow's third axis; `free` lets it turn fully, as the thesis did."""
    differing = {name for name in AXIS_NAMES if ANATOMIC[name] != FREE[name]}
    assert differing == {"LeftLowerArmZ", "RightLowerArmZ"}
    assert (FREE["LeftLowerArmZ"].low_rad, FREE["LeftLowerArmZ"].high_rad) == (-pi, pi)
    assert ANATOMIC["LeftLowerArmZ"].low_rad == ANATOMIC["LeftLowerArmZ"].high_rad == 0.0


def test_estimates_are_marked_as_estimates() -> None:
    """The shares of the spine and the turn of the wrist are our estimates and marked as such."""
    for axis in ("SpineX", "HeadY", "LeftHandX", "LeftFootY"):
        assert ANATOMIC[axis].source.startswith(ESTIMATE)


def test_every_part_has_a_layer() -> None:
    """Every part has a collision layer: fingers the hand's, toes the foot's, head the torso's."""
    assert tuple(LAYER_OF) == PART_NAMES
    assert set(LAYER_OF.values()) == set(LAYERS)
    assert LAYER_OF["LeftRingDistal"] == "left_hand"
    assert LAYER_OF["RightToes"] == "right_foot"
    assert LAYER_OF["Head"] == "torso"


def test_a_hand_touches_arms_and_upper_body_and_an_arm_does_not() -> None:
    """Hands collide with arms and torso; an arm does not collide with the torso.

    Karas 2020, section 4.2.1.
    """
    assert collide("LeftHand", "Chest")
    assert collide("LeftHand", "LeftUpperArm")
    assert collide("LeftIndexDistal", "RightLowerArm")
    assert collide("LeftHand", "RightShoulder")
    assert not collide("LeftLowerArm", "Chest")
    assert not collide("LeftUpperArm", "LeftShoulder")


def test_no_layer_collides_with_itself() -> None:
    """Parts of one layer, such as the fingers of a hand, pass through each other."""
    assert all(len(pair) == 2 for pair in COLLIDING)


@pytest.mark.parametrize("self_collision", [True, False])
def test_collision_masks_match_the_layers(*, self_collision: bool) -> None:
    """Two parts' masks match exactly where their layers collide, and always match the scene's."""
    bits = {part: collision_bits(part, self_collision=self_collision) for part in PART_NAMES}
    for part, a in bits.items():
        assert a.contype & 1
        for other, b in bits.items():
            meet = bool(a.contype & b.conaffinity or b.contype & a.conaffinity)
            assert meet == (self_collision and collide(part, other)), (part, other)
