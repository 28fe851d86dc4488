"""What a step of the target tells about an axis, and whether its gains are good enough.

All shares are of the way from where the axis was to where it comes to rest, so gravity, against
which a spring must give way, counts as steady error and not as overshoot.
"""

from dataclasses import dataclass
from math import degrees

import numpy as np

from app.science.rotations import FloatArray

SETTLED_SHARE = 0.02
_REST_S = 0.05
"""Mean over the end of the record: where the axis came to rest."""


@dataclass(frozen=True)
class StepFigures:
    """Figures of one step.

    Attributes:
        step_deg: how far the target jumped.
        overshoot_percent: farthest beyond the place of rest.
        settling_s: until it stays within 2 % of the way; None where it does not.
        rise_s: from 10 to 90 % of the way; None where it does not get there.
        steady_error_deg: target less place of rest.
    """

    step_deg: float
    overshoot_percent: float
    settling_s: float | None
    rise_s: float | None
    steady_error_deg: float


def step_figures(
    angles_rad: FloatArray, start_rad: float, target_rad: float, step_s: float
) -> StepFigures:
    """Read a step response.

    Args:
        angles_rad: (N,) after each step since the target jumped.
        start_rad: angle at the jump.
        target_rad: the new target.
        step_s: between two angles.
    """
    tail = max(round(_REST_S / step_s), 1)
    rest = float(angles_rad[-tail:].mean())
    way = rest - start_rad
    jump = degrees(target_rad - start_rad)
    if not np.isfinite(angles_rad).all() or way == 0.0:
        return StepFigures(jump, 100.0, None, None, jump)
    shares = (angles_rad - start_rad) / way
    outside = np.flatnonzero(np.abs(shares - 1.0) > SETTLED_SHARE)
    last = int(outside[-1]) + 1 if outside.size else 0
    # An axis that is outside while its place of rest is taken has none.
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
"""A damper of kd chatters at its greatest torque from kd h = 2 J on (see `hinges`)."""
_STEADY_SHARE = 0.25


def objection(
    step: StepFigures, clearance: float, *, accepted_overshoot_percent: float
) -> str | None:
    """Say what is wrong with the gains of an axis; None if nothing.

    Args:
        step: their trial.
        clearance: 2 J / (kd h); see `Trial.clearance`.
        accepted_overshoot_percent: of the step.
    """
    if clearance < CHATTER_CLEARANCE:
        return (
            f"its damper is too strong for what moves at once (clearance {clearance:.2f},"
            f" at least {CHATTER_CLEARANCE:g}), so it would chatter"
        )
    if abs(step.steady_error_deg) > _STEADY_SHARE * abs(step.step_deg):
        return (
            f"it comes to rest {abs(step.steady_error_deg):.1f} deg from its target: its greatest"
            " torque is too small, or something holds it"
        )
    if step.overshoot_percent > accepted_overshoot_percent:
        return (
            f"it overshoots a step of {abs(step.step_deg):.0f} deg by"
            f" {step.overshoot_percent:.1f} %, accepted are {accepted_overshoot_percent:g} %"
        )
    if step.settling_s is None:
        return f"a step of {abs(step.step_deg):.0f} deg does not settle to 2 %"
    return None
