"""The table of corrected answers."""

import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.studies.service import study_by_key
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import finished, of_kind, read, sessions_context
from app.models import AnswerCorrection, StudySession, Submission


def corrections_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """One row per correction, by session and in the order in which they were made."""
    query = (
        select(
            Submission.session_id,
            Submission.id,
            Submission.administration,
            Submission.instrument,
            AnswerCorrection.item,
            AnswerCorrection.previous_number,
            AnswerCorrection.previous_text,
            AnswerCorrection.value_number,
            AnswerCorrection.value_text,
            AnswerCorrection.reason,
        )
        .add_columns(AnswerCorrection.by, AnswerCorrection.at)
        .join(Submission, Submission.id == AnswerCorrection.submission_id)
        .join(StudySession, StudySession.id == Submission.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(AnswerCorrection.at, AnswerCorrection.id)
    )
    names = ("session_id", "submission_id", "administration", "instrument", "item")
    values = ("previous_number", "previous_text", "value_number", "value_text")
    rows = read(db, query, (*names, *values, "reason", "by", "at_utc"))
    sessions = sessions_context(db, study_key, kind)
    return finished(sessions.merge(rows, on="session_id"), "corrections")
