"""Tests of the tuning of a body: its results, the axes it skips, and how it ends."""

import time
from dataclasses import replace
from statistics import median

import pytest

from app.science.avatar.configuration.configuration import Configuration
from app.science.avatar.configuration.groups import axes_of
from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.tuning import (
    HEURISTICS,
    AxisTuning,
    TuningCancelled,
    TuningError,
    TuningOptions,
    TuningProgress,
    TuningReport,
    assess,
    tune,
)

_ALL_BUT_ARMS = ("trunk_head", "left_leg", "right_leg", "left_fingers", "right_fingers")
_ALL_BUT_LEFT_ARM = (*_ALL_BUT_ARMS, "right_arm")
_LEFT_ARM = [name for name in axes_of("left_arm") if name != "LeftLowerArmZ"]


def _with_locked_groups(groups: tuple[str, ...]) -> Configuration:
    return replace(default_configuration(), locked_groups=groups)


def _tuned(configuration: Configuration, **options: object) -> TuningReport:
    chosen = TuningOptions(**options)  # type: ignore[arg-type]  # names are checked by running
    return tune(configuration, 1.75, chosen, wall_s=time.monotonic)


def _by_name(report: TuningReport) -> dict[str, AxisTuning]:
    return {one.name: one for one in report.axes}


def _overshoots(report: TuningReport) -> list[float]:
    return [one.step.overshoot_percent for one in report.axes if one.step is not None]


@pytest.fixture(scope="module")
def left_arm() -> TuningReport:
    """Return the tuning of a body of which only the left arm is free."""
    return _tuned(_with_locked_groups(_ALL_BUT_LEFT_ARM))


def test_an_arm_is_tuned(left_arm: TuningReport) -> None:
    """Each free axis of a tuned arm settles within 0.2 s and overshoots by 3 % at most."""
    found = _by_name(left_arm)
    for name in _LEFT_ARM:
        one = found[name]
        assert one.status == "tuned"
        assert one.step is not None
        assert one.step.overshoot_percent <= 3.0
        assert one.step.settling_s is not None
        assert one.step.settling_s <= 0.2
        assert abs(one.step.steady_error_deg) <= 1.0


def test_existing_gains_are_assessed_with_the_steps_of_a_tuning(left_arm: TuningReport) -> None:
    """Assessing gains gives the tuning's own steps to the bit and changes nothing."""
    repeated = assess(left_arm.configuration, 1.75, wall_s=time.monotonic)
    assert repeated.configuration is left_arm.configuration
    assert [one.step for one in repeated.axes] == [one.step for one in left_arm.axes]
    assert {one.status for one in repeated.axes} == {"accepted", "locked"}
    axes = dict(left_arm.configuration.axes)
    axes["LeftLowerArmY"] = replace(axes["LeftLowerArmY"], kd=0.0)
    loose = assess(replace(left_arm.configuration, axes=axes), 1.75, wall_s=time.monotonic)
    found = {one.name: one for one in loose.axes}
    assert found["LeftLowerArmY"].flagged
    assert "overshoots" in found["LeftLowerArmY"].status


def test_each_result_records_its_experiment(left_arm: TuningReport) -> None:
    """Each result records torque, damping and cycles of its relay experiment, and the inertia."""
    one = _by_name(left_arm)["LeftLowerArmY"]
    assert one.experiment is not None
    assert one.experiment.relay.torque_nm > 0.0
    assert one.experiment.relay.damping_nm_s > 0.0
    assert one.experiment.relay.warm_up_cycles == 8
    # Forearm and hand of de Leva's average adult of 72 kg, plus the hinge's armature of 15 %.
    assert 0.05 <= one.experiment.found.inertia_kg_m2 <= 0.15


def test_an_upper_arm_is_tuned_with_what_a_bent_elbow_makes_it_carry(
    left_arm: TuningReport,
) -> None:
    """The twist axis of the upper arm is tuned with the inertia of a bent forearm."""
    one = _by_name(left_arm)["LeftUpperArmX"]
    assert one.experiment is not None
    assert one.experiment.pose == "bent"


def test_locked_axes_are_skipped_and_keep_their_gains(left_arm: TuningReport) -> None:
    """Axes of a locked group and axes without a range are skipped, each with its reason."""
    before, found = default_configuration().axes, _by_name(left_arm)
    assert found["SpineX"].status == found["LeftLowerArmZ"].status == "locked"
    assert "locked group" in found["SpineX"].note
    assert "no range" in found["LeftLowerArmZ"].note
    for name in set(found) - set(_LEFT_ARM):
        assert found[name].step is None
        assert left_arm.configuration.axes[name] == before[name]


def test_limits_torques_and_locks_stay_as_they_were(left_arm: TuningReport) -> None:
    """A tuning changes kp and kd of the free axes and nothing else."""
    before, after = _with_locked_groups(_ALL_BUT_LEFT_ARM), left_arm.configuration
    assert after.locked_groups == before.locked_groups
    for name, own in after.axes.items():
        was = before.axes[name]
        assert replace(own, kp=was.kp, kd=was.kd) == was
        assert (own == was) == (name not in _LEFT_ARM)


def test_the_same_input_gives_the_same_gains(left_arm: TuningReport) -> None:
    """The same input gives exactly the same gains, with one thread or two."""
    repeated = _tuned(_with_locked_groups(_ALL_BUT_LEFT_ARM), workers=1)
    assert repeated.axes == left_arm.axes
    assert repeated.configuration == left_arm.configuration


def test_ziegler_nichols_overshoots_and_is_flagged(left_arm: TuningReport) -> None:
    """Ziegler and Nichols's rule overshoots more than ours and is flagged after every attempt."""
    report = _tuned(
        _with_locked_groups(_ALL_BUT_LEFT_ARM), heuristic="ziegler-nichols-pd", attempts=2
    )
    assert median(_overshoots(report)) > 5.0 > max(_overshoots(left_arm))
    one = _by_name(report)["LeftLowerArmY"]
    assert one.flagged
    assert "overshoots" in one.status
    assert one.attempts == 2


def test_an_axis_that_does_not_oscillate_in_time_keeps_its_gains() -> None:
    """An axis whose experiment times out is flagged with the reason and keeps its gains."""
    report = _tuned(_with_locked_groups(_ALL_BUT_LEFT_ARM), longest_s=0.05, attempts=2)
    before = default_configuration().axes
    for name in _LEFT_ARM:
        one = _by_name(report)[name]
        assert one.status.startswith("flagged: no steady oscillation within 0.05 s of simulated")
        assert (one.kp, one.kd) == (before[name].kp, before[name].kd)
        assert one.step is not None


def test_a_motor_without_torque_is_flagged() -> None:
    """An axis whose motor has no torque is flagged although its relay experiment succeeds."""
    locked = _with_locked_groups((*_ALL_BUT_LEFT_ARM, "LeftLowerArm", "LeftHand"))
    axes = dict(locked.axes)
    axes["LeftUpperArmY"] = replace(axes["LeftUpperArmY"], max_torque_nm=0.0)
    report = _tuned(replace(locked, axes=axes, gravity=False), attempts=1)
    assert _by_name(report)["LeftUpperArmY"].flagged
    assert "torque" in _by_name(report)["LeftUpperArmY"].status


def test_mirror_copies_the_left_side_to_the_right(left_arm: TuningReport) -> None:
    """With mirroring the right arm gets the left one's gains, is marked as such and is assessed."""
    seen: list[TuningProgress] = []
    report = tune(
        _with_locked_groups(_ALL_BUT_ARMS),
        1.75,
        TuningOptions(mirror=True),
        wall_s=time.monotonic,
        progress=seen.append,
    )
    found = _by_name(report)
    for name in _LEFT_ARM:
        left, right = found[name], found[name.replace("Left", "Right")]
        assert (left.kp, left.kd) == (right.kp, right.kd)
        assert left.kp == _by_name(left_arm)[name].kp
        assert right.mirrored_from == name
        assert right.note == f"copied from {name}"
        assert left.mirrored_from is None
        assert left.step is not None
        assert right.step is not None
        assert right.step.overshoot_percent == pytest.approx(left.step.overshoot_percent, abs=0.01)
    relays = [at for at in seen if at.phase == "relay"]
    assert {at.axis for at in relays} == set(_LEFT_ARM)
    assert relays[-1].done == relays[-1].total == len(_LEFT_ARM)


def test_with_mirror_an_axis_without_a_left_counterpart_is_tuned_itself() -> None:
    """With mirroring the right arm is tuned itself if the left one is locked."""
    report = _tuned(
        _with_locked_groups((*_ALL_BUT_ARMS, "left_arm", "RightUpperArm", "RightHand")), mirror=True
    )
    one = _by_name(report)["RightLowerArmY"]
    assert one.status == "tuned"
    assert one.mirrored_from is None


def test_a_tuning_can_be_cancelled() -> None:
    """A cancelled tuning raises an error and gives no report."""
    seen: list[TuningProgress] = []
    with pytest.raises(TuningCancelled):
        tune(
            _with_locked_groups(_ALL_BUT_LEFT_ARM),
            1.75,
            wall_s=time.monotonic,
            progress=seen.append,
            cancelled=lambda: len(seen) >= 2,
        )
    assert len(seen) == 2


def test_a_fully_locked_body_has_nothing_to_tune() -> None:
    """In a fully locked body every axis is reported as locked."""
    report = _tuned(_with_locked_groups(("all",)))
    assert {one.status for one in report.axes} == {"locked"}
    assert report.configuration == _with_locked_groups(("all",))


@pytest.mark.parametrize(
    "options",
    [{"heuristic": "guess"}, {"attempts": 0}, {"workers": 0}, {"longest_s": float("nan")}],
)
def test_invalid_options_are_rejected(options: dict[str, object]) -> None:
    """Invalid tuning options raise an error that states what is valid."""
    with pytest.raises(TuningError, match="valid"):
        TuningOptions(**options)  # type: ignore[arg-type]  # that is the test


@pytest.mark.long
@pytest.mark.parametrize(("stature_m", "mass_kg"), [(1.5, 45.0), (1.75, 72.0), (2.0, 120.0)])
@pytest.mark.parametrize("heuristic", ["critical", "inertia"])
def test_all_axes_of_all_bodies(stature_m: float, mass_kg: float, heuristic: str) -> None:
    """Steps of 30 degrees overshoot by 3 % in the median, 10 % at most; no axis is flagged."""
    configuration = replace(default_configuration(limits="free"), total_mass_kg=mass_kg)
    report = tune(
        configuration, stature_m, TuningOptions(heuristic=heuristic), wall_s=time.monotonic
    )
    assert len(_overshoots(report)) == 91
    assert median(_overshoots(report)) <= 3.0
    assert max(_overshoots(report)) <= 10.0
    assert {one.status for one in report.axes} <= {"tuned", "retried"}


@pytest.mark.long
def test_classical_rules_overshoot_on_the_whole_body() -> None:
    """Every rule gives a result for every axis, and the classical ones overshoot more than ours."""
    medians = {
        key: median(_overshoots(_tuned(default_configuration(), heuristic=key, mirror=True)))
        for key in HEURISTICS
    }
    assert max(medians["critical"], medians["inertia"]) < 3.0
    assert min(medians["ziegler-nichols-pd"], medians["tyreus-luyben-pd"]) > 9.0
