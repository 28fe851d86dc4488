"""Remove a person's data from the tables.

What remains is the skeleton of the record: that there was a session, its slot of the ledger, and
the chain of its events. The chain refers to texts and answers by salted hashes. The salts are
removed along with the texts, so that the few answers a form allows cannot be tried against a hash.
"""

from collections.abc import Sequence
from typing import Any, cast

from sqlalchemy import CursorResult, Delete, Update, delete, func, select, update
from sqlalchemy.orm import Session

from app.models import (
    AlarmRow,
    Answer,
    AnswerCorrection,
    ClientReport,
    ClockProbe,
    Completion,
    Contact,
    Device,
    JointErrorCourseRow,
    JointErrorRow,
    PairingCode,
    PhaseLatency,
    PhaseQuality,
    RoadChunk,
    RoadCrossing,
    RoadRun,
    ScoreValue,
    SessionContent,
    Submission,
    Suggestion,
    TelemetryBatch,
    TelemetryChunk,
    TelemetryStream,
    TrackerAlignment,
    TrackerChunk,
)

OF_SESSIONS = (
    TelemetryBatch,
    TelemetryChunk,
    TelemetryStream,
    ClientReport,
    ClockProbe,
    TrackerAlignment,
    TrackerChunk,
    RoadCrossing,
    RoadChunk,
    RoadRun,
    Contact,
    Completion,
    JointErrorCourseRow,
    JointErrorRow,
    PhaseLatency,
    PhaseQuality,
    AlarmRow,
    PairingCode,
)
"""Tables whose rows of a session are deleted."""
OF_FORMS = (AnswerCorrection, Answer, ScoreValue)
"""Tables whose rows of a filled-in form are deleted, in an order that respects foreign keys."""
EMPTIED = (Submission, SessionContent, Suggestion, Device)
"""Tables whose rows remain, with their personal content blanked."""
TOUCHED = tuple(model.__tablename__ for model in (*OF_SESSIONS, *OF_FORMS, *EMPTIED))
"""Every table that an erasure changes, except for the participant's own row."""


def remove_traces(db: Session, session_ids: Sequence[str]) -> dict[str, int]:
    """Remove the data of these sessions about their participant; return row counts by table."""
    removed: dict[str, int] = {}
    forms = select(Submission.id).where(Submission.session_id.in_(session_ids))
    for model in OF_FORMS:
        rows = delete(model).where(model.submission_id.in_(forms))
        removed[model.__tablename__] = _count(db, rows)
    for own in OF_SESSIONS:
        removed[own.__tablename__] = _count(db, delete(own).where(own.session_id.in_(session_ids)))
    removed[Submission.__tablename__] = _empty_forms(db, session_ids)
    emptied = update(SessionContent).where(
        SessionContent.session_id.in_(session_ids), SessionContent.body.is_not(None)
    )
    removed[SessionContent.__tablename__] = _count(db, emptied.values(body=None, salt=None))
    advice = update(Suggestion).where(Suggestion.session_id.in_(session_ids))
    removed[Suggestion.__tablename__] = _count(db, advice.values(body=""))
    removed[Device.__tablename__] = _revoke_devices(db, session_ids)
    return {table: rows for table, rows in removed.items() if rows}


def _empty_forms(db: Session, session_ids: Sequence[str]) -> int:
    """Blank the filled-in forms, so that only which form was filled in when remains.

    The request's hash is removed too, because it is a hash of the unsalted answers.
    """
    rows = db.scalars(select(Submission).where(Submission.session_id.in_(session_ids))).all()
    for row in rows:
        row.idempotency_key = row.id
        row.request_hash = ""
        row.salt = None
        row.shown_order, row.timings, row.item_traces = [], {}, None
        row.started_at = None
        row.item_seed = 0
    db.flush()
    return len(rows)


def _revoke_devices(db: Session, session_ids: Sequence[str]) -> int:
    """Blank the devices; of each the hash of its token remains, which is that of a random number.

    By it a device that was away is told that its data were erased, and deletes what it still has.
    """
    devices = update(Device).where(Device.session_id.in_(session_ids))
    revoked = func.coalesce(Device.revoked_at, Device.paired_at)
    return _count(db, devices.values(name="", last_seen_at=None, revoked_at=revoked))


def _count(db: Session, statement: Delete | Update) -> int:
    statement = statement.execution_options(synchronize_session=False)
    return cast("CursorResult[Any]", db.execute(statement)).rowcount
