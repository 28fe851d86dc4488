"""The relay experiment: make an axis oscillate under a torque that has only two values.

A torque of +d or -d, switched against the angle with a hysteresis e, makes a hinge swing. With a
small damping c the swing becomes a limit cycle of amplitude a and period Pu; without any, each
swing of a body of inertia I would be larger than the last. By the describing function of the relay,
4 d / (pi a) at a lag of asin(e / a), the limit cycle satisfies

    tan(phi) = c / (w I),    sin(phi) = e / a,    I w^2 / cos(phi) = 4 d / (pi a),    w = 2 pi / Pu.

a and Pu are measured; they give the ultimate gain, with hysteresis taken into account,

    Ku = 4 d / (pi sqrt(a^2 - e^2)),

and the inertia. The angle of a body that a constant torque drives back and forth follows parabolas,
on which a = d Pu^2 / (32 I): the inertia is the dependable result, accurate to a few per cent for
any d, c and e. Ku and Pu depend on all three. So d, c and e are chosen by an experiment of their
own (`ramp`), and recorded.

Source: Astrom and Hagglund (1984), Automatic tuning of simple regulators with specifications on
phase and amplitude margins, Automatica 20(5), 645-651.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, radians, sqrt
from typing import Final

from app.science.avatar.tuning.plant import AxisPlant

HYSTERESIS_RAD: Final = radians(2.0)
_STEADY: Final = 0.01
_CHECK_EVERY = 256


@dataclass(frozen=True)
class RelaySettings:
    """The settings of one experiment; they are recorded with its result.

    Attributes:
        torque_nm: the torque d, in either direction.
        damping_nm_s: the damping c that the motor adds to the hinge's own.
        hysteresis_rad: the hysteresis e of the relay.
        warm_up_cycles: number of first cycles that are not measured.
        cycles: number of cycles that are measured; they must agree within 1 %, or the measurement
            continues.
        step_s: time step of the simulation, shorter than the avatar's: a relay that detects a
            crossing late swings farther.
        longest_s: simulated time after which the axis counts as not oscillating.
        longest_wall_s: the same in wall-clock time.
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
    """The limit cycle that was measured.

    Attributes:
        amplitude_rad: the amplitude a, half of the peak-to-peak swing.
        period_s: the period Pu.
        ultimate_gain_nm_rad: the ultimate gain Ku.
        inertia_kg_m2: the moment of inertia I.
        peak_torque_nm: the greatest torque of the motor, relay and damping together.
        simulated_s: duration of the experiment in simulated time.
    """

    amplitude_rad: float
    period_s: float
    ultimate_gain_nm_rad: float
    inertia_kg_m2: float
    peak_torque_nm: float
    simulated_s: float


@dataclass(frozen=True)
class NoOscillation:
    """The reason why an experiment found no limit cycle."""

    reason: str


def run_relay(
    plant: AxisPlant,
    settings: RelaySettings,
    *,
    wall_s: Callable[[], float],
    cancelled: Callable[[], bool] = lambda: False,
) -> Oscillation | NoOscillation:
    """Run the experiment and return the limit cycle, or the reason why there is no limit cycle.

    Args:
        plant: the axis alone; it starts at rest.
        settings: torque, damping, hysteresis and durations, see `RelaySettings`.
        wall_s: a monotonic clock, for the time-out.
        cancelled: checked every few hundred steps; if it returns true, the experiment ends without
            a result.
    """
    started_s = wall_s()
    plant.prepare(settings.step_s, settings.damping_nm_s)
    cycles = _Cycles(settings)
    torque, edge = settings.torque_nm, settings.hysteresis_rad
    before_last = last = ahead = angle = 0.0
    for step in range(round(settings.longest_s / settings.step_s)):
        # Under a constant torque the angle's second difference is constant: so the next angle is
        # known, and a crossing within the step can be met by the mean torque of its two pieces.
        coming = (ahead + 3.0 * ahead - 3.0 * last + before_last) / 2.0
        crossed = edge if torque > 0.0 else -edge
        applied = torque
        crossing = coming > edge if torque > 0.0 else coming < -edge
        if crossing:
            fraction = min(max((crossed - angle) / (coming - angle), 0.0), 1.0)
            applied = torque * (2.0 * fraction - 1.0)
            torque = -torque
        before_last, last, ahead = last, ahead, plant.step(applied)
        # The integrator's angles are half a step ahead of their time.
        previous, angle = angle, (last + ahead) / 2.0
        if crossing:
            cycles.switched((angle - previous) / settings.step_s)
            if torque < 0.0 and cycles.ended((step + fraction) * settings.step_s):
                return cycles.oscillation((step + 1) * settings.step_s)
        cycles.add(angle)
        if step % _CHECK_EVERY == 0:
            if cancelled():
                return NoOscillation("the tuning was cancelled")
            if wall_s() - started_s > settings.longest_wall_s:
                return NoOscillation(
                    f"no steady oscillation within {settings.longest_wall_s:g} s by the clock"
                )
        if not abs(angle) < pi:
            return NoOscillation(
                f"it turned by half a revolution after {(step + 1) * settings.step_s:.2f} s: the"
                " oscillation grows"
            )
    return NoOscillation(
        f"no steady oscillation within {settings.longest_s:g} s of simulated time;"
        f" {cycles.progress()}"
    )


class _Cycles:
    """Amplitudes and periods of whole cycles, each between two switches at the upper edge."""

    def __init__(self, settings: RelaySettings) -> None:
        self._settings = settings
        self._lowest = self._highest = 0.0
        self._last_s: float | None = None
        self._amplitudes: list[float] = []
        self._periods: list[float] = []
        self._peak_nm = 0.0

    def switched(self, speed_rad_s: float) -> None:
        """Record the motor's torque just after a switch: relay and damping brake together."""
        braking = self._settings.torque_nm + self._settings.damping_nm_s * abs(speed_rad_s)
        self._peak_nm = max(self._peak_nm, braking)

    def add(self, angle: float) -> None:
        """Extend the extremes of the current cycle by this angle."""
        if angle > self._highest:
            self._highest = angle
        elif angle < self._lowest:
            self._lowest = angle

    def ended(self, at_s: float) -> bool:
        """Record the end of a cycle and return whether the latest cycles are steady."""
        if self._last_s is not None:
            self._periods.append(at_s - self._last_s)
            self._amplitudes.append((self._highest - self._lowest) / 2.0)
        self._last_s, self._lowest, self._highest = at_s, 0.0, 0.0
        needed = self._settings.warm_up_cycles + self._settings.cycles
        return len(self._periods) >= needed and all(
            max(values) - min(values) <= _STEADY * max(values) for values in self._latest()
        )

    def oscillation(self, simulated_s: float) -> Oscillation:
        """Return the mean of the latest cycles."""
        amplitudes, periods = self._latest()
        amplitude, period = sum(amplitudes) / len(amplitudes), sum(periods) / len(periods)
        edge, torque = self._settings.hysteresis_rad, self._settings.torque_nm
        return Oscillation(
            amplitude_rad=amplitude,
            period_s=period,
            ultimate_gain_nm_rad=4.0 * torque / (pi * sqrt(amplitude**2 - edge**2)),
            inertia_kg_m2=torque * period**2 / (32.0 * amplitude),
            peak_torque_nm=self._peak_nm,
            simulated_s=simulated_s,
        )

    def progress(self) -> str:
        """Describe the progress of an experiment that found no steady cycle."""
        if not self._periods:
            return "it did not complete a single cycle"
        return f"its {len(self._periods)} cycles did not become equal"

    def _latest(self) -> tuple[list[float], list[float]]:
        count = self._settings.cycles
        return self._amplitudes[-count:], self._periods[-count:]
