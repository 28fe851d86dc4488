"""The two templates and the way between them: Karas (2020), sections 2.2.3, 4.2.3 and 6.3."""

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
    """An axis with these limits."""
    low, high = math.radians(low_deg), math.radians(high_deg)
    return AxisSettings(drive.kp, drive.kd, drive.max_torque_nm, low, high)


def figure_2_4() -> SingleJoint:
    """The thesis's example of a joint: x from -41 to 125, y 45, z 35 degrees."""
    return SingleJoint(
        part=THIGH,
        low_rad=math.radians(-41.0),
        high_rad=math.radians(125.0),
        drive=FIGURE_2_5,
        limits_rad={"LeftUpperLegY": math.radians(45.0), "LeftUpperLegZ": math.radians(35.0)},
        shared_drive=FIGURE_6_1,
    )


def degrees(settings: AxisSettings) -> tuple[float, float]:
    """The limits of an axis."""
    return degrees_of(settings.low_rad), degrees_of(settings.high_rad)


def test_the_thesis_joint_splits_into_its_axes() -> None:
    """Figures 2.4 and 2.5: y and z limits go both ways, each axis gets the drive it had."""
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
    """Figure 4.8."""
    joint = figure_2_4()
    joint = replace(joint, limits_rad={**joint.limits_rad, "LeftUpperLegZ": math.radians(20.0)})
    assert degrees(to_multiple(joint)["LeftUpperLegZ"]) == (-20.0, 20.0)


@given(single_joints())
def test_single_to_multiple_and_back_is_the_same_joint(joint: SingleJoint) -> None:
    """Nothing is lost that way."""
    assert to_single(joint.part, to_multiple(joint)) == joint


@given(part_axes())
def test_multiple_to_single_allows_every_pose(drawn: tuple[str, dict[str, AxisSettings]]) -> None:
    """The symmetric limit is the greater of the two, and the primary axis keeps both."""
    part, axes = drawn
    joint = to_single(part, axes)
    primary = axes[primary_axis(part)]
    assert (joint.low_rad, joint.high_rad) == (primary.low_rad, primary.high_rad)
    for name in shared_axes(part):
        assert joint.limits_rad[name] == max(abs(axes[name].low_rad), abs(axes[name].high_rad))
        wide = to_multiple(joint)[name]
        assert wide.low_rad <= axes[name].low_rad <= axes[name].high_rad <= wide.high_rad


@given(part_axes())
def test_a_joint_that_was_only_looked_at_changes_nothing(
    drawn: tuple[str, dict[str, AxisSettings]],
) -> None:
    """Multiple, seen as single and put back, is as it was, with both sides and every drive."""
    part, axes = drawn
    assert edited(to_single(part, axes), axes) == axes


@given(part_axes(), limits_rad)
def test_an_edited_limit_goes_to_the_side_it_came_from(
    drawn: tuple[str, dict[str, AxisSettings]], limit_rad: float
) -> None:
    """The other side stays, as far as a range of one side of the T-pose allows."""
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
    """Section 6.3 with numbers: 45 is shown; 30 replaces it; -20 stays."""
    axes = axes_of_part(THIGH, ranged(-41.0, 125.0), ranged(-20.0, 45.0), ranged(-50.0, 10.0))
    joint = to_single(THIGH, axes)
    second, third = shared_axes(THIGH)
    assert [degrees_of(joint.limits_rad[name]) for name in (second, third)] == [45.0, 50.0]
    narrow = {second: math.radians(30.0), third: math.radians(60.0)}
    after = edited(replace(joint, limits_rad=narrow), axes)
    assert degrees(after[second]) == (-20.0, 30.0)
    assert degrees(after[third]) == (-60.0, 10.0)


def test_a_range_beside_the_t_pose_does_not_turn_inside_out() -> None:
    """From 20 to 45 degrees, edited to 10: both limits are 10."""
    axes = axes_of_part(THIGH, ranged(-41.0, 125.0), ranged(20.0, 45.0), ranged(-45.0, -20.0))
    second, third = shared_axes(THIGH)
    ten = dict.fromkeys((second, third), math.radians(10.0))
    after = edited(replace(to_single(THIGH, axes), limits_rad=ten), axes)
    assert degrees(after[second]) == (10.0, 10.0)
    assert degrees(after[third]) == (-10.0, -10.0)


def test_the_common_drive_is_the_stiffest_taken_whole() -> None:
    """A kp is not mixed with the kd of another axis."""
    soft = ranged(-20.0, 20.0, Drive(kp=100.0, kd=900.0, max_torque_nm=9000.0))
    axes = axes_of_part(THIGH, ranged(-41.0, 125.0, FIGURE_2_5), soft, ranged(-30.0, 30.0))
    joint = to_single(THIGH, axes)
    assert (joint.drive, joint.shared_drive) == (FIGURE_2_5, FIGURE_6_1)


@given(part_axes(), drives)
def test_an_edited_common_drive_is_every_sharing_axis_drive(
    drawn: tuple[str, dict[str, AxisSettings]], drive: Drive
) -> None:
    """What was set is what is seen afterwards; limits and the primary axis stay."""
    part, axes = drawn
    assume(shared_axes(part) and to_single(part, axes).shared_drive != drive)
    after = edited(replace(to_single(part, axes), shared_drive=drive), axes)
    assert to_single(part, after) == replace(to_single(part, axes), shared_drive=drive)
    assert after[primary_axis(part)] == axes[primary_axis(part)]
    for name in shared_axes(part):
        assert after[name].kp == drive.kp
        assert after[name].low_rad == axes[name].low_rad


def test_every_driven_part_has_one_primary_axis() -> None:
    """And shares the others; the left side's is the right side's."""
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
    """Parts that are not named, and parts that the model lacks, stay as they are."""
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
    ("change", "said"),
    [
        ({"part": "LeftShoulder"}, "'LeftShoulder' is not a driven body part"),
        ({"part": "Tail"}, "'Tail' is not a driven body part"),
        ({"limits_rad": {"LeftUpperLegY": 0.5}}, "do not match the axes of"),
        ({"shared_drive": None}, "do not match the axes of"),
        ({"limits_rad": {"LeftUpperLegY": 0.5, "LeftUpperLegZ": -0.5}}, "cannot be -28.6479 deg"),
    ],
)
def test_a_joint_that_does_not_fit_its_part_is_refused(
    change: dict[str, object], said: str
) -> None:
    """With what is valid."""
    with pytest.raises(AvatarSettingsError, match=said) as caught:
        replace(figure_2_4(), **change)  # type: ignore[arg-type]  # the fact
    assert caught.value.problems[0].valid
