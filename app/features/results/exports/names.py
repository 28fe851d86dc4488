"""File names of an export, made by us: nothing that a person typed can leave the folder."""

import re
from datetime import date

_UNSAFE = re.compile(r"[^A-Za-z0-9_-]")
MOST_CHARACTERS = 60


def safe_name(text: str) -> str:
    """`text` reduced to letters, digits, - and _, at most 60, never empty nor like an option."""
    return _UNSAFE.sub("_", text)[:MOST_CHARACTERS].lstrip("-") or "_"


def samples_path(participant_code: str, session_id: str) -> str:
    """Where the frames of a session stand in an export."""
    return f"samples/{safe_name(participant_code)}_{safe_name(session_id)}.csv"


def receipt_path(participant_code: str, session_id: str) -> str:
    """Where the receipt of a session stands in an export."""
    return f"receipts/{safe_name(participant_code)}_{safe_name(session_id)}.json"


def archive_name(study_key: str, what: str, day: date) -> str:
    """The file name of an export as one file: study, what of it, and the day it shows."""
    return f"reembody_{safe_name(study_key)}_{safe_name(what)}_{day.isoformat()}.zip"
