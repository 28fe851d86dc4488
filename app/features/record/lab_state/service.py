"""Gather the state of the lab from the ledger and the sessions, in a few queries.

Nothing here depends on conditions, so it is the same for readers of a blinded study.
"""

from collections.abc import Sequence
from datetime import datetime, timedelta
from typing import Literal

from pydantic import BaseModel
from sqlalchemy import ColumnElement, func, or_, select
from sqlalchemy.orm import Session

from app.features.design.studies import newest_version, protocol_of
from app.models import (
    KINDS,
    Ledger,
    LedgerSlot,
    Participant,
    SlotAttempt,
    Study,
    StudySession,
)
from app.protocol import sequences

RECENT = timedelta(days=7)
"""For how long a session that did not count is worth looking at."""
STALE = timedelta(hours=12)
"""A visit that lasts longer was left open, or never begun."""
MOST = 50
Concern = Literal["left_open", "never_started", "not_valid", "ended_early"]
_PEOPLE = KINDS[0]
_Titles = dict[str, dict[str, str]]
"""The titles of studies in each language, by the study's id."""


class Progress(BaseModel):
    """How far a study is: valid completed participants of those that are planned.

    `planned`: the preregistered number, else the places of the ledger.
    """

    study_key: str
    completed: int
    running: int
    planned: int
    preregistered: bool


class SessionBrief(BaseModel):
    """A session as a line of a list; `study_title`: by language."""

    session_id: str
    study_key: str
    study_title: dict[str, str]
    participant_code: str
    kind: Literal["people", "simulated", "test", "expert"]
    status: Literal["planned", "active", "completed", "aborted", "withdrawn"]
    at: datetime


class Attention(SessionBrief):
    """A session that somebody should look at, and why."""

    concern: Concern


class LabState(BaseModel):
    """The lab at a glance. `today`: sessions since the given time, the newest first."""

    studies: list[Progress]
    today: list[SessionBrief]
    attention: list[Attention]


def lab_state(
    db: Session, visible: ColumnElement[bool], since: datetime, now: datetime
) -> LabState:
    """Return the state of the studies for which `visible` holds; raises nothing."""
    shown = Study.archived_at.is_(None) & visible
    studies = db.scalars(select(Study).where(shown).order_by(Study.key)).all()
    titles = {study.id: dict(protocol_of(newest_version(db, study)).title) for study in studies}
    return LabState(
        studies=[_progress(db, study) for study in studies],
        today=_today(db, studies, titles, since),
        attention=_attention(db, studies, titles, now),
    )


def _progress(db: Session, study: Study) -> Progress:
    protocol = protocol_of(newest_version(db, study))
    declared = protocol.preregistration
    of_people = (Ledger.study_id == study.id) & (Ledger.kind == _PEOPLE)
    holders = (
        select(func.count())
        .select_from(SlotAttempt)
        .join(LedgerSlot, LedgerSlot.id == SlotAttempt.slot_id)
        .join(Ledger, Ledger.id == LedgerSlot.ledger_id)
        .where(of_people)
    )
    places = len(sequences(protocol)) * protocol.orders.replicates
    return Progress(
        study_key=study.key,
        completed=db.scalar(holders.where(SlotAttempt.outcome == "completed")) or 0,
        running=db.scalar(
            select(func.count())
            .select_from(StudySession)
            .where(StudySession.study_id == study.id, StudySession.status == "active")
        )
        or 0,
        planned=places if declared is None else declared.planned_n,
        preregistered=declared is not None,
    )


def _today(
    db: Session, studies: Sequence[Study], titles: _Titles, since: datetime
) -> list[SessionBrief]:
    touched = or_(
        StudySession.created_at >= since,
        StudySession.started_at >= since,
        StudySession.ended_at >= since,
        StudySession.status == "active",
    )
    return [
        SessionBrief(**_brief(session, code, study, titles))
        for session, code, study in _sessions(db, studies, touched)
    ]


def _attention(
    db: Session, studies: Sequence[Study], titles: _Titles, now: datetime
) -> list[Attention]:
    concerns: dict[Concern, ColumnElement[bool]] = {
        "left_open": (StudySession.status == "active") & (StudySession.started_at < now - STALE),
        "never_started": (StudySession.status == "planned")
        & (StudySession.created_at < now - STALE),
        "not_valid": (StudySession.status == "completed")
        & (StudySession.ended_at >= now - RECENT)
        & StudySession.id.in_(
            select(SlotAttempt.session_id).where(SlotAttempt.outcome == "invalid")
        ),
        "ended_early": StudySession.status.in_(("aborted", "withdrawn"))
        & (StudySession.ended_at >= now - RECENT),
    }
    return [
        Attention(**_brief(session, code, study, titles), concern=concern)
        for concern, condition in concerns.items()
        for session, code, study in _sessions(
            db, studies, condition & (StudySession.kind == _PEOPLE)
        )
    ]


def _sessions(
    db: Session, studies: Sequence[Study], condition: ColumnElement[bool]
) -> list[tuple[StudySession, str, Study]]:
    """Return the newest sessions of some studies with their codes."""
    of = {study.id: study for study in studies}
    rows = db.execute(
        select(StudySession, Participant.code)
        .join(Participant, Participant.id == StudySession.participant_id)
        .where(StudySession.study_id.in_(of), condition)
        .order_by(StudySession.created_at.desc())
        .limit(MOST)
    )
    return [(session, code, of[session.study_id]) for session, code in rows]


def _brief(session: StudySession, code: str, study: Study, titles: _Titles) -> dict[str, object]:
    return {
        "session_id": session.id,
        "study_key": study.key,
        "study_title": titles[study.id],
        "participant_code": code,
        "kind": session.kind,
        "status": session.status,
        "at": session.ended_at or session.started_at or session.created_at,
    }
