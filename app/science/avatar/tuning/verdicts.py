"""When the gains of an axis are good enough, and what is said when they are not."""

from app.science.avatar.tuning.step_response import StepFigures

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
