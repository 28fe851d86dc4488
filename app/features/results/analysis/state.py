"""The state of a study's data, which decides whether cached figures are still up to date."""

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.features.design.studies import newest_version, study_by_key
from app.models import (
    AlarmRow,
    JointErrorCourseRow,
    Phase,
    PhaseLatency,
    PhaseQuality,
    RoadCrossing,
    StudySession,
)

State = tuple[object, ...]


def state_of_data(db: Session, study_key: str, kind: str) -> State:
    """Return a value that changes whenever a figure might.

    It covers the study's version, sessions, events and computed summaries. Corrections and erasures
    are events, too.
    """
    study = study_by_key(db, study_key)
    sessions = (StudySession.study_id == study.id, StudySession.kind == kind)
    counted = select(func.count(), func.coalesce(func.sum(StudySession.version), 0)).where(
        *sessions
    )
    of_sessions = [
        db.scalar(
            select(func.count())
            .select_from(table)
            .join(StudySession, StudySession.id == table.session_id)
            .where(*sessions)
        )
        for table in (
            PhaseQuality,
            Phase,
            PhaseLatency,
            JointErrorCourseRow,
            AlarmRow,
            RoadCrossing,
        )
    ]
    version = newest_version(db, study).number
    return (version, *db.execute(counted).one(), *of_sessions)
