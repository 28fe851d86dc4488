"""Alarms over HTTP: what went wrong in a session, and when."""

from fastapi import APIRouter

from app.features.record.alarms.service import AlarmView, alarm_history
from app.platform.access import session_by_id
from app.platform.dependencies import Reading, SignedIn

router = APIRouter(tags=["sessions"])


@router.get("/sessions/{session_id}/alarms")
def get_alarms(session_id: str, db: Reading, _: SignedIn) -> list[AlarmView]:
    """Every alarm that a session had, the newest first."""
    return alarm_history(db, session_by_id(db, session_id))
