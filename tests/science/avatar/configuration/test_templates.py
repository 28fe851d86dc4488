"""Tests of the two joint templates and their conversion.

Karas (2020), sections 2.2.3, 4.2.3 and 6.3.
"""

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given

from app.science.avatar.body.parts import AXES_OF
from app.science.avatar.configuration.axis_settings import (
    AvatarSettingsError,
    AxisSettings,
    degrees_of,
)
from app.science.avatar.configuration.templates import (
    Drive,
    SingleJoint,
    edited,
    primary_axis,
    shared_axes,
    single_template,
    to_multiple,
    to_single,
    with_single_template,
)
from tests.science.avatar.configurations import (
    DRIVEN,
    FINE_SPRING,
    axes_of_part,
    drives,
    limits_rad,
    part_axes,
    single_joints,
    whole_body,
)

THIGH = "LeftUpperLeg"
FIGURE_2_5 = Drive(kp=9011.971, kd=376.5483, max_torque_nm=2000.0)
FIGURE_6_1 = Drive(kp=6143.597, kd=529.7784, max_torque_nm=1200.0)


def ranged(low_deg: float, high_deg: float, drive: Drive = FIGURE_6_1) -> AxisSettings:
    """Return axis settings with these limits."""
    low, high = math.radians(low_deg), math.radians(high_deg)
    return AxisSettings(drive.kp, drive.kd, drive.max_torque_nm, low, high)


def figure_2_4() -> SingleJoint:
    """Return the thesis's example of a joint: x from -41 to 125, y 45, z 35 degrees."""
    return SingleJoint(
        part=THIGH,
        low_rad=math.radians(-41.0),
        high_rad=math.radians(125.0),
        drive=FIGURE_2_5,
        limits_rad={"LeftUpperLegY": math.radians(45.0), "LeftUpperLegZ": math.radians(35.0)},
        shared_drive=FIGURE_6_1,
    )


def degrees(settings: AxisSettings) -> tuple[float, float]:
    """Return the limits of an axis in degrees."""
    return degrees_of(settings.low_rad), degrees_of(settings.high_rad)


def test_the_thesis_joint_splits_into_its_axes() -> None:
    """The joint of figures 2.4 and 2.5 gives axes with symmetric y and z limits and its drives."""
    axes = to_multiple(figure_2_4())
    assert {name: degrees(one) for name, one in axes.items()} == {
        "LeftUpperLegX": (-41.0, 125.0),
        "LeftUpperLegZ": (-35.0, 35.0),
        "LeftUpperLegY": (-45.0, 45.0),
    }
    assert axes["LeftUpperLegX"].kp == 9011.971
    assert axes["LeftUpperLegY"].kd == axes["LeftUpperLegZ"].kd == 529.7784
    assert axes["LeftUpperLegX"].max_torque_nm == 2000.0


def test_twenty_degrees_become_twenty_either_way() -> None:
    """A limit of 20 degrees becomes a range from -20 to 20 degrees (figure 4.8)."""
    joint = figure_2_4()
    joint = replace(joint, limits_rad={**joint.limits_rad, "LeftUpperLegZ": math.radians(20.0)})
    assert degrees(to_multiple(joint)["LeftUpperLegZ"]) == (-20.0, 20.0)


@given(single_joints())
def test_single_to_multiple_and_back_is_the_same_joint(joint: SingleJoint) -> None:
    """A single joint converted to multiple axes and back is unchanged."""
    assert to_single(joint.part, to_multiple(joint)) == joint


@given(part_axes())
def test_multiple_to_single_allows_every_pose(drawn: tuple[str, dict[str, AxisSettings]]) -> None:
    """A symmetric limit is the larger of an axis's two; the primary axis keeps both."""
    part, axes = drawn
    joint = to_single(part, axes)
    primary = axes[primary_axis(part)]
    assert (joint.low_rad, joint.high_rad) == (primary.low_rad, primary.high_rad)
    for name in shared_axes(part):
        assert joint.limits_rad[name] == max(abs(axes[name].low_rad), abs(axes[name].high_rad))
        wide = to_multiple(joint)[name]
        assert wide.low_rad <= axes[name].low_rad <= axes[name].high_rad <= wide.high_rad


@given(part_axes())
def test_an_unedited_single_joint_changes_no_axis(
    drawn: tuple[str, dict[str, AxisSettings]],
) -> None:
    """Axes shown as a single joint and stored unedited keep both limits and every drive."""
    part, axes = drawn
    assert edited(to_single(part, axes), axes) == axes


@given(part_axes(), limits_rad)
def test_an_edited_limit_replaces_the_larger_of_the_two(
    drawn: tuple[str, dict[str, AxisSettings]], limit_rad: float
) -> None:
    """An edited limit replaces the larger of an axis's two; the other stays where possible."""
    part, axes = drawn
    assume(shared_axes(part))
    name = shared_axes(part)[0]
    before = axes[name]
    joint = to_single(part, axes)
    joint = replace(joint, limits_rad={**joint.limits_rad, name: limit_rad})
    after = edited(joint, axes)
    assert {other: one for other, one in after.items() if other != name} == {
        other: one for other, one in axes.items() if other != name
    }
    assume(joint.limits_rad != to_single(part, axes).limits_rad)
    settled = joint.limits_rad[name]
    if before.low_rad == -before.high_rad:
        assert (after[name].low_rad, after[name].high_rad) == (-settled, settled)
    elif abs(before.low_rad) > abs(before.high_rad):
        assert after[name].low_rad == -settled
        assert after[name].high_rad == max(before.high_rad, -settled)
    else:
        assert after[name].high_rad == settled
        assert after[name].low_rad == min(before.low_rad, settled)


def test_the_smaller_side_is_kept_in_the_multiple_template() -> None:
    """Editing the shown limit 45 to 30 keeps the other limit at -20 (section 6.3)."""
    axes = axes_of_part(THIGH, ranged(-41.0, 125.0), ranged(-20.0, 45.0), ranged(-50.0, 10.0))
    joint = to_single(THIGH, axes)
    second, third = shared_axes(THIGH)
    assert [degrees_of(joint.limits_rad[name]) for name in (second, third)] == [45.0, 50.0]
    narrow = {second: math.radians(30.0), third: math.radians(60.0)}
    after = edited(replace(joint, limits_rad=narrow), axes)
    assert degrees(after[second]) == (-20.0, 30.0)
    assert degrees(after[third]) == (-60.0, 10.0)


def test_a_range_that_excludes_the_t_pose_stays_ordered() -> None:
    """A range from 20 to 45 degrees edited to 10 has both limits at 10."""
    axes = axes_of_part(THIGH, ranged(-41.0, 125.0), ranged(20.0, 45.0), ranged(-45.0, -20.0))
    second, third = shared_axes(THIGH)
    ten = dict.fromkeys((second, third), math.radians(10.0))
    after = edited(replace(to_single(THIGH, axes), limits_rad=ten), axes)
    assert degrees(after[second]) == (10.0, 10.0)
    assert degrees(after[third]) == (-10.0, -10.0)


def test_the_common_drive_is_the_stiffest_taken_whole() -> None:
    """The shared drive is that of the stiffest axis; gains of several axes are not mixed."""
    soft = ranged(-20.0, 20.0, Drive(kp=100.0, kd=900.0, max_torque_nm=9000.0))
    axes = axes_of_part(THIGH, ranged(-41.0, 125.0, FIGURE_2_5), soft, ranged(-30.0, 30.0))
    joint = to_single(THIGH, axes)
    assert (joint.drive, joint.shared_drive) == (FIGURE_2_5, FIGURE_6_1)


@given(part_axes(), drives)
def test_an_edited_common_drive_applies_to_every_sharing_axis(
    drawn: tuple[str, dict[str, AxisSettings]], drive: Drive
) -> None:
    """An edited shared drive applies to all sharing axes; limits and the primary axis stay."""
    part, axes = drawn
    assume(shared_axes(part) and to_single(part, axes).shared_drive != drive)
    after = edited(replace(to_single(part, axes), shared_drive=drive), axes)
    assert to_single(part, after) == replace(to_single(part, axes), shared_drive=drive)
    assert after[primary_axis(part)] == axes[primary_axis(part)]
    for name in shared_axes(part):
        assert after[name].kp == drive.kp
        assert after[name].low_rad == axes[name].low_rad


def test_every_driven_part_has_one_primary_axis() -> None:
    """Every driven part has one primary axis, the same on both sides, and shares the others."""
    for part in DRIVEN:
        names = [axis.name for axis in AXES_OF[part]]
        assert sorted([primary_axis(part), *shared_axes(part)]) == sorted(names)
        if part.startswith("Left"):
            right = part.replace("Left", "Right")
            assert primary_axis(right) == primary_axis(part).replace("Left", "Right")
    assert primary_axis("LeftUpperLeg") == "LeftUpperLegX"
    assert primary_axis("LeftIndexProximal") == "LeftIndexProximalZ"
    assert primary_axis("LeftLowerArm") == "LeftLowerArmY"


def test_a_configuration_is_edited_part_by_part() -> None:
    """Parts that are not named or that the model lacks stay unchanged."""
    body = whole_body()
    template = single_template(body)
    assert set(template) == set(DRIVEN)
    assert with_single_template(body, template.values()) == body
    drive = replace(template["Head"].drive, kp=7.0)
    after = with_single_template(body, [replace(template["Head"], drive=drive)])
    assert after.axes["HeadX"].kp == 7.0
    assert after.axes["HeadY"] == FINE_SPRING
    headless = replace(body, axes={n: s for n, s in body.axes.items() if not n.startswith("Head")})
    assert with_single_template(headless, [template["Head"]]) == headless


@pytest.mark.parametrize(
    ("change", "expected_message"),
    [
        ({"part": "LeftShoulder"}, "'LeftShoulder' is not a driven body part"),
        ({"part": "Tail"}, "'Tail' is not a driven body part"),
        ({"limits_rad": {"LeftUpperLegY": 0.5}}, "do not match the axes of"),
        ({"shared_drive": None}, "do not match the axes of"),
        ({"limits_rad": {"LeftUpperLegY": 0.5, "LeftUpperLegZ": -0.5}}, "cannot be -28.6479 deg"),
    ],
)
def test_a_joint_that_does_not_fit_its_part_is_rejected(
    change: dict[str, object], expected_message: str
) -> None:
    """A single joint that does not match its part raises an error that states what is valid."""
    with pytest.raises(AvatarSettingsError, match=expected_message) as caught:
        replace(figure_2_4(), **change)  # type: ignore[arg-type]  # the fact
    assert caught.value.problems[0].valid
