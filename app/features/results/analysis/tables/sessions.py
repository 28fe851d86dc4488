"""The tables of sessions and of the events in their logs."""

import json
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any

import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.studies import protocol_of, study_by_key, versions_of
from app.features.record.ledger import shortfalls_of
from app.features.record.sessions import content_body, plans_of, state_of
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import (
    BROKEN_OFF,
    doubted_sessions,
    finished,
    of_kind,
    read,
    sessions_context,
)
from app.models import (
    LedgerSlot,
    SessionContent,
    SessionEvent,
    SlotAttempt,
    Study,
    StudySession,
    StudyVersion,
)

IN_DOUBT = "what the headset said cannot be true (doubts.csv)"
ERASED = "the participant’s data were erased"


def sessions_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per session, oldest first."""
    study = study_by_key(db, study_key)
    frame = sessions_context(db, study_key, kind).rename(columns={"session_status": "status"})
    frame = frame.merge(_details(db, study, kind), on="session_id")
    frame = frame.merge(_heights(db, study, kind), on="session_id", how="left")
    frame = frame.merge(_consents(db, study, kind), on="session_id", how="left")
    levels = _levels(db, study)
    frame["order"] = [
        " ".join(levels[version, key] for key in sequence or ())
        for version, sequence in zip(frame["study_version"], frame["sequence"], strict=True)
    ]
    frame["valid"] = frame["session_counts"]
    doubted = doubted_sessions(db, study_key, kind)
    frame["reasons_not_valid"] = [
        f"session {status}"
        if status in BROKEN_OFF
        else ERASED
        if erased
        else _reasons(found, IN_DOUBT if own in doubted else None)
        for status, erased, found, own in zip(
            frame["status"],
            frame["erased"],
            frame["shortfalls"],
            frame["session_id"],
            strict=True,
        )
    ]
    return finished(frame, "sessions")


def _reasons(stored: Sequence[Mapping[str, Any]] | None, more: str | None) -> str | None:
    return "; ".join(filter(None, (reasons_in_words(stored), more))) or None


def reasons_in_words(stored: Sequence[Mapping[str, Any]] | None) -> str | None:
    """Return the reasons why a completed session is not valid, in one cell; None if it is valid."""
    return "; ".join(one.words() for one in shortfalls_of(stored)) or None


def _details(db: Session, study: Study, kind: Kind) -> pd.DataFrame:
    query = (
        select(
            StudySession.id,
            StudySession.language,
            StudySession.time_scale,
            StudySession.created_at,
            StudySession.started_at,
            StudySession.ended_at,
            StudyVersion.content_hash,
            StudySession.avatar_configuration_hash,
            LedgerSlot.position,
            LedgerSlot.block,
            LedgerSlot.replicate,
            LedgerSlot.sequence,
        )
        .join(StudyVersion, StudyVersion.id == StudySession.study_version_id)
        .join(SlotAttempt, SlotAttempt.session_id == StudySession.id)
        .join(LedgerSlot, LedgerSlot.id == SlotAttempt.slot_id)
        .where(of_kind(study, kind))
    )
    names = ("session_id", "language", "time_scale")
    times = ("created_at_utc", "started_at_utc", "ended_at_utc")
    hashes = ("study_content_hash", "avatar_configuration_hash")
    slot = ("slot_index", "slot_block", "slot_replicate", "sequence")
    return read(db, query, (*names, *times, *hashes, *slot))


def _heights(db: Session, study: Study, kind: Kind) -> pd.DataFrame:
    """Return the newest heights of each session; sessions whose heights were erased have no row."""
    contents = db.scalars(
        select(SessionContent)
        .join(StudySession, StudySession.id == SessionContent.session_id)
        .where(of_kind(study, kind), SessionContent.kind == "height")
        .order_by(SessionContent.created_at, SessionContent.id)
    )
    newest = {row.session_id: content_body(row) for row in contents}
    rows = [
        (session_id, body.get("stated"), body.get("matched"))
        for session_id, body in newest.items()
        if isinstance(body, dict)
    ]
    columns = ["session_id", "height_stated_m", "height_matched_m"]
    return pd.DataFrame(rows, columns=columns, dtype=object)


def _consents(db: Session, study: Study, kind: Kind) -> pd.DataFrame:
    """Return whether and when consent was given, from steps and event log, without any texts."""
    events = db.execute(
        select(SessionEvent.session_id, SessionEvent.payload, SessionEvent.recorded_at)
        .join(StudySession, StudySession.id == SessionEvent.session_id)
        .where(of_kind(study, kind), SessionEvent.type == "step_completed")
        .order_by(SessionEvent.session_id, SessionEvent.seq)
    )
    completed: dict[str, list[tuple[int | None, datetime]]] = {}
    for session_id, payload, at in events:
        completed.setdefault(session_id, []).append((json.loads(payload).get("step"), at))
    rows = []
    plans = plans_of(db, of_kind(study, kind))
    for session in db.scalars(select(StudySession).where(of_kind(study, kind))):
        consents = {step.index for step in plans[session.id] if step.kind == "consent"}
        if not consents:
            continue
        steps = state_of(session).steps
        given = all(steps[index].status == "done" for index in consents)
        times = [at for step, at in completed.get(session.id, ()) if step in consents]
        rows.append((session.id, given, times[-1] if given and times else None))
    columns = ["session_id", "consent_given", "consent_at_utc"]
    return pd.DataFrame(rows, columns=columns, dtype=object)


def _levels(db: Session, study: Study) -> dict[tuple[int, str], str]:
    """Return what orders call each condition, by study version and key."""
    return {
        (version.number, key): level
        for version in versions_of(db, study)
        for key, level in protocol_of(version).levels.items()
    }


def events_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per event, by session and sequence number."""
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


def n_not_valid(sessions: pd.DataFrame) -> int:
    """Return the number of completed sessions that are not valid by the rules of their study."""
    return int(((sessions["status"] == "completed") & ~sessions["valid"]).sum())
