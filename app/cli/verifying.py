"""Verifying a session from the command line."""

import json

from app.database import migrate, open_database
from app.features.receipts.service import receipt_of
from app.features.receipts.text import receipt_text
from app.settings import Settings


def verify_session(session_id: str, *, as_json: bool) -> tuple[str, bool]:
    """The receipt of a session of this installation as text or JSON, and whether it is complete.

    Reads beside a running server. Raises ReembodyError for an unknown session.
    """
    url = Settings().resolved_database_url
    migrate(url)
    database = open_database(url)
    try:
        with database.reading() as db:
            receipt = receipt_of(db, session_id)
    finally:
        database.close()
    text = json.dumps(receipt.as_json(), indent=2) if as_json else receipt_text(receipt)
    return text, receipt.complete
