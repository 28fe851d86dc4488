"""Show an operator how the body is tracked and calibrated, in the units of the lab's page."""

from typing import Any

from sqlalchemy.orm import Session

from app.features.record.cockpit.schemas import (
    BodyCalibrationView,
    CalibrationStepView,
    GoalsView,
)
from app.features.record.headset import calibration_underway, newest_goals
from app.features.record.sessions import newest_calibration, state_of
from app.models import StudySession
from app.platform.hub import Hub

_CM_PER_M = 100.0
_DIGITS = 2


def goals_view(db: Session, session: StudySession) -> GoalsView | None:
    """Return how the goals are known; None if no run of the headset has said so."""
    goals = newest_goals(db, session.id)
    return None if goals is None else GoalsView(source=goals.source, states=dict(goals.states))


def calibration_view(db: Session, hub: Hub, session: StudySession) -> BodyCalibrationView | None:
    """Return the newest calibration, the one under way and the orders; None without any of them."""
    newest, ordered = newest_calibration(db, session), state_of(session).calibration
    step = calibration_underway(db, hub, session.id)
    if newest is None and ordered is None and step is None:
        return None
    underway = (
        None
        if step is None
        else CalibrationStepView(
            step=step.step, number=step.number, total=step.total, problem=step.problem
        )
    )
    report: dict[str, Any] = {} if newest is None else dict(newest.report)
    shifts_m = {} if ordered is None else ordered.shifts_m
    return BodyCalibrationView(
        at=None if newest is None else newest.at,
        cause=report.get("cause"),
        stature_m=report.get("stature_m"),
        span_m=report.get("span_m"),
        eye_height_m=report.get("eye_height_m"),
        residuals_cm={goal: _cm(one) for goal, one in report.get("residuals_m", {}).items()},
        sources=report.get("sources", {}),
        notices=list(report.get("notices", ())),
        wanted=ordered is not None and ordered.wanted,
        shifts_cm={goal: (_cm(x), _cm(y), _cm(z)) for goal, (x, y, z) in shifts_m.items()},
        underway=underway,
    )


def _cm(length_m: float) -> float:
    return round(_CM_PER_M * length_m, _DIGITS)
