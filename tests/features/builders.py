"""Builders that write studies and sessions directly into the database, with reproducible rows.

A session goes through the shipped study: forms, free movement, three blocks of a hand and a foot
phase with their questionnaires. Steps in `redone` occur twice, with the first attempt voided.
"""

from collections.abc import Sequence
from dataclasses import asdict, replace
from datetime import timedelta

from sqlalchemy.orm import Session

from app.clock import Clock
from app.features.design.studies import add_shipped, newest_version, protocol_of, study_by_key
from app.features.movement.avatar import SHIPPED, version_of
from app.features.record.ledger import close_attempt, open_attempt, take_slot
from app.features.record.sessions import store_content
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine import initial_state, state_to_json
from app.features.record.sessions.engine.state import SessionStatus, StepState, StepStatus
from app.features.record.sessions.journal import append_events
from app.models import (
    Participant,
    StudySession,
)
from app.protocol.plan import Step, compile_plan
from tests.features.session_filler import NOW, Filler, SessionSpec, stable_id

__all__ = ["NOW", "STUDY", "SessionSpec", "as_physics", "build_session", "build_study"]
STUDY = "reembodiment-latency"
ENDED = ("completed", "aborted", "withdrawn")


def build_study(db: Session) -> str:
    """Store the shipped studies and instruments; return the key of the latency study."""
    add_shipped(db, NOW)
    return STUDY


def build_session(db: Session, spec: SessionSpec, study: str = STUDY) -> StudySession:
    """Store a session with its forms, phases, contacts, completed tasks, errors and events."""
    version = newest_version(db, study_by_key(db, study))
    slot = take_slot(db, version, protocol_of(version), spec.kind, NOW)
    participant = Participant(
        study_id=version.study_id, kind=spec.kind, code=spec.code, created_at=NOW
    )
    db.add(participant)
    db.flush()
    plan = compile_plan(protocol_of(version), slot.sequence)
    session = StudySession(
        id=stable_id(spec.code, spec.kind),
        study_id=version.study_id,
        study_version_id=version.id,
        participant_id=participant.id,
        kind=spec.kind,
        avatar=protocol_of(version).avatar,
        language="en",
        time_scale=1.0,
        seed=1,
        status=spec.status,
        version=2,
        snapshot=_snapshot(plan, spec),
        created_at=NOW + timedelta(hours=int(slot.position)),
        started_at=NOW + timedelta(hours=int(slot.position), minutes=1),
        ended_at=NOW + timedelta(hours=int(slot.position), minutes=40)
        if spec.status in ENDED
        else None,
    )
    db.add(session)
    db.flush()
    open_attempt(db, slot, session, NOW)
    if spec.status in ENDED:
        close_attempt(db, session, spec.status, NOW)
    body = {"stated": 1.75, "matched": 1.73}
    store_content(db, session_id=session.id, kind="height", body=body, by="account:admin", now=NOW)
    Filler(db, session, spec).fill(plan)
    _log(db, session)
    db.flush()
    return session


def as_physics(db: Session, session: StudySession) -> None:
    """Give a session the shipped physics avatar instead of a delayed copy."""
    session.avatar = "physics"
    session.avatar_configuration_hash = version_of(db, SHIPPED, None).content_hash


def _snapshot(plan: Sequence[Step], spec: SessionSpec) -> dict[str, object]:
    steps = []
    for step in plan:
        status = StepStatus.SKIPPED if step.key in spec.skipped else StepStatus.DONE
        steps.append(StepState(status, attempt=2 if step.key in spec.redone else 1))
    ended = replace(initial_state(len(plan)), version=2, status=SessionStatus(spec.status))
    state = replace(ended, steps=tuple(steps))
    assert asdict(state)
    return state_to_json(state)


def _log(db: Session, session: StudySession) -> None:
    events = (e.SessionStarted(), e.SessionEnded(status="completed"))
    append_events(
        db,
        session_id=session.id,
        version=0,
        events=events,
        actor="account:admin",
        command_id=None,
        clock=Clock(utc_now=lambda: NOW, monotonic_ns=lambda: 1_500_000_000),
    )
