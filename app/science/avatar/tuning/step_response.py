"""Compute the figures of an axis' step response and decide whether its gains are good enough.

All shares are of the distance from the starting angle to the angle where the axis comes to rest. So
gravity, under which a spring must give way, counts as steady-state error and not as overshoot.
"""

from dataclasses import dataclass
from math import degrees

import numpy as np

from app.science.rotations import FloatArray

SETTLED_SHARE = 0.02
_REST_S = 0.05
"""The final angle is the mean over this time at the end of the record."""


@dataclass(frozen=True)
class StepFigures:
    """Figures of one step response.

    Attributes:
        step_deg: the angle by which the target jumped.
        overshoot_percent: the farthest excursion beyond the final angle, of the distance travelled.
        settling_s: time until the angle stays within 2 % of the distance; None if it does not.
        rise_s: time from 10 to 90 % of the distance; None if the axis does not get there.
        steady_error_deg: target minus final angle.
    """

    step_deg: float
    overshoot_percent: float
    settling_s: float | None
    rise_s: float | None
    steady_error_deg: float


def step_figures(
    angles_rad: FloatArray, start_rad: float, target_rad: float, step_s: float
) -> StepFigures:
    """Return the figures of a recorded step response.

    Args:
        angles_rad: (N,) angle after each step since the target jumped.
        start_rad: angle at the jump.
        target_rad: the new target.
        step_s: time between two angles.
    """
    tail = max(round(_REST_S / step_s), 1)
    rest = float(angles_rad[-tail:].mean())
    distance = rest - start_rad
    jump = degrees(target_rad - start_rad)
    if not np.isfinite(angles_rad).all() or distance == 0.0:
        return StepFigures(jump, 100.0, None, None, jump)
    shares = (angles_rad - start_rad) / distance
    outside = np.flatnonzero(np.abs(shares - 1.0) > SETTLED_SHARE)
    last = int(outside[-1]) + 1 if outside.size else 0
    # An axis still outside the tolerance in the window that defines its final angle has not
    # settled.
    settled = last < len(shares) - tail
    return StepFigures(
        step_deg=jump,
        overshoot_percent=max(float(shares.max() - 1.0), 0.0) * 100.0,
        settling_s=(last + 1) * step_s if settled else None,
        rise_s=_rise_s(shares, step_s),
        steady_error_deg=degrees(target_rad - rest),
    )


def _rise_s(shares: FloatArray, step_s: float) -> float | None:
    low, high = np.flatnonzero(shares >= 0.1), np.flatnonzero(shares >= 0.9)
    if not low.size or not high.size:
        return None
    return float(high[0] - low[0]) * step_s


CHATTER_CLEARANCE = 1.25
"""Least accepted clearance: damping kd chatters at the torque limit where kd h >= 2 J (see
`hinges`)."""
_STEADY_SHARE = 0.25


def objection(
    step: StepFigures, clearance: float, *, accepted_overshoot_percent: float
) -> str | None:
    """Return the objection to the gains of an axis; None if they are good enough.

    Args:
        step: the step response with these gains.
        clearance: 2 J / (kd h); see `Trial.clearance`.
        accepted_overshoot_percent: the accepted overshoot of the step.
    """
    if clearance < CHATTER_CLEARANCE:
        return (
            "its damping is too strong for the inertia that moves immediately (clearance"
            f" {clearance:.2f}, at least {CHATTER_CLEARANCE:g} is needed), so it would chatter"
        )
    if abs(step.steady_error_deg) > _STEADY_SHARE * abs(step.step_deg):
        return (
            f"it comes to rest {abs(step.steady_error_deg):.1f} deg from its target: its torque"
            " limit is too low, or it is obstructed"
        )
    if step.overshoot_percent > accepted_overshoot_percent:
        return (
            f"it overshoots a step of {abs(step.step_deg):.0f} deg by"
            f" {step.overshoot_percent:.1f} %, at most {accepted_overshoot_percent:g} % is accepted"
        )
    if step.settling_s is None:
        return f"a step of {abs(step.step_deg):.0f} deg does not settle to 2 %"
    return None
