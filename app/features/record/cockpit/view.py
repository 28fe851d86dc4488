"""Build the cockpit's views of sessions from their snapshots and rows."""

import json
from collections.abc import Mapping, Sequence
from typing import Any, TypedDict

from sqlalchemy import Row, select
from sqlalchemy.orm import Session

from app.database import referenced_row
from app.features.design.instruments import instrument_of
from app.features.design.studies import instrument_for, protocol_of, versions_of
from app.features.record.alarms import AlarmView, open_alarms
from app.features.record.cockpit.avatar_changes import avatar_changes_view
from app.features.record.cockpit.calibration import calibration_view, goals_view
from app.features.record.cockpit.end_reasons import end_reasons
from app.features.record.cockpit.phase_views import phase_views
from app.features.record.cockpit.schemas import (
    CurrentView,
    DeviceView,
    EventView,
    HeldView,
    ListedSession,
    NamedAvatar,
    NoteView,
    RefusalView,
    SessionView,
    SlotInfo,
    StepBrief,
    StepView,
)
from app.features.record.devices import TABLET_SILENT_AFTER_S, devices_of_session
from app.features.record.ledger import shortfalls_of, slot_of
from app.features.record.questionnaires import stored_scores
from app.features.record.self_tests import running_test
from app.features.record.sessions import (
    PhaseStatus,
    SessionState,
    SessionStatus,
    StepStatus,
    allowed_commands,
    consent_form,
    content_body,
    contents_of,
    events_of,
    plan_of,
    state_of,
    without_condition,
)
from app.models import (
    Avatar,
    LedgerSlot,
    Participant,
    SlotAttempt,
    Study,
    StudySession,
    StudyVersion,
)
from app.platform.access import Caller, hidden_sessions, is_blind
from app.platform.context import AppContext
from app.protocol import Step, StudyProtocol
from app.texts import chosen


def session_view(
    db: Session, context: AppContext, session: StudySession, caller: Caller
) -> SessionView:
    """Return the full view of a session, without what `caller` may not see."""
    version = referenced_row(db, StudyVersion, session.study_version_id)
    protocol = protocol_of(version)
    blinded = is_blind(db, caller, protocol, session)
    state, plan, slot = state_of(session), plan_of(db, session), slot_of(db, session)
    reasons, alarms = _reasons(db, session), open_alarms(db, session.id)
    order = _HIDDEN_ORDER if blinded else _order(protocol, slot.sequence)
    reason = end_reasons(db, StudySession.id == session.id).get(session.id)
    listed = _listed(session, version.number, _code(db, session), order, end_reason=reason)
    return SessionView(
        **listed.model_dump(exclude={"step"}),
        blinded=blinded,
        study_key=protocol.key,
        study_title=dict(protocol.title),
        avatar=session.avatar,
        avatar_configuration_hash=session.avatar_configuration_hash,
        avatar_version=_named_avatar(db, protocol, session),
        language=session.language,
        version=session.version,
        time_scale=session.time_scale,
        slot=SlotInfo(index=slot.position, block=slot.block, replicate=slot.replicate),
        steps=[_step(step, state, reasons, blinded=blinded) for step in plan],
        current=_current(plan, state),
        held=held_view(db, version, protocol, state),
        refusal=_refusal(state, alarms),
        allowed=allowed_commands(
            plan, state, is_physics=session.avatar_configuration_hash is not None
        ),
        devices=_devices(db, context, session),
        alarms=alarms,
        phases=phase_views(db, session, blinded=blinded),
        notes=_notes(db, session),
        scores=stored_scores(db, session),
        avatar_changes=avatar_changes_view(db, session, blinded=blinded),
        goals=goals_view(db, session),
        calibration=calibration_view(db, context.hub, session),
    )


def _named_avatar(
    db: Session, protocol: StudyProtocol, session: StudySession
) -> NamedAvatar | None:
    named = protocol.avatar_configuration
    if named is None or session.avatar_configuration_hash is None:
        return None
    title = db.scalar(select(Avatar.title).where(Avatar.key == named.key))
    return NamedAvatar(key=named.key, title=title or named.key, version=named.version)


def list_sessions(
    db: Session, study: Study, kind: str | None, caller: Caller
) -> list[ListedSession]:
    """Return all sessions of a study, newest first; orders are omitted if `caller` is blinded."""
    # Only the columns shown: a thousand complete sessions with their snapshots would be most of the
    # work.
    query = (
        select(
            StudySession.id,
            StudySession.study_version_id,
            StudySession.kind,
            StudySession.status,
            StudySession.created_at,
            StudySession.started_at,
            StudySession.ended_at,
            StudySession.shortfalls,
            Participant.code,
            LedgerSlot.sequence,
        )
        .join(Participant, Participant.id == StudySession.participant_id)
        .join(SlotAttempt, SlotAttempt.session_id == StudySession.id)
        .join(LedgerSlot, LedgerSlot.id == SlotAttempt.slot_id)
        .where(StudySession.study_id == study.id)
        .order_by(StudySession.created_at.desc())
    )
    if kind is not None:
        query = query.where(StudySession.kind == kind)
    versions = {version.id: version for version in versions_of(db, study)}
    hidden = hidden_sessions(db, study, caller)
    steps = _steps_of_running(db, study)
    end = end_reasons(db, StudySession.study_id == study.id)
    orders: dict[tuple[str, ...], _Order] = {}
    listed = []
    for row in db.execute(query):
        version = versions[row.study_version_id]
        if row.id in hidden:
            order = _HIDDEN_ORDER
        else:
            order = orders.get((version.id, *row.sequence)) or orders.setdefault(
                (version.id, *row.sequence), _order(protocol_of(version), row.sequence)
            )
        step, reason = steps.get(row.id), end.get(row.id)
        listed.append(_listed(row, version.number, row.code, order, step, end_reason=reason))
    return listed


def _steps_of_running(db: Session, study: Study) -> dict[str, StepBrief]:
    """Return where each running session of a study is, by its id."""
    running = db.scalars(
        select(StudySession).where(
            StudySession.study_id == study.id, StudySession.status == SessionStatus.ACTIVE
        )
    )
    found = {}
    for session in running:
        state, plan = state_of(session), plan_of(db, session)
        if state.current is None:
            continue
        step = plan[state.current]
        found[session.id] = StepBrief(
            index=step.index,
            steps=len(plan),
            kind=step.kind,
            limb=step.limb,
            paused=state.phase is not None and state.phase.status is PhaseStatus.PAUSED,
        )
    return found


def event_views(db: Session, session: StudySession, caller: Caller) -> list[EventView]:
    """Return the event log of a session, oldest first.

    Blinded callers get no latencies and no hashes: from a hash, the latency can be found by trying
    the few possible values.
    """
    version = referenced_row(db, StudyVersion, session.study_version_id)
    blinded = is_blind(db, caller, protocol_of(version), session)
    views = []
    for row in events_of(db, session.id):
        data = json.loads(row.payload)
        if blinded:
            data = without_condition(row.type, data)
        views.append(
            EventView(
                seq=row.seq,
                type=row.type,
                at=row.recorded_at,
                by=row.actor,
                data=data,
                hash=None if blinded else row.hash,
            )
        )
    return views


class _Order(TypedDict):
    """The fields of a summary that tell the order of conditions."""

    sequence: list[float] | None
    bodies: list[str | None] | None


_HIDDEN_ORDER = _Order(sequence=None, bodies=None)


def _order(protocol: StudyProtocol, sequence: Sequence[str]) -> _Order:
    bodies = protocol.bodies_of(sequence)
    return _Order(
        sequence=[protocol.condition(key).latency_ms for key in sequence],
        bodies=None if bodies is None else list(bodies),
    )


def _listed(
    session: StudySession | Row[Any],
    version_number: int,
    code: str,
    order: _Order,
    step: StepBrief | None = None,
    *,
    end_reason: str | None = None,
) -> ListedSession:
    """Summarise a session, or a row with the same names of its columns."""
    return ListedSession(
        id=session.id,
        participant_code=code,
        kind=session.kind,
        simulated=session.kind == "simulated",
        status=session.status,
        **order,
        study_version=version_number,
        created_at=session.created_at,
        started_at=session.started_at,
        ended_at=session.ended_at,
        end_reason=end_reason,
        shortfalls=(
            None if session.shortfalls is None else list(shortfalls_of(session.shortfalls))
        ),
        step=step,
    )


def _code(db: Session, session: StudySession) -> str:
    return db.get_one(Participant, session.participant_id).code


def _step(
    step: Step, state: SessionState, reasons: Mapping[int, str], *, blinded: bool
) -> StepView:
    own = state.steps[step.index]
    return StepView(
        index=step.index,
        key=step.key,
        kind=step.kind,
        title=chosen(step.title, "en"),
        block=step.block,
        latency_ms=None if blinded else step.latency_ms,
        body=None if blinded else step.body,
        limb=step.limb,
        preparation_s=step.preparation_s,
        duration_s=step.duration_s,
        freeze_s=step.freeze_s,
        instrument=step.instrument,
        status=_shown_status(own.status, state),
        attempt=own.attempt,
        reason=reasons.get(step.index),
        consent=consent_form(step, "en"),
        until_completions=step.until_completions,
        avatar_changes=step.avatar_changes,
        forms=step.forms,
    )


def _shown_status(status: StepStatus, state: SessionState) -> str:
    """Return a step's status; nothing is current once the session has ended."""
    has_ended = state.status not in (SessionStatus.PLANNED, SessionStatus.ACTIVE)
    return str(StepStatus.PENDING if has_ended and status is StepStatus.CURRENT else status)


def _current(plan: Sequence[Step], state: SessionState) -> CurrentView | None:
    if state.current is None:
        return None
    phase = state.phase
    return CurrentView(
        index=state.current,
        status="ready" if phase is None else str(phase.status),
        active_s=0.0 if phase is None else phase.active_s,
        duration_s=plan[state.current].duration_s,
        pausing=phase is not None and phase.pausing,
        resuming=phase is not None and phase.resuming,
        pause_reason=None if phase is None else phase.pause_cause,
    )


def _devices(db: Session, context: AppContext, session: StudySession) -> list[DeviceView]:
    now = context.clock.utc_now()
    views = []
    for device in devices_of_session(db, session.id):
        seen = context.hub.last_seen(device.id) or device.last_seen_at
        if device.kind == "headset":
            connected = context.hub.headset_connected(session.id)
            left = context.hub.headset_left_at(session.id)
            # One that was paired since and has not connected yet was seen then.
            seen = max((at for at in (seen, left) if at is not None), default=None)
        else:
            connected = seen is not None and (now - seen).total_seconds() < TABLET_SILENT_AFTER_S
        views.append(
            DeviceView(
                id=device.id,
                kind=device.kind,
                name=device.name,
                paired_at=device.paired_at,
                connected=connected,
                last_seen_at=seen,
                self_test=running_test(context, session.id) if device.kind == "headset" else None,
            )
        )
    return views


def _notes(db: Session, session: StudySession) -> list[NoteView]:
    return [
        NoteView(id=row.id, text=str(content_body(row)), at=row.created_at, by=row.created_by)
        for row in contents_of(db, session.id, "note")
        if row.body is not None
    ]


def _reasons(db: Session, session: StudySession) -> dict[int, str]:
    """Return the latest reason for which each step was skipped or repeated, by step index."""
    bodies = {
        row.id: content_body(row) for row in contents_of(db, session.id, "reason") if row.body
    }
    reasons: dict[int, str] = {}
    for row in events_of(db, session.id):
        if row.type in ("step_skipped", "step_reopened"):
            payload = json.loads(row.payload)
            if payload["content_id"] in bodies:
                reasons[payload["step"]] = str(bodies[payload["content_id"]])
    return reasons


def _refusal(state: SessionState, alarms: Sequence[AlarmView]) -> RefusalView | None:
    """Return the refusal that holds the session; None if there is none or the session has ended."""
    if state.refused_consent is None or state.current is None:
        return None
    since = (alarm.since for alarm in alarms if alarm.code == "consent_refused")
    return RefusalView(step=state.refused_consent, at=next(since, None))


def held_view(
    db: Session, version: StudyVersion, protocol: StudyProtocol, state: SessionState
) -> HeldView | None:
    """Return the stop rule that holds the session; None if the session is not held."""
    if state.held is None or protocol.safety is None:
        return None
    rule = protocol.safety.stop_rules[state.held.rule]
    instrument = instrument_of(instrument_for(db, version, rule.instrument))
    labels = {score.key: score.label for score in instrument.scores}
    return HeldView(
        rule=state.held.rule,
        instrument=chosen(instrument.title, "en"),
        score=chosen(labels[rule.score], "en"),
        stop_at=rule.stop_at,
        is_rise=rule.change_from is not None,
    )
