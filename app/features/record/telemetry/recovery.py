"""What a starting server does about sessions that were running when it died."""

from sqlalchemy import select

from app.database import referenced_row
from app.features.design.studies import protocol_of
from app.features.record.alarms import PERSISTENT, clear_all, sessions_with_open_alarms
from app.features.record.sessions import HeadsetLost, apply_command, state_of
from app.features.record.telemetry.positions import certain_active_s
from app.models import StudySession, StudyVersion
from app.platform.access import session_by_id
from app.platform.context import AppContext


def stop_running_clocks(context: AppContext) -> int:
    """Pause every phase whose clock ran, at the last active time on disk; how many there were.

    A study with `on_disconnect: continue` is left alone: its headset goes on by its journal. Alarms
    that were open are cleared; what is still wrong will be raised again.
    """
    _clear_alarms(context)
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
    """Nobody has looked since the server died, so nobody knows whether they still hold.

    What is known of the participant's state stays.
    """
    now = context.clock.utc_now()
    with context.database.writing() as db:
        sessions = sessions_with_open_alarms(db)
        clear_all(db, sessions, "the server had stopped in between", now, keep=PERSISTENT)
