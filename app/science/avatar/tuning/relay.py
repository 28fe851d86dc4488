"""The relay experiment: let an axis oscillate under a torque that only knows two values.

A torque of +d or -d, switched against the angle with some hysteresis e, makes a hinge swing. With a
little damping c the swing becomes a limit cycle of amplitude a and period Pu; without any, each
swing of a body of inertia I would be larger than the last. By the describing function of the
relay, 4 d / (pi a) at a lag of asin(e / a), the cycle is at

    tan(phi) = c / (w I),    sin(phi) = e / a,    I w^2 / cos(phi) = 4 d / (pi a),    w = 2 pi / Pu.

What is measured is a and Pu; from them follow the ultimate gain with hysteresis taken into account,

    Ku = 4 d / (pi sqrt(a^2 - e^2)),

and the inertia. A body thrown to and fro by a constant torque flies along parabolas, on which
a = d Pu^2 / (32 I): that is the dependable result, within some per cent whatever d, c and e.
Ku and Pu depend on all three. So they are chosen by a rule, `relay_for`, and recorded.

Source: Astrom and Hagglund (1984), Automatic tuning of simple regulators with specifications on
phase and amplitude margins, Automatica 20(5), 645-651. The rule of choice is ours.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import asin, cos, pi, radians, sqrt, tan
from typing import Final

from app.science.avatar.tuning.plant import AxisPlant

HYSTERESIS_RAD: Final = radians(2.0)
AMPLITUDE_HYSTERESES: Final = 4.0
"""The amplitude that is aimed at, in units of the hysteresis: 8 degrees."""
STEPS_PER_CYCLE: Final = 200
"""Of the simulation."""
_STEADY: Final = 0.01
_LOOK_EVERY = 256


@dataclass(frozen=True)
class RelaySettings:
    """What one experiment is done with; it belongs to the result.

    Attributes:
        torque_nm: d, either way. It is the experiment's, not bounded by the axis' own motor.
        damping_nm_s: c, of the hinge, instead of the body's own.
        hysteresis_rad: e.
        warm_up_cycles: not measured.
        cycles: measured; they must agree within 1 %, or the measurement goes on.
        step_s: of the simulation, finer than the avatar's: a relay that notices a crossing late
            swings farther.
        longest_s: simulated time after which there is no oscillation.
        longest_wall_s: the same by the clock.
    """

    torque_nm: float
    damping_nm_s: float
    hysteresis_rad: float = HYSTERESIS_RAD
    warm_up_cycles: int = 8
    cycles: int = 4
    step_s: float = 0.00025
    longest_s: float = 10.0
    longest_wall_s: float = 10.0


@dataclass(frozen=True)
class Oscillation:
    """The limit cycle that was found.

    Attributes:
        amplitude_rad: a, half of the way from one extreme to the other.
        period_s: Pu.
        ultimate_gain_nm_rad: Ku.
        inertia_kg_m2: I.
        simulated_s: how long it took.
    """

    amplitude_rad: float
    period_s: float
    ultimate_gain_nm_rad: float
    inertia_kg_m2: float
    simulated_s: float


@dataclass(frozen=True)
class NoOscillation:
    """Why there is no limit cycle to measure."""

    reason: str


def relay_for(inertia_kg_m2: float, frequency_hz: float) -> RelaySettings:
    """Choose torque and damping so that a body of this inertia oscillates at this frequency.

    The describing function is solved for them at an amplitude of four hystereses.
    """
    omega = 2.0 * pi * frequency_hz
    lag = asin(1.0 / AMPLITUDE_HYSTERESES)
    amplitude = AMPLITUDE_HYSTERESES * HYSTERESIS_RAD
    return RelaySettings(
        torque_nm=pi * amplitude / 4.0 * inertia_kg_m2 * omega**2 / cos(lag),
        damping_nm_s=omega * inertia_kg_m2 * tan(lag),
        step_s=1.0 / (STEPS_PER_CYCLE * frequency_hz),
    )


def run_relay(
    plant: AxisPlant,
    settings: RelaySettings,
    *,
    wall_s: Callable[[], float],
    cancelled: Callable[[], bool] = lambda: False,
) -> Oscillation | NoOscillation:
    """Do the experiment.

    Args:
        plant: the axis alone; it begins at rest.
        settings: see there.
        wall_s: a clock that only goes forward, for the time-out.
        cancelled: asked now and then; the experiment then ends without a result.
    """
    started_s = wall_s()
    plant.prepare(settings.step_s, settings.damping_nm_s)
    cycles = _Cycles(settings)
    torque, edge = settings.torque_nm, settings.hysteresis_rad
    applied, ahead, angle = torque, 0.0, 0.0
    for step in range(round(settings.longest_s / settings.step_s)):
        before, last = angle, ahead
        ahead = plant.step(applied)
        # The simulation's angles are half a step ahead of their time.
        angle = (last + ahead) / 2.0
        applied = torque
        if (angle > edge) if torque > 0.0 else (angle < -edge):
            # The crossing lies between two steps: what the torque did since then is taken back.
            crossed = edge if torque > 0.0 else -edge
            share = (crossed - before) / (angle - before)
            torque = -torque
            applied = torque * (3.0 - 2.0 * share)
            if torque < 0.0 and cycles.ended((step + share) * settings.step_s):
                return cycles.oscillation((step + 1) * settings.step_s)
        cycles.see(angle)
        if step % _LOOK_EVERY == 0:
            if cancelled():
                return NoOscillation("the tuning was cancelled")
            if wall_s() - started_s > settings.longest_wall_s:
                return NoOscillation(
                    f"no steady oscillation within {settings.longest_wall_s:g} s by the clock"
                )
        if not abs(angle) < pi:
            return NoOscillation(
                f"it turned by half a circle after {(step + 1) * settings.step_s:.2f} s: the"
                " oscillation grows"
            )
    return NoOscillation(
        f"no steady oscillation within {settings.longest_s:g} s of simulated time; {cycles.told()}"
    )


class _Cycles:
    """Collects whole cycles, each from one switch at the upper edge to the next."""

    def __init__(self, settings: RelaySettings) -> None:
        self._settings = settings
        self._least = self._most = 0.0
        self._last_s: float | None = None
        self._amplitudes: list[float] = []
        self._periods: list[float] = []

    def see(self, angle: float) -> None:
        """Take part in the present cycle."""
        if angle > self._most:
            self._most = angle
        elif angle < self._least:
            self._least = angle

    def ended(self, at_s: float) -> bool:
        """A cycle ended: whether the last ones are steady."""
        if self._last_s is not None:
            self._periods.append(at_s - self._last_s)
            self._amplitudes.append((self._most - self._least) / 2.0)
        self._last_s, self._least, self._most = at_s, 0.0, 0.0
        wanted = self._settings.warm_up_cycles + self._settings.cycles
        return len(self._periods) >= wanted and all(
            max(values) - min(values) <= _STEADY * max(values) for values in self._latest()
        )

    def oscillation(self, simulated_s: float) -> Oscillation:
        """The mean of the last cycles."""
        amplitudes, periods = self._latest()
        amplitude, period = sum(amplitudes) / len(amplitudes), sum(periods) / len(periods)
        edge, torque = self._settings.hysteresis_rad, self._settings.torque_nm
        return Oscillation(
            amplitude_rad=amplitude,
            period_s=period,
            ultimate_gain_nm_rad=4.0 * torque / (pi * sqrt(amplitude**2 - edge**2)),
            inertia_kg_m2=torque * period**2 / (32.0 * amplitude),
            simulated_s=simulated_s,
        )

    def told(self) -> str:
        """How far it came."""
        if not self._periods:
            return "it did not swing to and fro once"
        return f"its {len(self._periods)} cycles did not become alike"

    def _latest(self) -> tuple[list[float], list[float]]:
        count = self._settings.cycles
        return self._amplitudes[-count:], self._periods[-count:]
