"""Recover sessions that were running when the server stopped unexpectedly."""

from sqlalchemy import select

from app.database import referenced_row
from app.features.design.studies import protocol_of
from app.features.record.alarms import PERSISTENT, clear_all, sessions_with_open_alarms
from app.features.record.sessions import HeadsetLost, apply_command, certain_active_s, state_of
from app.features.record.telemetry.trials import forget_trial
from app.models import StudySession, StudyVersion
from app.platform.access import session_by_id
from app.platform.context import AppContext


def stop_running_clocks(context: AppContext) -> int:
    """Pause every running phase at its last active time on disk; return how many there were.

    Studies with `on_disconnect: continue` are left alone: their headsets continue, using their
    journals. Open alarms are cleared; persisting problems will raise them again. What was left of
    headsets' self-tests is deleted.
    """
    _clear_alarms(context)
    with context.database.writing() as db:
        forget_trial(db)
    with context.database.reading() as db:
        active = list(db.scalars(select(StudySession.id).where(StudySession.status == "active")))
    paused = 0
    for session_id in active:
        with context.database.writing() as db:
            session = session_by_id(db, session_id, lock=True)
            version = referenced_row(db, StudyVersion, session.study_version_id)
            phase = state_of(session).phase
            if phase is None or protocol_of(version).on_disconnect == "continue":
                continue
            active_s = certain_active_s(db, session_id, phase.phase_id)
            command = HeadsetLost(active_s=active_s, cause="server_restarted")
            paused += len(apply_command(db, context, session, command, actor="system").events)
    return paused


def _clear_alarms(context: AppContext) -> None:
    """Clear the open alarms, which nothing has monitored since the server stopped.

    Alarms about the participant stay open.
    """
    now = context.clock.utc_now()
    with context.database.writing() as db:
        sessions = sessions_with_open_alarms(db)
        clear_all(db, sessions, "the server had stopped in between", now, keep=PERSISTENT)
