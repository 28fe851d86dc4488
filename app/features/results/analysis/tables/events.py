"""The table of events: the audit trail as it stands in the log."""

import json

import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.studies.service import study_by_key
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import finished, of_kind, read, sessions_context
from app.models import SessionEvent, StudySession


def events_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """One row per event, by session and seq."""
    query = (
        select(
            SessionEvent.session_id,
            SessionEvent.seq,
            SessionEvent.type,
            SessionEvent.actor,
            SessionEvent.recorded_at,
            SessionEvent.monotonic_ns,
            SessionEvent.payload,
            SessionEvent.previous_hash,
            SessionEvent.hash,
        )
        .join(StudySession, StudySession.id == SessionEvent.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(SessionEvent.session_id, SessionEvent.seq)
    )
    names = ("session_id", "seq", "type", "actor", "recorded_at_utc", "monotonic_ns", "payload")
    events = read(db, query, (*names, "previous_hash", "hash"))
    payloads = [json.loads(payload) for payload in events["payload"]]
    events["phase_id"] = [payload.get("phase_id") for payload in payloads]
    events["step_index"] = [payload.get("step") for payload in payloads]
    events["monotonic_s"] = events["monotonic_ns"] / 1e9
    return finished(sessions_context(db, study_key, kind).merge(events, on="session_id"), "events")
