"""Choose the relay's torque by experiment: push the axis, harder and harder, until it moves enough.

Nothing about the body is given. The axis starts at rest and is pushed by a constant torque for a
stated time, the *reach time* T; the torque grows from push to push until the axis moves by a stated
angle, the *swing* s, in that time. A relay of this torque then makes the axis oscillate with about
this amplitude at a period of about 4 T: a body that turns by s in T under a torque d has the
inertia d T^2 / (2 s), and by the law of the relay, a = d Pu^2 / (32 I), the amplitude s belongs to
a period of 4 T. So the reach time says how fast the axis shall respond, and the push measures what
that takes.

The hysteresis is a quarter of the swing. The damping that the relay needs follows from the push as
well: at a lag asin(1/4), c = w I tan(lag) = pi / 4 tan(lag) d T / s.

No torque exceeds what the axis' motor has. The relay gets seven tenths of the limit at most, since
the motor also has to make the damping: together they come to 1.31 times the relay's torque where
the relay switches, and to 1.38 times before the oscillation is steady. If that moves the axis by
less than the swing, the swing becomes as narrow as what it does move, down to a tenth of a degree
(the simulated angle has no noise); if even that is too much, the push lasts longer, and the axis is
tuned for a slower response. A torque that the user chooses is kept instead, and the time in which
it moves the axis by the swing is measured.

Source: the relay force of Karas (2020, 5.2.2), which is the joint's own greatest force, set by
hand; the ramp is ours.
"""

from dataclasses import dataclass
from math import asin, degrees, pi, radians, tan
from typing import Final

from app.science.avatar.tuning.plant import AxisPlant
from app.science.avatar.tuning.relay import NoOscillation, RelaySettings

SWING_RAD: Final = radians(8.0)
LEAST_SWING_RAD: Final = radians(0.1)
SWING_HYSTERESES: Final = 4.0
"""The swing, in units of the hysteresis: 2 degrees of hysteresis for a swing of 8."""
MOTOR_SHARE: Final = 0.7
"""The relay's greatest torque, as a share of the torque limit of the axis."""
STEPS_PER_REACH: Final = 50
"""Time steps of the simulation in the reach time: 200 in each cycle of the relay."""
_FIRST_SHARE = 2.0**-10
_CLOSE_SHARE = 0.01
_CORRECTIONS = 4
_LONGEST_PUSH_S = 1.0


@dataclass(frozen=True)
class Push:
    """What a constant torque does to the axis, from rest.

    Attributes:
        torque_nm: the torque.
        reach_s: how long it was applied.
        swing_rad: the angle by which the axis turned in this time.
        chosen: whether the user chose the torque; else the ramp found it.
    """

    torque_nm: float
    reach_s: float
    swing_rad: float
    chosen: bool = False

    @property
    def relay_hz(self) -> float:
        """Return the frequency at which a relay of this torque makes the axis oscillate."""
        return 1.0 / (4.0 * self.reach_s)

    def relay(self, *, longest_s: float, longest_wall_s: float) -> RelaySettings:
        """Return the relay experiment that follows from the push; the times are its time-outs."""
        lag = asin(1.0 / SWING_HYSTERESES)
        return RelaySettings(
            torque_nm=self.torque_nm,
            damping_nm_s=pi / 4.0 * tan(lag) * self.torque_nm * self.reach_s / self.swing_rad,
            hysteresis_rad=self.swing_rad / SWING_HYSTERESES,
            step_s=self.reach_s / STEPS_PER_REACH,
            longest_s=longest_s,
            longest_wall_s=longest_wall_s,
        )


def ramp(plant: AxisPlant, limit_nm: float, reach_s: float) -> Push | NoOscillation:
    """Find the torque that turns an axis by the swing in the reach time.

    Args:
        plant: the axis alone.
        limit_nm: the torque limit of its motor.
        reach_s: how fast it shall respond; a quarter of the relay's period.
    """
    greatest = MOTOR_SHARE * limit_nm
    if greatest <= 0.0:
        return NoOscillation(f"its motor has no torque: its limit is {limit_nm:g} N m")
    torque = _FIRST_SHARE * greatest
    turned = _turned(plant, torque, reach_s)
    while turned < SWING_RAD and torque < greatest:
        torque = min(2.0 * torque, greatest)
        turned = _turned(plant, torque, reach_s)
    for _ in range(_CORRECTIONS):
        # The last doubling moved it too far; at the limit, too little is all there is.
        if turned <= SWING_RAD * (1.0 + _CLOSE_SHARE):
            break
        torque *= SWING_RAD / turned
        turned = _turned(plant, torque, reach_s)
    if abs(turned / SWING_RAD - 1.0) <= _CLOSE_SHARE:
        return Push(torque, reach_s, SWING_RAD)
    if turned >= LEAST_SWING_RAD:
        return Push(torque, reach_s, turned)
    return _held(plant, torque, LEAST_SWING_RAD, chosen=False)


def chosen_push(
    plant: AxisPlant, limit_nm: float, torque_nm: float, *, share: float = 1.0
) -> Push | NoOscillation:
    """Measure how long a torque that the user chose needs to turn the axis by the swing.

    A later attempt uses a `share` of it.
    """
    greatest = MOTOR_SHARE * limit_nm
    if torque_nm > greatest:
        return NoOscillation(
            f"the chosen relay torque of {torque_nm:g} N m is more than {greatest:g} N m, which is"
            f" {MOTOR_SHARE:.0%} of its torque limit of {limit_nm:g} N m (its damping needs the"
            " rest)"
        )
    return _held(plant, share * torque_nm, SWING_RAD, chosen=True)


def _turned(plant: AxisPlant, torque_nm: float, reach_s: float) -> float:
    """Return the angle by which a torque turns the axis from rest in this time."""
    plant.prepare(reach_s / STEPS_PER_REACH, 0.0)
    before = after = 0.0
    for _ in range(STEPS_PER_REACH):
        before, after = after, plant.step(torque_nm)
    # The integrator's angles are half a step ahead of their time.
    return (before + after) / 2.0


def _held(
    plant: AxisPlant, torque_nm: float, swing_rad: float, *, chosen: bool
) -> Push | NoOscillation:
    """Hold a torque until it has turned the axis by this angle.

    The first go, in steps of a millisecond, tells about how long it takes; the second measures it.
    """
    reach_s = _LONGEST_PUSH_S
    for steps in (round(_LONGEST_PUSH_S / 1e-3), 4 * STEPS_PER_REACH):
        step_s = reach_s / steps
        plant.prepare(step_s, 0.0)
        ahead = angle = 0.0
        for count in range(2 * steps):
            previous_ahead, previous = ahead, angle
            ahead = plant.step(torque_nm)
            angle = (previous_ahead + ahead) / 2.0
            if angle >= swing_rad:
                reach_s = (count + (swing_rad - previous) / (angle - previous)) * step_s
                break
            if (count + 1) * step_s >= _LONGEST_PUSH_S:
                return NoOscillation(
                    f"{torque_nm:g} N m turn it by {degrees(angle):.2g} deg within"
                    f" {_LONGEST_PUSH_S:g} s; {degrees(swing_rad):g} deg are needed"
                )
    return Push(torque_nm, reach_s, swing_rad, chosen)
