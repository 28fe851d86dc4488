"""The tables of data quality: each phase's streams, and the alarms of each session."""

import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.studies.service import study_by_key
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import (
    finished,
    of_kind,
    phases_context,
    read,
    sessions_context,
)
from app.models import AlarmRow, PhaseQuality, StudySession

_KEYS = ("session_id", "phase_id")
_COUNTS = ("gaps", "gap_s", "longest_gap_s", "jumps", "frozen_s", "frozen_joints")
_BROKEN = ("non_unit", "non_finite", "backwards")
_FIGURES = ("stream", "frames", "span_s", "frame_rate_hz", *_COUNTS, *_BROKEN)
_ALARM = ("code", "severity", "state", "stream", "message", "value", "unit", "client_t_s", "at")
_STREAMS = {"target": 0, "actual": 1}


def quality_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """One row per phase that was finished and stream, target first."""
    query = (
        select(*(getattr(PhaseQuality, name) for name in (*_KEYS, *_FIGURES)))
        .join(StudySession, StudySession.id == PhaseQuality.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
    )
    rows = read(db, query, (*_KEYS, *_FIGURES))
    rows["frozen_joints"] = [" ".join(joints) or None for joints in rows["frozen_joints"]]
    rows["place"] = rows["stream"].map(_STREAMS)
    frame = phases_context(db, study_key, kind).merge(rows.sort_values("place"), on=list(_KEYS))
    return finished(frame, "quality")


def alarms_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """One row per alarm raised and one per alarm cleared, by session and time."""
    query = (
        select(AlarmRow.session_id, *(getattr(AlarmRow, name) for name in _ALARM))
        .join(StudySession, StudySession.id == AlarmRow.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(AlarmRow.at, AlarmRow.id)
    )
    names = {"unit": "value_unit", "at": "at_utc"}
    rows = read(db, query, ("session_id", *(names.get(name, name) for name in _ALARM)))
    return finished(sessions_context(db, study_key, kind).merge(rows, on="session_id"), "alarms")
