"""Tests of step responses: their figures, the step of each axis, and reasons to reject gains."""

from math import degrees, exp, log, pi, radians, sqrt

import numpy as np
import pytest

from app.science.avatar.body.body import build_body
from app.science.avatar.body.masses import body_masses
from app.science.avatar.configuration.limits import ANATOMIC
from app.science.avatar.tuning.evaluation import Trial, jump_of
from app.science.avatar.tuning.plant import without_shapes
from app.science.avatar.tuning.step_response import StepFigures, objection, step_figures
from app.science.rotations import FloatArray
from tests.science.avatar.bodies import settings_of

_STEP_S = 0.001


def _second_order(damping: float, omega: float = 30.0) -> FloatArray:
    """Return the unit step response of an underdamped oscillator, in closed form."""
    t = (np.arange(2000) + 1) * _STEP_S
    root = sqrt(1.0 - damping**2)
    phase = omega * root * t
    envelope = np.exp(-damping * omega * t)
    response: FloatArray = 1.0 - envelope * (np.cos(phase) + damping / root * np.sin(phase))
    return response


@pytest.mark.parametrize("damping", [0.3, 0.5, 0.7])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_overshoot_of_an_oscillator(damping: float, sign: float) -> None:
    """An oscillator's overshoot is exp(-pi zeta / sqrt(1 - zeta^2)), for any step."""
    angles = 0.2 + sign * _second_order(damping)
    figures = step_figures(angles, 0.2, 0.2 + sign, _STEP_S)
    expected = 100.0 * exp(-pi * damping / sqrt(1.0 - damping**2))
    assert figures.overshoot_percent == pytest.approx(expected, abs=0.1)
    assert figures.steady_error_deg == pytest.approx(0.0, abs=1e-3)
    assert figures.step_deg == pytest.approx(sign * degrees(1.0))


def test_settling_and_rise_of_a_first_order_lag() -> None:
    """A first-order lag settles in ln 50 and rises in ln 9 time constants."""
    t = (np.arange(3000) + 1) * _STEP_S
    figures = step_figures(1.0 - np.exp(-t / 0.1), 0.0, 1.0, _STEP_S)
    assert figures.settling_s == pytest.approx(0.1 * log(50.0), abs=2 * _STEP_S)
    assert figures.rise_s == pytest.approx(0.1 * log(9.0), abs=2 * _STEP_S)
    assert figures.overshoot_percent == pytest.approx(0.0, abs=1e-9)


def test_a_steady_error_is_no_overshoot() -> None:
    """The overshoot of a limb that sags is measured from where it comes to rest."""
    figures = step_figures(0.9 * _second_order(0.5), 0.0, 1.0, _STEP_S)
    assert figures.overshoot_percent == pytest.approx(16.3, abs=0.1)
    assert figures.steady_error_deg == pytest.approx(degrees(0.1), abs=1e-3)


def test_a_response_that_keeps_swinging_does_not_settle() -> None:
    """A response that keeps swinging has no settling time, wherever its record ends."""
    t = np.arange(2000) * _STEP_S
    figures = step_figures(1.0 + 0.2 * np.sin(60.0 * t), 0.0, 1.0, _STEP_S)
    assert figures.settling_s is None


def test_a_response_that_is_not_finite_is_never_accepted() -> None:
    """A non-finite step response gets figures that are never accepted."""
    figures = step_figures(np.full(100, np.nan), 0.0, 1.0, _STEP_S)
    assert figures.settling_s is None
    assert objection(figures, 9.0, accepted_overshoot_percent=5.0) is not None


def test_every_axis_of_a_body_gets_a_step_that_its_limits_do_not_cut() -> None:
    """Each step is 30 degrees or eight tenths of a smaller range, and ends off the limit."""
    settings = settings_of(build_body(1.75))
    for name, own in settings.items():
        if own.locked:
            continue
        jump = jump_of(own)
        size = abs(jump.target_rad - jump.start_rad)
        span = ANATOMIC[name].high_rad - ANATOMIC[name].low_rad
        assert size == pytest.approx(min(radians(30.0), 0.8 * span))
        room = min(own.high_rad - jump.target_rad, jump.target_rad - own.low_rad)
        assert room >= 0.1 * size


def test_the_dampers_that_come_with_the_product_stay_clear_of_chatter() -> None:
    """2 J / (kd h) exceeds 1.25 for every axis; three times the damping would not."""
    body = build_body(1.75)
    settings = settings_of(body)
    trial = Trial(without_shapes(body), body_masses(body, 72.0), settings)
    clearances = {name: trial.clearance(name) for name in trial.names}
    assert min(clearances.values()) > 1.25
    strong = {name: own.with_values(kd=3.0 * own.kd) for name, own in settings.items()}
    tight = Trial(without_shapes(body), body_masses(body, 72.0), strong)
    assert tight.clearance("LeftUpperArmX") < 1.0


@pytest.mark.parametrize(
    ("figures", "clearance", "words"),
    [
        (StepFigures(30.0, 2.0, 0.1, 0.05, 0.5), 2.0, None),
        (StepFigures(30.0, 6.0, 0.1, 0.05, 0.5), 2.0, "overshoots"),
        (StepFigures(30.0, 2.0, None, 0.05, 0.5), 2.0, "does not settle"),
        (StepFigures(30.0, 2.0, 0.1, 0.05, 12.0), 2.0, "torque limit"),
        (StepFigures(30.0, 2.0, 0.1, 0.05, 0.5), 1.1, "chatter"),
    ],
)
def test_an_objection_names_its_reason(
    figures: StepFigures, clearance: float, words: str | None
) -> None:
    """Each of the four reasons to reject gains is named, and acceptable gains have none."""
    reason = objection(figures, clearance, accepted_overshoot_percent=5.0)
    assert reason is None if words is None else words in (reason or "")
