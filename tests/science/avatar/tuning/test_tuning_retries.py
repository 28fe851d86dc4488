"""Tests of retries of the tuning when the first gains of an axis are not accepted."""

import time
from dataclasses import replace

import pytest

from app.science.avatar.configuration.configuration import Configuration
from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.tuning import AxisTuning, TuningOptions, tune

_AXIS = "LeftUpperArmY"
_OTHERS = (
    "trunk_head", "left_leg", "right_leg", "right_arm", "left_fingers", "right_fingers",
    "LeftLowerArm", "LeftHand",
)  # fmt: skip


def _shoulder(max_torque_nm: float) -> Configuration:
    """Return a body of which only the left upper arm moves, with a motor of this torque."""
    locked = replace(default_configuration(), locked_groups=_OTHERS)
    axes = {**locked.axes, _AXIS: replace(locked.axes[_AXIS], max_torque_nm=max_torque_nm)}
    return replace(locked, axes=axes)


def _tuned(max_torque_nm: float, **options: object) -> AxisTuning:
    chosen = TuningOptions(**options)  # type: ignore[arg-type]  # names are checked by running
    report = tune(_shoulder(max_torque_nm), 1.75, chosen, wall_s=time.monotonic)
    return next(one for one in report.axes if one.name == _AXIS)


@pytest.mark.parametrize("max_torque_nm", [40.0, 20.0])
def test_a_motor_that_is_too_weak_to_brake_gets_lower_gains(max_torque_nm: float) -> None:
    """An axis that overshoots because its motor saturates is retried with lower gains."""
    once, more = _tuned(max_torque_nm, attempts=1), _tuned(max_torque_nm, attempts=4)
    assert once.flagged
    assert "overshoots" in once.status
    assert more.status == "retried"
    assert more.note == f"accepted at attempt {more.attempts}"
    assert more.step is not None
    assert more.step.overshoot_percent <= 5.0
    assert more.kp == pytest.approx(once.kp * 0.64 ** (more.attempts - 1), rel=0.05)


def test_an_axis_that_no_attempt_tunes_gets_the_best_gains() -> None:
    """An axis that no attempt tunes is flagged and gets the gains with the least overshoot."""
    once, more = _tuned(12.0, attempts=1), _tuned(12.0, attempts=3)
    assert more.flagged
    assert more.attempts == 3
    assert once.step is not None
    assert more.step is not None
    assert more.step.overshoot_percent < once.step.overshoot_percent


def test_a_rule_that_always_overshoots_is_tried_to_the_end() -> None:
    """Ziegler and Nichols's PD rule uses up all attempts, since it always overshoots."""
    one = _tuned(150.0, heuristic="ziegler-nichols-pd", attempts=2)
    assert one.flagged
    assert one.attempts == 2
