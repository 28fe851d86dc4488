"""How the headset knows the goals of the body now, and how far a calibration is."""

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.models import ClientReport
from app.platform.hub import Hub
from app.wire import CalibrationStepReport, Goal, GoalsReport, GoalState

_STEP = "calibration_step"
FEET: tuple[Goal, Goal] = ("LeftLowerLeg", "RightLowerLeg")
"""The goals on which contacts of the feet depend."""


def newest_goals(db: Session, session_id: str) -> GoalsReport | None:
    """Return the newest report of the session's newest run that sent one; None if none did."""
    payload = db.scalar(
        select(ClientReport.payload)
        .where(
            ClientReport.session_id == session_id,
            ClientReport.type == "goals",
            ClientReport.accepted,
        )
        .order_by(ClientReport.epoch.desc(), ClientReport.seq.desc())
        .limit(1)
    )
    return None if payload is None else GoalsReport.model_validate(payload)


def state_of_feet(goals: GoalsReport) -> GoalState:
    """Return the worse state of the two feet: lost, inferred or tracked."""
    states = {goals.states[goal] for goal in FEET}
    order: tuple[GoalState, ...] = ("lost", "inferred", "tracked")
    return next(state for state in order if state in states)


def feet_tracked(db: Session, hub: Hub, session_id: str) -> bool | None:
    """Return whether the connected headset measures both feet; None if it does not say."""
    if not hub.headset_can(session_id, "goals"):
        return None
    goals = newest_goals(db, session_id)
    return None if goals is None else state_of_feet(goals) == "tracked"


def calibration_underway(db: Session, hub: Hub, session_id: str) -> CalibrationStepReport | None:
    """Return the step of the calibration that a connected headset is making; None if it is not."""
    if not hub.headset_can(session_id, "calibrates"):
        return None
    newest = db.execute(
        select(ClientReport.type, ClientReport.payload)
        .where(
            ClientReport.session_id == session_id,
            ClientReport.type.in_(("calibration", _STEP)),
            ClientReport.accepted,
        )
        .order_by(ClientReport.epoch.desc(), ClientReport.seq.desc())
        .limit(1)
    ).first()
    if newest is None or newest.type != _STEP:
        return None
    return CalibrationStepReport.model_validate(newest.payload)
