"""Verifying a session from the command line."""

import json

from app.cli.installation import opened_database
from app.errors import NotFound
from app.features.record.receipts import receipt_of, receipt_text


def verify_session(session_id: str, *, as_json: bool) -> tuple[str, bool]:
    """The receipt of a session of this installation as text or JSON, and whether it is complete.

    Reads beside a running server. Raises ReembodyError for an unknown session.
    """
    with opened_database() as database, database.reading() as db:
        try:
            receipt = receipt_of(db, session_id)
        except NotFound as error:
            raise NotFound(
                f"there is no session {session_id!r}",
                value=session_id,
                remedy="Its id stands at the end of the address of its page, and in sessions.csv.",
            ) from error
    text = json.dumps(receipt.as_json(), indent=2) if as_json else receipt_text(receipt)
    return text, receipt.complete
