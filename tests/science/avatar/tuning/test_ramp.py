"""Tests of the ramp that finds the relay's torque, on wheels whose inertia it is not told."""

import time
from dataclasses import replace
from inspect import signature
from math import degrees, radians

import pytest

from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.tuning import AxisTuning, TuningError, TuningOptions, tune
from app.science.avatar.tuning.experiments import Laboratory
from app.science.avatar.tuning.heuristics import HEURISTICS
from app.science.avatar.tuning.ramp import MOTOR_SHARE, SWING_RAD, Push, chosen_push, ramp
from app.science.avatar.tuning.relay import NoOscillation, Oscillation, run_relay
from tests.science.avatar.tuning.known_wheel import wheel

_REACH_S = 0.025
_ALL_BUT_LEFT_ARM = (
    "trunk_head", "left_leg", "right_leg", "right_arm", "left_fingers", "right_fingers",
)  # fmt: skip


def _pushed(found: Push | NoOscillation) -> Push:
    assert isinstance(found, Push), found
    return found


def _oscillation(inertia_kg_m2: float, push: Push) -> Oscillation:
    relay = push.relay(longest_s=10.0, longest_wall_s=10.0)
    found = run_relay(wheel(inertia_kg_m2), relay, wall_s=lambda: 0.0)
    assert isinstance(found, Oscillation), found
    return found


@pytest.mark.parametrize("inertia_kg_m2", [2e-4, 0.05, 0.5, 8.0])
def test_the_ramp_finds_the_torque_of_a_wheel_it_knows_nothing_of(inertia_kg_m2: float) -> None:
    """The torque is 2 I s / T^2 within 2 %, and the relay with it swings by s at about 1 / 4 T."""
    push = _pushed(ramp(wheel(inertia_kg_m2), 1e4, _REACH_S))
    assert push.swing_rad == SWING_RAD
    law = 2.0 * inertia_kg_m2 * push.swing_rad / _REACH_S**2
    assert push.torque_nm == pytest.approx(law, rel=0.02)
    found = _oscillation(inertia_kg_m2, push)
    assert found.amplitude_rad == pytest.approx(SWING_RAD, rel=0.06)
    assert found.period_s == pytest.approx(4.0 * _REACH_S, rel=0.05)
    assert found.inertia_kg_m2 == pytest.approx(inertia_kg_m2, rel=0.06)


@pytest.mark.parametrize("limit_nm", [400.0, 50.0, 5.0])
def test_a_weak_motor_swings_less_and_gives_the_same_gains(limit_nm: float) -> None:
    """Within its limit a motor swings the axis by less; the gains differ by 2 % at most."""
    rule = HEURISTICS["critical"]
    strong = _pushed(ramp(wheel(0.5), 1e4, _REACH_S))
    weak = _pushed(ramp(wheel(0.5), limit_nm, _REACH_S))
    assert weak.torque_nm <= MOTOR_SHARE * limit_nm
    assert weak.swing_rad <= strong.swing_rad
    one, two = (rule.gains(_oscillation(0.5, push), 0.0) for push in (strong, weak))
    assert two.kp == pytest.approx(one.kp, rel=0.02)
    assert two.kd == pytest.approx(one.kd, rel=0.02)


@pytest.mark.parametrize("limit_nm", [1e4, 50.0, 5.0])
def test_relay_and_damping_stay_within_the_limit_of_the_motor(limit_nm: float) -> None:
    """The motor's greatest torque, relay and damping together, is within its limit."""
    push = _pushed(ramp(wheel(0.5), limit_nm, _REACH_S))
    found = _oscillation(0.5, push)
    assert push.torque_nm < found.peak_torque_nm <= limit_nm


def test_a_motor_that_cannot_move_its_axis_in_time_aims_lower_or_says_why() -> None:
    """Where a tenth of a degree takes longer than the reach time, the axis is tuned slower."""
    slow = _pushed(ramp(wheel(0.5), 0.1, _REACH_S))
    assert slow.reach_s > 2.0 * _REACH_S
    assert slow.torque_nm == pytest.approx(0.07)
    assert _oscillation(0.5, slow).inertia_kg_m2 == pytest.approx(0.5, rel=0.06)
    never = ramp(wheel(0.5), 1e-4, _REACH_S)
    assert isinstance(never, NoOscillation)
    assert "7e-05 N m turn it by" in never.reason
    assert "0.1 deg are needed" in never.reason
    none = ramp(wheel(0.5), 0.0, _REACH_S)
    assert none == NoOscillation("its motor has no torque: its limit is 0 N m")


def test_a_chosen_torque_is_kept_and_its_reach_time_measured() -> None:
    """A chosen torque turns a wheel by s in sqrt(2 I s / d); above the limit it is refused."""
    push = _pushed(chosen_push(wheel(0.5), 400.0, 100.0))
    assert push.chosen
    assert push.torque_nm == 100.0
    assert push.reach_s == pytest.approx((2.0 * 0.5 * SWING_RAD / 100.0) ** 0.5, rel=0.01)
    assert degrees(push.swing_rad) == pytest.approx(8.0)
    refused = chosen_push(wheel(0.5), 400.0, 300.0)
    assert isinstance(refused, NoOscillation)
    assert "300 N m is more than 280 N m" in refused.reason


def test_a_damped_hinge_is_measured_with_its_own_damping() -> None:
    """The hinge's own damping stays in the experiment: a braked wheel needs more torque."""
    free, braked = (_pushed(ramp(wheel(0.5, own), 1e4, _REACH_S)) for own in (0.0, 5.0))
    assert braked.torque_nm > 1.05 * free.torque_nm


def _tuned(options: TuningOptions, free: tuple[str, ...] = ()) -> dict[str, AxisTuning]:
    locked = tuple(group for group in _ALL_BUT_LEFT_ARM if group not in free)
    held = replace(default_configuration(), locked_groups=locked)
    report = tune(held, 1.75, options, wall_s=time.monotonic)
    return {one.name: one for one in report.axes if one.status != "locked"}


def test_the_laboratory_is_not_told_any_inertia() -> None:
    """What the laboratory is given has no inertias, and no torque passes the limit of an axis."""
    assert "hinges" not in signature(Laboratory).parameters
    limits = default_configuration().axes
    for name, one in _tuned(TuningOptions()).items():
        assert one.experiment is not None
        assert one.experiment.found.peak_torque_nm <= limits[name].max_torque_nm
        assert not one.experiment.push.chosen
        assert one.experiment.relay.hysteresis_rad <= radians(2.0)


def test_the_user_chooses_the_torque_for_all_axes_or_for_one() -> None:
    """Chosen torques are the relay's; one beyond an axis' limit flags the axis with both."""
    options = TuningOptions(
        relay_torque_nm=0.5, relay_torques_nm={"LeftUpperArmY": 100.0, "LeftHandX": 99.0}
    )
    found = _tuned(options)
    shoulder, elbow = found["LeftUpperArmY"].experiment, found["LeftLowerArmY"].experiment
    assert shoulder is not None
    assert elbow is not None
    assert (shoulder.relay.torque_nm, shoulder.push.chosen) == (100.0, True)
    assert elbow.relay.torque_nm == 0.5
    assert found["LeftHandX"].status.startswith(
        "flagged: the chosen relay torque of 99 N m is more than 17.5 N m"
    )


@pytest.mark.parametrize(("axis", "mirror"), [("SpineX", False), ("RightHandX", True)])
def test_a_torque_for_an_axis_that_is_not_measured_is_refused(axis: str, *, mirror: bool) -> None:
    """A torque for a locked axis, or for one that is copied, is refused instead of ignored."""
    options = TuningOptions(relay_torques_nm={axis: 1.0}, mirror=mirror)
    with pytest.raises(TuningError, match=f"{axis}, which is not measured"):
        _tuned(options, free=("right_arm",))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"relay_torque_nm": 0.0}, "0 N m: a number above 0"),
        ({"relay_torques_nm": {"LeftElbow": 1.0}}, "'LeftElbow', which is no axis"),
        ({"relay_torques_nm": {"SpineX": float("nan")}}, "a number above 0"),
    ],
)
def test_torques_that_cannot_be_are_refused(options: dict[str, object], words: str) -> None:
    """A torque of zero, one that is no number and one of no axis are refused with the value."""
    with pytest.raises(TuningError, match=words):
        TuningOptions(**options)  # type: ignore[arg-type]  # that is the test
