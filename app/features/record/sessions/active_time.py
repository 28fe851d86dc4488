"""How far a phase is by what its headset has sent, between the events that say so."""

from collections.abc import Sequence
from dataclasses import replace

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.features.record.sessions.engine import SessionState
from app.features.record.sessions.engine.events import Event, PhaseVoided
from app.models import TelemetryStream
from app.protocol import Step


def certain_active_s(db: Session, session_id: str, phase_id: int) -> float:
    """Return the greatest active time of a phase that is on disk."""
    stored = db.scalar(
        select(func.max(TelemetryStream.active_s)).where(
            TelemetryStream.session_id == session_id, TelemetryStream.phase_id == phase_id
        )
    )
    return stored or 0.0


def reached_active_s(
    db: Session, session_id: str, plan: Sequence[Step], state: SessionState
) -> float | None:
    """Return how far the current phase is; None if there is none."""
    phase = state.phase
    if phase is None:
        return None
    stored_s = certain_active_s(db, session_id, phase.phase_id)
    return max(phase.active_s, min(stored_s, plan[phase.step].duration_s or 0.0))


def with_active_time(
    db: Session,
    session_id: str,
    plan: Sequence[Step],
    state: SessionState,
    events: Sequence[Event],
) -> list[Event]:
    """Return the events, in which a phase that is interrupted is said to be as far as it was."""
    return [
        replace(event, active_s=reached_active_s(db, session_id, plan, state))
        if isinstance(event, PhaseVoided)
        and state.phase is not None
        and event.phase_id == state.phase.phase_id
        else event
        for event in events
    ]
