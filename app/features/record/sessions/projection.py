"""Rows folded from events for queries: phases, the session's status, its hold on the ledger.

They hold nothing that the events do not; they could be rebuilt at any time.
"""

from collections.abc import Sequence
from datetime import datetime

from sqlalchemy.orm import Session

from app.features.design.studies import freeze
from app.features.record.alarms import Change, Condition, clear_all, store_change
from app.features.record.ledger import close_attempt
from app.features.record.sessions.engine import Event
from app.features.record.sessions.engine import events as e
from app.models import Phase, StudySession, StudyVersion
from app.protocol import Step


def project(
    db: Session, session: StudySession, plan: Sequence[Step], event: Event, now: datetime
) -> None:
    """Bring the rows of `session` up to date with one event."""
    match event:
        case e.SessionStarted():
            session.started_at = now
            version = db.get_one(StudyVersion, session.study_version_id)
            freeze(version, now)
        case e.SessionEnded(status=status):
            session.ended_at = now
            close_attempt(db, session, str(status), now)
            clear_all(db, [session.id], "the session has ended", now)
        case e.StopRuleOverridden():
            over = Condition("stop_rule_met", "the operator went on, with a reason on record")
            store_change(db, session.id, Change("cleared", over, now))
        case e.PhasePrepared():
            db.add(_phase_row(session, plan[event.step], event, now))
            db.flush()
        case _:
            phase_id = getattr(event, "phase_id", None)
            if phase_id is not None:
                _update_phase(db.get_one(Phase, (session.id, phase_id)), event, now)


def _phase_row(session: StudySession, step: Step, event: e.PhasePrepared, now: datetime) -> Phase:
    return Phase(
        session_id=session.id,
        phase_id=event.phase_id,
        step_index=event.step,
        step_key=step.key,
        attempt=event.attempt,
        kind=step.kind,
        limb=step.limb,
        block=step.block,
        condition=step.condition,
        latency_ms=event.latency_ms,
        status="preparing",
        prepared_at=now,
    )


def _update_phase(phase: Phase, event: Event, now: datetime) -> None:
    active_s = getattr(event, "active_s", None)
    if active_s is not None:
        phase.active_s = active_s
    match event:
        case e.PhaseStarted(client_t_s=client_t_s):
            phase.status, phase.started_at, phase.client_started_s = "running", now, client_t_s
        case e.PhasePaused():
            # The headset's own report may confirm a pause that the server had to assume.
            phase.paused_count += phase.status != "paused"
            phase.status = "paused"
        case e.WalkBackStarted():
            phase.status = "walk_back"
            phase.walk_back_count += 1
        case e.PhaseResumed() | e.WalkBackEnded():
            phase.status = "running"
        case e.PhaseFrozen(client_t_s=client_t_s):
            phase.status, phase.client_ended_s = "freezing", client_t_s
        case e.PhaseEnded():
            phase.status, phase.ended_at = "done", now
        case e.PhaseVoided():
            phase.status, phase.ended_at = "voided", phase.ended_at or now
        case _:
            return
