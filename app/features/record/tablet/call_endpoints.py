"""The experimenter answers a participant's call."""

from fastapi import APIRouter

from app.features.record.sessions.service import session_by_id
from app.features.record.tablet.help import note_help
from app.platform.dependencies import Context, SignedIn, Writing

router = APIRouter(tags=["sessions"])


@router.post("/sessions/{session_id}/help/answered", status_code=204)
def post_help_answered(session_id: str, db: Writing, context: Context, _: SignedIn) -> None:
    """Say that somebody went to the participant; the tablet says so, too."""
    note_help(db, context, session_by_id(db, session_id, lock=True), "answered")
