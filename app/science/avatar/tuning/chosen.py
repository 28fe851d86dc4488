"""Say what a relay torque that the user chose makes of an axis, compared with the ramp's.

The torque decides how fast the relay oscillates, and so how stiff the axis becomes: kp grows with
the ultimate gain, and gravity deflects a soft axis by more. A torque far below the ramp's gives
gains that meet no objection of the step test but sag and lag, so they are compared.
"""

from dataclasses import dataclass, replace
from typing import Final

from app.science.avatar.tuning.results import AxisTuning
from app.science.avatar.tuning.step_response import StepFigures

FAR_WORSE: Final = 2.0
"""The ratio to the ramp's figure above which a steady error or a settling time is reported."""
LEAST_ERROR_DEG: Final = 0.5
"""Steady errors below this are never reported: twice very little is still little."""


@dataclass(frozen=True)
class ByRamp:
    """The stiffness of an axis, N m/rad, that the ramp's torque gives, and its step response."""

    kp: float
    step: StepFigures


def with_choice(found: AxisTuning, by_ramp: ByRamp | None) -> AxisTuning:
    """Return the result with a note on the chosen torque, and a warning if it is far worse.

    Args:
        found: the result of an axis; unchanged unless its torque was chosen.
        by_ramp: what the ramp gives for the axis; None if it did not oscillate.
    """
    if found.experiment is None or not found.experiment.push.chosen:
        return found
    torque_nm = found.experiment.relay.torque_nm
    note = (
        f"relay torque of {torque_nm:.4g} N m chosen by hand, which gives kp {_stiffness(found.kp)}"
    )
    if by_ramp is None:
        note += "; the ramp finds no torque for this axis"
    else:
        note += f"; the ramp gives kp {_stiffness(by_ramp.kp)}"
    warning = "" if by_ramp is None else _warning(found, by_ramp.step)
    return replace(found, note=f"{found.note}, {note}" if found.note else note, warning=warning)


def _stiffness(kp: float) -> str:
    return f"{kp:.0f} N m/rad" if kp >= 1000.0 else f"{kp:.4g} N m/rad"


def _warning(found: AxisTuning, ramp: StepFigures) -> str:
    step = found.step
    if step is None:
        return ""
    worse = []
    error_deg, ramp_deg = abs(step.steady_error_deg), abs(ramp.steady_error_deg)
    if error_deg > max(FAR_WORSE * ramp_deg, LEAST_ERROR_DEG):
        worse.append(f"comes to rest {error_deg:.2f} deg from its target ({ramp_deg:.2f} deg)")
    if ramp.settling_s is not None and step.settling_s is None:
        worse.append(f"does not settle ({ramp.settling_s:.3f} s)")
    elif ramp.settling_s and step.settling_s and step.settling_s > FAR_WORSE * ramp.settling_s:
        worse.append(f"settles in {step.settling_s:.3f} s ({ramp.settling_s:.3f} s)")
    if not worse:
        return ""
    return f"with the chosen torque it {' and '.join(worse)}; in brackets as the ramp tunes it"
