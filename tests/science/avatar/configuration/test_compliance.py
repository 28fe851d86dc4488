"""Tests of compliant groups in a configuration: its file, its motors and its model."""

import math
from dataclasses import replace

import pytest

from app.protocol.avatar import content_of, load_avatar, loaded
from app.science.avatar.configuration import (
    Compliance,
    Configuration,
    as_configured,
    with_compliance,
    world_limbs,
)
from app.science.avatar.configuration.axis_settings import AvatarSettingsError
from app.science.avatar.configuration.compliance import COMPLIANT_GROUPS
from app.science.avatar.configuration.groups import parts_of
from app.science.avatar.mjcf import avatar_model, default_configuration

STANDARD = default_configuration()
SOFT = replace(STANDARD, compliance={"left_leg": Compliance(0.1, "world")})


def test_a_stiff_body_is_as_before() -> None:
    """A configuration without compliance has the same file, hash and model as before it existed."""
    assert "compliance" not in content_of(STANDARD)
    stiff = replace(STANDARD, compliance={"left_leg": Compliance(1.0, "joint")})
    assert loaded(stiff) == loaded(STANDARD)
    assert loaded(with_compliance(SOFT, ["left_leg"], Compliance())) == loaded(STANDARD)
    assert "gravcomp" not in avatar_model(STANDARD, 1.75).mjcf
    assert dict(STANDARD.motors) == dict(STANDARD.in_force)


def test_a_soft_group_keeps_its_damping_ratio_and_carries_its_weight() -> None:
    """kp has the group's share, kd its root; the file's gains, limits and torques stay."""
    own, motor = SOFT.axes["LeftLowerLegX"], SOFT.motors["LeftLowerLegX"]
    assert (motor.kp, motor.kd) == pytest.approx((0.1 * own.kp, math.sqrt(0.1) * own.kd))
    assert motor.kd**2 / motor.kp == pytest.approx(own.kd**2 / own.kp)
    assert (motor.max_torque_nm, motor.low_rad) == (own.max_torque_nm, own.low_rad)
    assert SOFT.motors["RightLowerLegX"] == STANDARD.motors["RightLowerLegX"]
    assert as_configured(SOFT).axes["LeftLowerLegX"] == motor
    assert SOFT.axes == STANDARD.axes
    mjcf = avatar_model(SOFT, 1.75).mjcf
    assert mjcf.count('gravcomp="1"') == len(parts_of("left_leg"))
    assert world_limbs(SOFT.compliance) == ("left_leg",)


def test_the_file_keeps_what_it_says() -> None:
    """Compliance survives the file to the bit, in percent, and changes the hash."""
    found = load_avatar(loaded(SOFT).canonical_json)
    assert found.configuration.compliance == SOFT.compliance
    assert found.content_hash == loaded(SOFT).content_hash != loaded(STANDARD).content_hash
    stored = content_of(SOFT)["compliance"]
    assert stored == {"left_leg": {"stiffness_percent": 10.0, "targets": "world"}}


def test_the_groups_are_the_whole_body_and_none_overlaps() -> None:
    """Every body part is in exactly one group that can be compliant."""
    parts = [part for group in COMPLIANT_GROUPS for part in parts_of(group)]
    assert sorted(parts) == sorted(parts_of("all"))


@pytest.mark.parametrize(
    ("compliance", "delays_s", "path"),
    [
        ({"left_foot": Compliance(0.5)}, {}, "compliance.left_foot"),
        ({"left_leg": Compliance(0.0)}, {}, "compliance.left_leg.stiffness_percent"),
        ({"left_leg": Compliance(math.nan)}, {}, "compliance.left_leg.stiffness_percent"),
        ({"trunk": Compliance(0.5, "world")}, {}, "compliance.trunk.targets"),
        (
            {"left_arm": Compliance(1.0, "world")},
            {"LeftHand": 0.1},
            "compliance.left_arm.targets",
        ),
    ],
)
def test_what_is_impossible_is_refused(
    compliance: dict[str, Compliance], delays_s: dict[str, float], path: str
) -> None:
    """Unknown groups, shares out of range, and world targets that would swing are refused."""
    with pytest.raises(AvatarSettingsError) as caught:
        Configuration(STANDARD.axes, compliance=compliance, delays_s=delays_s)
    (problem,) = caught.value.problems
    assert problem.path == path
    assert problem.valid
    assert problem.remedy
