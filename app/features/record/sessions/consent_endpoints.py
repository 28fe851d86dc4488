"""The record of a consent over HTTP, for the printable page."""

from fastapi import APIRouter

from app.features.record.sessions.consent import consent_record
from app.features.record.sessions.consent_schemas import ConsentRecord
from app.features.record.sessions.service import session_by_id
from app.platform.dependencies import Reading, SignedIn

router = APIRouter(tags=["sessions"])


@router.get("/sessions/{session_id}/consent")
def get_consent(session_id: str, db: Reading, _: SignedIn) -> ConsentRecord | None:
    """The newest consent of a session with everything it was given to; null where there is none."""
    return consent_record(db, session_by_id(db, session_id))
