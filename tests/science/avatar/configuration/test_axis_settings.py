"""Tests of one axis's settings: validation, locking, and angles stored without loss."""

import math
from dataclasses import replace

import pytest
from hypothesis import given

from app.science.avatar.configuration.axis_settings import (
    AvatarSettingsError,
    AxisSettings,
    degrees_of,
    rounded_angle,
)
from tests.science.avatar.configurations import FINE_SPRING, angles_rad, axis_settings


@pytest.mark.parametrize(
    ("change", "path", "expected_message"),
    [
        ({"kp": math.nan}, "kp_nm_per_rad", "not finite"),
        ({"kp": -1.0}, "kp_nm_per_rad", "-1 is out of range"),
        ({"kd": math.inf}, "kd_nm_s_per_rad", "not finite"),
        ({"kd": -0.5}, "kd_nm_s_per_rad", "-0.5 is out of range"),
        ({"max_torque_nm": -2.0}, "max_torque_nm", "-2 is out of range"),
        ({"low_rad": -4.0}, "low_deg", "-229.183 deg is out of range"),
        ({"high_rad": math.nan}, "high_deg", "not finite"),
        ({"low_rad": 3.0}, "low_deg", "171.887 deg, lies above the upper one, 125 deg"),
    ],
)
def test_an_invalid_value_is_reported_with_its_key(
    change: dict[str, float], path: str, expected_message: str
) -> None:
    """An invalid value is reported with its key and unit as in a file, and with the valid range."""
    with pytest.raises(AvatarSettingsError) as caught:
        replace(FINE_SPRING, **change)
    (problem,) = caught.value.problems
    assert problem.path == path
    assert expected_message in problem.message
    assert problem.valid
    assert problem.remedy


def test_all_problems_of_an_axis_are_reported_together() -> None:
    """Five invalid values of an axis give five problems."""
    with pytest.raises(AvatarSettingsError) as caught:
        AxisSettings(-1.0, -1.0, -1.0, -9.0, 9.0)
    assert len(caught.value.problems) == 5


def test_limits_that_are_one_angle_lock_the_axis() -> None:
    """Equal limits lock the axis at their angle, which is then its rest angle."""
    locked = FINE_SPRING.locked_at(math.radians(30.0))
    assert locked.locked
    assert not FINE_SPRING.locked
    assert locked.range_rad == 0.0
    assert degrees_of(locked.rest_rad) == 30.0
    assert FINE_SPRING.rest_rad == 0.0
    assert FINE_SPRING.locked_at(9.0).low_rad == FINE_SPRING.high_rad


@given(angles_rad)
def test_degrees_give_the_angle_back_to_the_bit(angle_rad: float) -> None:
    """A rounded angle is within 1e-11 rad of the original and survives conversion to degrees."""
    settled = rounded_angle(angle_rad)
    assert math.radians(degrees_of(settled)) == settled
    assert rounded_angle(settled) == settled
    assert abs(settled - angle_rad) < 1e-11


@given(axis_settings(), angles_rad)
def test_clamping_keeps_what_is_allowed(settings: AxisSettings, angle_rad: float) -> None:
    """Clamping keeps an angle within the limits and moves any other to the nearer limit."""
    clamped = settings.clamped(angle_rad)
    assert settings.low_rad <= clamped <= settings.high_rad
    allowed = settings.low_rad <= angle_rad <= settings.high_rad
    assert (clamped == angle_rad) if allowed else (clamped in (settings.low_rad, settings.high_rad))


def test_zero_has_no_sign() -> None:
    """Negative zeros are stored as zero, so equal settings are written identically."""
    settings = AxisSettings(-0.0, 0.0, 0.0, -0.0, 0.0)
    assert math.copysign(1.0, settings.kp) == 1.0
    assert math.copysign(1.0, settings.low_rad) == 1.0
