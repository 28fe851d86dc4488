"""HTTP endpoint for the receipt of a session."""

from fastapi import APIRouter

from app.features.record.receipts.service import SessionReceipt, receipt_of
from app.features.record.sessions import protocol_of_session
from app.platform.access import is_blind, session_by_id
from app.platform.dependencies import Reading, SignedIn

router = APIRouter(tags=["receipts"])


@router.get("/sessions/{session_id}/receipt")
def get_receipt(session_id: str, db: Reading, caller: SignedIn) -> SessionReceipt:
    """Compute the receipt of a session from its record.

    Blinded readers see neither latencies nor hashes and flagged counts of the avatar's frames, and
    while a phase runs no stream of reports.
    """
    session = session_by_id(db, session_id)
    is_hidden = is_blind(db, caller, protocol_of_session(db, session), session)
    return receipt_of(db, session_id, blinded=is_hidden)
