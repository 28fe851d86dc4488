"""HTTP endpoint for the alarms of a session."""

from fastapi import APIRouter

from app.features.record.alarms.service import AlarmView, alarm_history
from app.platform.access import session_by_id
from app.platform.dependencies import Reading, SignedIn

router = APIRouter(tags=["sessions"])


@router.get("/sessions/{session_id}/alarms")
def get_alarms(session_id: str, db: Reading, _: SignedIn) -> list[AlarmView]:
    """Return all alarms of a session, newest first."""
    return alarm_history(db, session_by_id(db, session_id))
