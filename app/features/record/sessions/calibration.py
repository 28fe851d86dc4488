"""The newest calibration of a session's headset, and what the operator ordered since."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy.orm import Session

from app.features.record.sessions.contents import content_body, contents_of
from app.models import StudySession

CALIBRATION = "calibration"
"""The kind of stored content for what a headset measured of the participant."""


@dataclass(frozen=True)
class Calibration:
    """A calibration as the headset reported it (`app.wire.CalibrationReport`), and when."""

    at: datetime
    report: Mapping[str, Any]


def newest_calibration(
    db: Session, session: StudySession, *, before: datetime | None = None
) -> Calibration | None:
    """Return the newest calibration; None before the first, and once it was erased.

    `before`: only those that had been made then.
    """
    found: Calibration | None = None
    for row in contents_of(db, session.id, CALIBRATION):
        if before is not None and row.created_at > before:
            continue
        body = content_body(row)
        if isinstance(body, dict):
            found = Calibration(row.created_at, body)
    return found
