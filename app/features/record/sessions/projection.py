"""Update the rows that are derived from events for queries: phases, session status, alarms, slot.

They contain nothing that the events do not contain, so they could be rebuilt at any time.
"""

from collections.abc import Sequence
from datetime import datetime
from typing import Literal

from sqlalchemy.orm import Session

from app.database import referenced_row
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
    """Update the rows of `session` for one event."""
    match event:
        case e.SessionStarted():
            session.started_at = now
            version = referenced_row(db, StudyVersion, session.study_version_id)
            freeze(version, now)
        case e.SessionEnded(status=status):
            session.ended_at = now
            close_attempt(db, session, str(status), now)
            clear_all(db, [session.id], "the session has ended", now)
        case e.StopRuleOverridden():
            over = Condition("stop_rule_met", "the operator continued, with a reason on record")
            store_change(db, session.id, Change("cleared", over, now))
        case (
            e.ConsentRefused()
            | e.RefusalRetracted()
            | e.QuestionAsked()
            | e.QuestionClosed()
            | e.StopAsked()
            | e.StopClosed()
        ):
            _note_said(db, session, event, now)
        case e.StepCompleted(step=step) | e.StepSkipped(step=step):
            if plan[step].kind == "consent":
                over = Condition(
                    "refusal_retracted", "the participant has agreed or the consent was skipped"
                )
                store_change(db, session.id, Change("cleared", over, now))
        case e.PhasePrepared():
            db.add(_phase_row(session, plan[event.step], event, now))
            db.flush()
        case _:
            phase_id = getattr(event, "phase_id", None)
            if phase_id is not None:
                _update_phase(db.get_one(Phase, (session.id, phase_id)), event, now)


def _note_said(db: Session, session: StudySession, event: Event, now: datetime) -> None:
    """Raise and clear the alarms that follow from what the participant said."""

    def change(state: Literal["raised", "cleared"], code: str, message: str) -> None:
        store_change(db, session.id, Change(state, Condition(code, message), now))

    match event:
        case e.ConsentRefused():
            change("cleared", "refusal_retracted", "the participant refused again")
            change("raised", "consent_refused", "The participant does not want to take part.")
        case e.RefusalRetracted(by="tablet"):
            change(
                "cleared", "consent_refused", "the participant took the refusal back on the tablet"
            )
            change("raised", "refusal_retracted", "The participant took the refusal back.")
        case e.RefusalRetracted():
            change("cleared", "consent_refused", "the operator showed the consent again")
        case e.QuestionAsked():
            change("raised", "question_asked", "The participant has a question about the text.")
        case e.StopAsked():
            change("raised", "stop_asked", "The participant wants to stop.")
        case e.StopClosed(outcome="taken_back"):
            change("cleared", "stop_asked", "The participant no longer wants to stop.")
        case e.StopClosed():
            change("cleared", "stop_asked", "The experimenter spoke to the participant.")
        case e.QuestionClosed(outcome="taken_back"):
            change("cleared", "question_asked", "The participant took the question back.")
        case _:
            change("cleared", "question_asked", "The experimenter went to the participant.")


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
        body=event.body,
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
            # The headset's own report may confirm a pause that the server had assumed.
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
