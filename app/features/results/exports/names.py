"""Safe file names for an export: no text entered by a person can lead out of the folder."""

import re
from datetime import date

_UNSAFE = re.compile(r"[^A-Za-z0-9_-]")
MAX_CHARACTERS = 60


def safe_name(text: str) -> str:
    """Return `text` reduced to letters, digits, - and _.

    The result has at most 60 characters, is never empty and never begins with a hyphen.
    """
    return _UNSAFE.sub("_", text)[:MAX_CHARACTERS].lstrip("-") or "_"


def samples_path(participant_code: str, session_id: str) -> str:
    """Return the path, in an export, of the frames of a session."""
    return f"samples/{safe_name(participant_code)}_{safe_name(session_id)}.csv"


def fingers_path(participant_code: str, session_id: str) -> str:
    """Return the path, in an export, of the frames of a session's fingers."""
    return f"fingers/{safe_name(participant_code)}_{safe_name(session_id)}.csv"


def trackers_path(participant_code: str, session_id: str) -> str:
    """Return the path, in an export, of what the lab's trackers sent for a session."""
    return f"trackers/{safe_name(participant_code)}_{safe_name(session_id)}.csv"


def companions_path(participant_code: str, session_id: str) -> str:
    """Return the path, in an export, of the poses in which a session showed a companion."""
    return f"companions/{safe_name(participant_code)}_{safe_name(session_id)}.csv"


def road_path(participant_code: str, session_id: str, phase_id: int, part: int) -> str:
    """Return the path, in an export, of the record of a run of the study's road."""
    where = f"{safe_name(participant_code)}_{safe_name(session_id)}_{phase_id}_{part}"
    return f"road/{where}.jsonl"


def receipt_path(participant_code: str, session_id: str) -> str:
    """Return the path, in an export, of the receipt of a session."""
    return f"receipts/{safe_name(participant_code)}_{safe_name(session_id)}.json"


def archive_name(study_key: str, what: str, day: date) -> str:
    """Return the file name of an export: the study, which part of it, and the day."""
    return f"reembody_{safe_name(study_key)}_{safe_name(what)}_{day.isoformat()}.zip"
