"""Collect the content of a participant's page from the record."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.database import referenced_row
from app.features.care.rights.access.words import in_language
from app.features.design.instruments import instrument_of
from app.features.record.questionnaires import StoredAnswers, stored_answers
from app.features.record.sessions import (
    content_body,
    contents_of,
    events_of,
    plan_of,
    protocol_of_session,
)
from app.models import (
    Completion,
    Contact,
    InstrumentVersion,
    Participant,
    StudySession,
    Submission,
    TelemetryStream,
)
from app.science.instruments import Instrument

WORDS_KEPT = ("note", "reason", "refused_form")


@dataclass(frozen=True)
class Consent:
    """A text that the participant consented to, and when; `at` is None if it was not recorded."""

    text: str
    at: datetime | None


@dataclass(frozen=True)
class Written:
    """A text of the lab, or a form that arrived too late; `kind`: note, reason, refused_form."""

    kind: str
    text: str
    at: datetime


@dataclass(frozen=True)
class Visit:
    """One session as shown to its participant; `heights` in m: stated and matched."""

    session: StudySession
    study_title: str
    forms: Sequence[tuple[Instrument, StoredAnswers]]
    consents: Sequence[Consent]
    heights: Sequence[dict[str, Any]]
    written: Sequence[Written]
    frames: int
    contacts: int
    completions: int


def visits_of(db: Session, participant: Participant) -> list[Visit]:
    """Return every visit of a participant, oldest first."""
    sessions = db.scalars(
        select(StudySession)
        .where(StudySession.participant_id == participant.id)
        .order_by(StudySession.created_at, StudySession.id)
    )
    return [_visit(db, session) for session in sessions]


def _visit(db: Session, session: StudySession) -> Visit:
    protocol = protocol_of_session(db, session)
    bodies = [content_body(row) for row in contents_of(db, session.id, "height")]
    return Visit(
        session=session,
        study_title=in_language(protocol.title, session.language),
        forms=[(_instrument(db, form), form) for form in stored_answers(db, session)],
        consents=_consents(db, session),
        heights=[body for body in bodies if isinstance(body, dict)],
        written=_written(db, session),
        frames=_sum_of_frames(db, session),
        contacts=_count(db, Contact, session),
        completions=_count(db, Completion, session),
    )


def _instrument(db: Session, form: StoredAnswers) -> Instrument:
    submission = db.get_one(Submission, form.submission_id)
    return instrument_of(referenced_row(db, InstrumentVersion, submission.instrument_version_id))


def _consents(db: Session, session: StudySession) -> list[Consent]:
    """Return the text of each consent step, with the time when it was completed."""
    texts = protocol_of_session(db, session).texts
    done = {
        json.loads(event.payload)["step"]: event.recorded_at
        for event in events_of(db, session.id)
        if event.type == "step_completed"
    }
    return [
        Consent(in_language(texts[step.text], session.language), done.get(step.index))
        for step in plan_of(db, session)
        if step.kind == "consent" and step.text is not None
    ]


def _written(db: Session, session: StudySession) -> list[Written]:
    written = []
    for row in contents_of(db, session.id):
        body = content_body(row)
        if row.kind in WORDS_KEPT and body is not None:
            text = (
                json.dumps(body["answers"], ensure_ascii=False) if isinstance(body, dict) else body
            )
            written.append(Written(row.kind, str(text), row.created_at))
    return written


def _sum_of_frames(db: Session, session: StudySession) -> int:
    total = select(func.sum(TelemetryStream.frames_stored)).where(
        TelemetryStream.session_id == session.id, TelemetryStream.stream.in_(("target", "actual"))
    )
    return int(db.scalar(total) or 0)


def _count(db: Session, model: type[Contact | Completion], session: StudySession) -> int:
    rows = select(func.count()).select_from(model).where(model.session_id == session.id)
    return db.scalar(rows) or 0
