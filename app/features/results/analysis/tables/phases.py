"""The tables of phases, of the quality of their streams, of doubts and of alarms."""

from itertools import groupby
from operator import attrgetter

import pandas as pd
from sqlalchemy import case, func, select
from sqlalchemy.orm import Session

from app.features.design.studies import study_by_key
from app.features.record.sessions import changed_phases
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import (
    doubts_context,
    finished,
    of_kind,
    phases_context,
    read,
    sessions_context,
)
from app.features.results.analysis.tables.headset import added_latencies
from app.features.results.analysis.tables.tasks import red_spans, total_s
from app.models import (
    AlarmRow,
    Completion,
    Contact,
    Phase,
    PhaseLatency,
    PhaseQuality,
    SessionEvent,
    Study,
    StudySession,
)
from app.wire import StreamName

MS_PER_S = 1000.0
_KEYS = ["session_id", "phase_id"]
_COUNTS = ("gaps", "gap_s", "longest_gap_s", "jumps", "frozen_s", "frozen_joints")
_BROKEN = ("non_unit", "non_finite", "backwards")
_FIGURES = ("stream", "frames", "span_s", "frame_rate_hz", *_COUNTS, *_BROKEN)
_ALARM = ("code", "severity", "state", "stream", "message", "value", "unit", "client_t_s", "at")
_CHANGES = ("avatar_changed", "phase_prepared", "phase_ended", "phase_voided")
_STREAMS = {str(stream): place for place, stream in enumerate(StreamName)}


def phases_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per phase, by session and phase."""
    study = study_by_key(db, study_key)
    frame = phases_context(db, study_key, kind)
    for more in (_details, _completions, _red, _latencies, added_latencies, _avatar_changes):
        frame = frame.merge(more(db, study, kind), on=_KEYS, how="left")
    for name in ("completions", "side_contacts", "side_red_s"):
        # No row means none happened, but of an erased person nobody knows any more.
        frame[name] = [
            (None if erased else 0) if pd.isna(value) else value
            for value, erased in zip(frame[name], frame["erased"], strict=True)
        ]
    return finished(frame, "phases")


def _details(db: Session, study: Study, kind: Kind) -> pd.DataFrame:
    query = (
        select(
            Phase.session_id,
            Phase.phase_id,
            Phase.step_key,
            Phase.body,
            Phase.active_s,
            Phase.paused_count,
            Phase.walk_back_count,
            Phase.client_started_s,
            Phase.client_ended_s,
            Phase.prepared_at,
            Phase.started_at,
            Phase.ended_at,
        )
        .join(StudySession, StudySession.id == Phase.session_id)
        .where(of_kind(study, kind))
    )
    names = ("step_key", "body", "active_s", "paused_count", "walk_back_count", "client_started_s")
    times = ("client_ended_s", "prepared_at_utc", "started_at_utc", "ended_at_utc")
    return read(db, query, (*_KEYS, *names, *times))


def _avatar_changes(db: Session, study: Study, kind: Kind) -> pd.DataFrame:
    """Return who had changed the avatar, for the phases in which somebody had."""
    changed = (
        select(SessionEvent.session_id)
        .join(StudySession, StudySession.id == SessionEvent.session_id)
        .where(of_kind(study, kind), SessionEvent.type == "avatar_changed")
    )
    query = (
        select(SessionEvent)
        .where(SessionEvent.session_id.in_(changed), SessionEvent.type.in_(_CHANGES))
        .order_by(SessionEvent.session_id, SessionEvent.seq)
    )
    rows = [
        (session_id, phase_id, " and ".join(by))
        for session_id, log in groupby(db.scalars(query), attrgetter("session_id"))
        for phase_id, by in changed_phases(log).items()
    ]
    return pd.DataFrame(rows, columns=[*_KEYS, "avatar_changes"], dtype=object)


def _completions(db: Session, study: Study, kind: Kind) -> pd.DataFrame:
    query = (
        select(Completion.session_id, Completion.phase_id, func.count())
        .join(StudySession, StudySession.id == Completion.session_id)
        .where(of_kind(study, kind))
        .group_by(Completion.session_id, Completion.phase_id)
    )
    return read(db, query, (*_KEYS, "completions"))


def _latencies(db: Session, study: Study, kind: Kind) -> pd.DataFrame:
    query = (
        select(
            PhaseLatency.session_id,
            PhaseLatency.phase_id,
            PhaseLatency.achieved_s * MS_PER_S,
            PhaseLatency.low_s * MS_PER_S,
            PhaseLatency.high_s * MS_PER_S,
            # Null if there is no achieved latency.
            case((PhaseLatency.achieved_s.is_not(None), PhaseLatency.flagged)),
            PhaseLatency.reason,
            PhaseLatency.movement_s,
            PhaseLatency.samples,
        )
        .join(StudySession, StudySession.id == PhaseLatency.session_id)
        .where(of_kind(study, kind))
    )
    achieved = ("achieved_latency_ms", "achieved_latency_low_ms", "achieved_latency_high_ms")
    others = ("latency_off", "latency_reason", "movement_s", "latency_samples")
    return read(db, query, (*_KEYS, *achieved, *others))


def _red(db: Session, study: Study, kind: Kind) -> pd.DataFrame:
    query = (
        select(
            Contact.session_id,
            Contact.phase_id,
            Contact.surface,
            Contact.begin_active_s,
            Contact.end_active_s,
        )
        .join(StudySession, StudySession.id == Contact.session_id)
        .where(of_kind(study, kind), Contact.surface_kind == "side")
    )
    by_phase: dict[tuple[str, int], list[tuple[str, float, float]]] = {}
    for session_id, phase_id, surface, begin_s, end_s in db.execute(query):
        by_phase.setdefault((session_id, phase_id), []).append((surface, begin_s, end_s))
    rows = []
    for (session_id, phase_id), contacts in by_phase.items():
        spans = [span for side in red_spans(contacts).values() for span in side]
        rows.append((session_id, phase_id, len(spans), total_s(spans)))
    return pd.DataFrame(rows, columns=[*_KEYS, "side_contacts", "side_red_s"], dtype=object)


def quality_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per finished phase and stream, target first."""
    query = (
        select(*(getattr(PhaseQuality, name) for name in (*_KEYS, *_FIGURES)))
        .join(StudySession, StudySession.id == PhaseQuality.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
    )
    rows = read(db, query, (*_KEYS, *_FIGURES))
    rows["frozen_joints"] = [" ".join(joints) or None for joints in rows["frozen_joints"]]
    rows["place"] = rows["stream"].map(_STREAMS)
    frame = phases_context(db, study_key, kind).merge(rows.sort_values("place"), on=_KEYS)
    return finished(frame, "quality")


def doubts_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per doubt about data of a headset, by session and phase."""
    doubts = doubts_context(db, study_key, kind)
    return finished(sessions_context(db, study_key, kind).merge(doubts, on="session_id"), "doubts")


def alarms_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per alarm raised and one per alarm cleared, by session and time."""
    query = (
        select(AlarmRow.session_id, *(getattr(AlarmRow, name) for name in _ALARM))
        .join(StudySession, StudySession.id == AlarmRow.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(AlarmRow.at, AlarmRow.id)
    )
    names = {"unit": "value_unit", "at": "at_utc"}
    rows = read(db, query, ("session_id", *(names.get(name, name) for name in _ALARM)))
    return finished(sessions_context(db, study_key, kind).merge(rows, on="session_id"), "alarms")
