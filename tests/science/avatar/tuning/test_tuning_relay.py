"""Tests of the relay experiment, on single hinges of known inertia and damping."""

from dataclasses import replace
from itertools import count
from math import asin, degrees, inf, pi, radians, sqrt, tan

import pytest

from app.science.avatar.tuning.heuristics import HEURISTICS
from app.science.avatar.tuning.relay import (
    HYSTERESIS_RAD,
    NoOscillation,
    Oscillation,
    RelaySettings,
    run_relay,
)
from tests.science.avatar.tuning.known_wheel import relay_for, wheel


def _stopped() -> float:
    """Return a clock that always shows the same time."""
    return 0.0


def _found(inertia_kg_m2: float, settings: RelaySettings) -> Oscillation:
    found = run_relay(wheel(inertia_kg_m2), settings, wall_s=_stopped)
    assert isinstance(found, Oscillation), found
    return found


@pytest.mark.parametrize("inertia_kg_m2", [2e-4, 0.5, 20.0])
@pytest.mark.parametrize("frequency_hz", [3.0, 10.0, 16.0])
def test_the_limit_cycle_is_the_one_of_the_describing_function(
    inertia_kg_m2: float, frequency_hz: float
) -> None:
    """The limit cycle matches the describing function within 5 %, and the inertia within 6 %."""
    settings = relay_for(inertia_kg_m2, frequency_hz)
    found = _found(inertia_kg_m2, settings)
    amplitude = radians(8.0)
    assert found.amplitude_rad == pytest.approx(amplitude, rel=0.05)
    assert found.period_s == pytest.approx(1.0 / frequency_hz, rel=0.05)
    gain = 4.0 * settings.torque_nm / (pi * sqrt(amplitude**2 - HYSTERESIS_RAD**2))
    assert found.ultimate_gain_nm_rad == pytest.approx(gain, rel=0.05)
    assert found.inertia_kg_m2 == pytest.approx(inertia_kg_m2, rel=0.06)


@pytest.mark.parametrize("amplitude_hystereses", [3.0, 8.0])
def test_inertia_does_not_depend_on_how_it_is_measured(amplitude_hystereses: float) -> None:
    """Other damping and four times the torque change Ku and Pu, but not the measured inertia."""
    usual = relay_for(1.0, 5.0)
    omega = 10.0 * pi
    damping = omega * tan(asin(1.0 / amplitude_hystereses))
    found = _found(1.0, replace(usual, torque_nm=4.0 * usual.torque_nm, damping_nm_s=damping))
    assert found.period_s != pytest.approx(0.2, rel=0.1)
    assert found.inertia_kg_m2 == pytest.approx(1.0, rel=0.06)


def test_a_relay_of_twice_the_torque_is_faster_by_the_cube_root() -> None:
    """At the same damping, the cube of the limit cycle's rate is proportional to the torque."""
    one = relay_for(1.0, 5.0)
    two = replace(one, torque_nm=2.0 * one.torque_nm)
    ratio = _found(1.0, one).period_s / _found(1.0, two).period_s
    assert ratio == pytest.approx(2.0 ** (1.0 / 3.0), rel=0.05)


def test_an_undamped_hinge_has_no_limit_cycle() -> None:
    """The experiment on an undamped hinge, whose swings keep growing, ends with that reason."""
    settings = replace(relay_for(1.0, 5.0), damping_nm_s=0.0, longest_s=30.0)
    found = run_relay(wheel(1.0), settings, wall_s=_stopped)
    assert isinstance(found, NoOscillation)
    assert "grows" in found.reason


def test_a_relay_that_is_too_weak_is_given_up_after_the_simulated_time() -> None:
    """An experiment whose relay never reaches the switching angle ends after the simulated time."""
    settings = replace(relay_for(1.0, 5.0), torque_nm=1e-4, longest_s=2.0)
    found = run_relay(wheel(1.0), settings, wall_s=_stopped)
    assert isinstance(found, NoOscillation)
    assert "within 2 s of simulated time" in found.reason
    assert "did not complete a single cycle" in found.reason


def test_an_experiment_ends_after_its_time_on_the_wall_clock() -> None:
    """An experiment ends when its wall-clock time is over, by the clock that is passed in."""
    clock = count()
    settings = replace(relay_for(1.0, 5.0), longest_wall_s=2.0)
    found = run_relay(wheel(1.0), settings, wall_s=lambda: float(next(clock)))
    assert isinstance(found, NoOscillation)
    assert "within 2 s by the clock" in found.reason


def test_a_relay_experiment_can_be_cancelled() -> None:
    """A cancelled relay experiment has no result."""
    found = run_relay(wheel(1.0), relay_for(1.0, 5.0), wall_s=_stopped, cancelled=lambda: True)
    assert found == NoOscillation("the tuning was cancelled")


def test_the_usual_rule_damps_a_double_integrator_critically() -> None:
    """The usual rule gives a double integrator a damping ratio from .95 to 1.1.

    Its gains are kp = .8 Ku with Td = .356 Pu; the response is nearly as fast as the relay's.
    """
    inertia, relay_hz = 0.3, 8.0
    gains = HEURISTICS["critical"].gains(_found(inertia, relay_for(inertia, relay_hz)), inf)
    omega = sqrt(gains.kp / inertia)
    assert 0.95 <= gains.kd / (2.0 * inertia * omega) <= 1.1
    assert omega / (2.0 * pi) == pytest.approx(relay_hz / 1.083, rel=0.05)


def test_the_rule_by_inertia_has_the_frequency_it_is_given() -> None:
    """The rule by inertia sets kp = I w^2 and kd = 2 I w, with the measured inertia."""
    found = _found(0.3, relay_for(0.3, 8.0))
    gains = HEURISTICS["inertia"].gains(found, 6.0)
    assert sqrt(gains.kp / found.inertia_kg_m2) / (2.0 * pi) == pytest.approx(6.0, rel=1e-4)
    assert gains.kd**2 == pytest.approx(4.0 * found.inertia_kg_m2 * gains.kp, rel=1e-4)


def test_the_hysteresis_is_two_degrees() -> None:
    """The record of every relay experiment states its hysteresis of two degrees."""
    assert degrees(relay_for(1.0, 1.0).hysteresis_rad) == pytest.approx(2.0)
