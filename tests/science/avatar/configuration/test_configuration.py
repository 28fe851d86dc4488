"""Tests of avatar configurations: validation, groups, locks, and edits."""

import math
from dataclasses import replace

import pytest

from app.science.avatar.body.parts import AXIS_NAMES, PART_NAMES, mirrored_name
from app.science.avatar.configuration.axis_settings import AvatarSettingsError
from app.science.avatar.configuration.configuration import Configuration
from app.science.avatar.configuration.editing import (
    lock,
    mirror_left_to_right,
    unlock,
    with_axis,
    with_global,
    without_parts,
)
from app.science.avatar.configuration.groups import GROUP_NAMES, GROUPS, axes_of, parts_of
from app.science.avatar.mjcf.gains import default_configuration
from tests.science.avatar.configurations import FINE_SPRING, whole_body

BODY = whole_body()


def test_the_shipped_configuration_drives_every_axis() -> None:
    """Every axis of the default configuration has gains and limits that include the T-pose."""
    shipped = default_configuration()
    assert tuple(shipped.axes) == AXIS_NAMES
    for settings in shipped.axes.values():
        if not settings.locked:
            assert min(settings.kp, settings.kd, settings.max_torque_nm) > 0.0
        assert settings.low_rad <= 0.0 <= settings.high_rad


def test_axes_come_in_the_order_of_the_body() -> None:
    """Axes are sorted in the body's order, so that equal configurations compare and hash equal."""
    shuffled = Configuration({name: BODY.axes[name] for name in reversed(AXIS_NAMES)})
    assert tuple(shuffled.axes) == AXIS_NAMES
    assert shuffled == BODY
    assert hash(shuffled) == hash(BODY)


@pytest.mark.parametrize(
    ("change", "path", "expected_message"),
    [
        ({"axes": {}}, "axes", "No axis"),
        ({"axes": {**BODY.axes, "TailX": FINE_SPRING}}, "axes.TailX", "no axis 'TailX'"),
        ({"axes": {"HeadX": FINE_SPRING}}, "axes.HeadZ", "Head lacks its axis HeadZ"),
        ({"total_mass_kg": math.nan}, "total_mass_kg", "is not a valid body mass"),
        ({"total_mass_kg": 0.5}, "total_mass_kg", "0.5 kg is not a valid"),
        ({"population": "martian"}, "population", "'martian' is not one"),
        ({"hips": "floating"}, "hips", "'floating' is not one"),
        ({"target_space": "joint"}, "target_space", "'joint' is not one"),
        ({"colliders": "box"}, "colliders", "'box' is not one"),
        ({"part_colliders": {"Tail": "mesh"}}, "part_colliders.Tail", "'Tail' is not one"),
        ({"part_colliders": {"Head": "box"}}, "part_colliders.Head", "'box' is not one"),
        ({"locked_groups": ("tail",)}, "locked_groups[0]", "'tail' is not one"),
        ({"held_rad": {"HeadX": 0.1}}, "held_deg.HeadX", "not an axis of a locked group"),
        (
            {"locked_groups": ("head",), "held_rad": {"HeadX": -2.0}},
            "held_deg.HeadX",
            "cannot be held at -114.592 deg",
        ),
    ],
)
def test_an_invalid_value_is_reported_with_its_place(
    change: dict[str, object], path: str, expected_message: str
) -> None:
    """One invalid value gives one problem, which states its path and what is valid."""
    with pytest.raises(AvatarSettingsError) as caught:
        replace(BODY, **change)  # type: ignore[arg-type]  # the fact
    (problem,) = caught.value.problems
    assert problem.path == path
    assert expected_message in problem.message
    assert problem.valid is not None


def test_groups_are_those_of_the_thesis() -> None:
    """The groups are those of the thesis's figure 6.2, with the driven axes of section 3.2."""
    assert set(GROUPS) == {
        *("all", "trunk", "trunk_head", "head", "left_leg", "left_foot", "left_arm"),
        *("left_fingers", "right_leg", "right_foot", "right_arm", "right_fingers"),
    }
    assert parts_of("all") == PART_NAMES
    assert {group: len(axes_of(group)) for group in ("all", "trunk", "head")} == {
        "all": 91,
        "trunk": 9,
        "head": 6,
    }
    assert {
        group: len(axes_of(f"left_{group}")) for group in ("leg", "foot", "arm", "fingers")
    } == {
        "leg": 9,
        "foot": 4,
        "arm": 9,
        "fingers": 20,
    }
    assert axes_of("LeftToes") == ("LeftToesX",)
    assert axes_of("LeftShoulder") == ()
    with pytest.raises(AvatarSettingsError, match="no body group 'tail'"):
        parts_of("tail")


def test_trunk_head_and_limbs_are_the_whole_body() -> None:
    """Trunk with head, legs, arms and fingers contain every part exactly once."""
    limbs = [f"{side}_{limb}" for side in ("left", "right") for limb in ("leg", "arm", "fingers")]
    parts = [part for group in ("trunk_head", *limbs) for part in parts_of(group)]
    assert sorted(parts) == sorted(PART_NAMES)
    for group in GROUPS:
        if group.startswith("left_"):
            mirrored = tuple(mirrored_name(part) for part in parts_of(group))
            assert mirrored == parts_of(group.replace("left_", "right_"))


def test_a_lock_fixes_a_group_until_it_is_removed() -> None:
    """The axes of a locked group have equal limits; unlocking restores their own limits."""
    cast = lock(BODY, "left_fingers", {"LeftIndexProximalZ": math.radians(30.0)})
    assert cast.locked_groups == ("left_fingers",)
    assert cast.locked_axes == set(axes_of("left_fingers"))
    assert math.degrees(cast.in_force["LeftIndexProximalZ"].low_rad) == pytest.approx(30.0)
    assert cast.in_force["LeftIndexDistalZ"].high_rad == 0.0
    assert cast.in_force["LeftHandX"] == FINE_SPRING
    assert cast.axes == BODY.axes
    assert unlock(cast, "left_fingers") == BODY
    assert lock(cast, "left_fingers").held_rad == {}


def test_a_held_axis_stays_within_its_limits() -> None:
    """An axis whose limits exclude the T-pose is locked at the nearest allowed angle."""
    bent = replace(FINE_SPRING, low_rad=math.radians(20.0))
    knee = lock(with_axis(BODY, "LeftLowerLegX", bent), "left_leg")
    assert knee.in_force["LeftLowerLegX"].low_rad == bent.low_rad
    assert knee.in_force["LeftLowerLegX"].locked


def test_overlapping_locks_are_removed_one_by_one() -> None:
    """A locked foot stays locked when the lock of its leg is removed."""
    both = lock(lock(BODY, "left_foot", {"LeftFootX": 0.1}), "left_leg")
    assert both.locked_groups == ("left_leg", "left_foot")
    foot = unlock(both, "left_leg")
    assert foot.locked_axes == set(axes_of("left_foot"))
    unlocked = unlock(
        unlock(lock(both, "left_leg", {"LeftUpperLegX": 0.2}), "left_leg"), "left_foot"
    )
    assert unlocked == BODY


def test_an_axis_without_a_range_counts_as_locked() -> None:
    """An axis with equal limits counts as locked even if its group is not."""
    still = with_axis(BODY, "LeftLowerArmZ", FINE_SPRING.locked_at(0.0))
    assert still.locked_axes == {"LeftLowerArmZ"}


def test_mirroring_gives_the_right_side_what_the_left_has() -> None:
    """Mirroring copies the left side's settings to the right and is idempotent."""
    stiff = replace(FINE_SPRING, kp=999.0)
    odd = replace(FINE_SPRING, kp=1.0)
    body = with_axis(with_axis(BODY, "LeftUpperArmX", stiff), "RightFootZ", odd)
    mirrored = mirror_left_to_right(body)
    assert mirrored.axes["RightUpperArmX"] == stiff
    assert mirrored.axes["RightFootZ"] == FINE_SPRING
    assert all(mirrored.axes[name] == mirrored.axes[mirrored_name(name)] for name in AXIS_NAMES)
    assert mirror_left_to_right(mirrored) == mirrored


def test_a_hand_without_its_counterpart_keeps_its_settings() -> None:
    """A right finger keeps its settings when mirroring a model that lacks the left one."""
    body = without_parts(
        with_axis(BODY, "RightLittleDistalZ", replace(FINE_SPRING, kp=5.0)),
        frozenset({"LeftLittleDistal"}),
    )
    assert "LeftLittleDistalZ" not in body.axes
    assert mirror_left_to_right(body).axes["RightLittleDistalZ"].kp == 5.0


def test_settings_of_missing_parts_are_dropped() -> None:
    """Settings and held angles of missing parts are removed; all others are kept."""
    body = lock(BODY, "left_fingers", {"LeftLittleDistalZ": 0.3, "LeftIndexDistalZ": 0.2})
    four = without_parts(body, frozenset(part for part in PART_NAMES if "Little" in part))
    assert len(four.axes) == 91 - 8
    assert set(four.held_rad) == {"LeftIndexDistalZ"}
    assert "LeftLittleDistal" not in four.parts


def test_global_settings_reach_every_axis_of_a_group() -> None:
    """Global settings change every axis of a group, no other axis, and only the given values."""
    body = with_global(BODY, group="head", kp=50.0)
    assert {name for name, one in body.axes.items() if one.kp == 50.0} == set(axes_of("head"))
    assert body.axes["HeadX"].kd == FINE_SPRING.kd
    assert all(
        one.max_torque_nm == 9.0 for one in with_global(BODY, max_torque_nm=9.0).axes.values()
    )
    with pytest.raises(AvatarSettingsError, match="out of range"):
        with_global(BODY, kp=-1.0)


def test_colliders_are_switched_part_by_part() -> None:
    """A part without a collider kind of its own has that of the body."""
    body = replace(BODY, colliders="none", part_colliders={"LeftHand": "simple"})
    assert (body.collider_of("LeftHand"), body.collider_of("Head")) == ("simple", "none")


def test_every_name_of_a_group_can_be_locked() -> None:
    """Every group and every single part can be locked by its name."""
    assert lock(BODY, "all").locked_axes == set(AXIS_NAMES)
    for group in GROUP_NAMES:
        assert lock(BODY, group).locked_axes == set(axes_of(group))
