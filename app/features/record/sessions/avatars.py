"""The physics avatars that were built for a session, and which of them a phase shows."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session

from app.features.record.sessions.contents import content_body
from app.features.record.sessions.journal import events_of
from app.models import SessionContent, SessionEvent

AVATAR = "avatar"
"""The kind of stored content that contains a physics avatar's model."""


@dataclass(frozen=True)
class BuiltAvatar:
    """An avatar that was built, by its content; `body`: its name, None for the configuration's."""

    body: str | None
    content_id: str


def avatars_of_phase(
    log: Iterable[SessionEvent], phase_id: int, body: str | None
) -> tuple[BuiltAvatar, ...]:
    """Return the avatars of a phase in which `body` is worn: that it began with, and later ones.

    A phase shows the newest avatar of its body that was built before its clock started. One that is
    built while it runs, after a calibration in its middle, follows. What is built after the phase,
    or after the session, was never shown in it. If none was built in time, there is none.

    `log` is the event log of one session from its start, or of it the `AVATAR_EVENTS`.
    """
    first: BuiltAvatar | None = None
    later: list[BuiltAvatar] = []
    has_started = False
    for row in log:
        if row.type not in AVATAR_EVENTS:
            continue
        event = json.loads(row.payload)
        is_own = event.get("phase_id") == phase_id
        if row.type == "avatar_built" and event.get("body") == body:
            built = BuiltAvatar(body, event["content_id"])
            if has_started:
                later.append(built)
            else:
                first = built
        elif row.type == "phase_started" and is_own:
            has_started = True
        elif row.type == "session_ended" or (row.type in _ENDS and is_own):
            break
    return (*((first,) if first else ()), *later)


_ENDS = ("phase_ended", "phase_voided")
AVATAR_EVENTS = ("avatar_built", "phase_started", "session_ended", *_ENDS)
"""The types of the events that decide which avatar a phase shows."""


def avatar_of_phase(
    db: Session, session_id: str, phase_id: int, body: str | None
) -> Mapping[str, Any] | None:
    """Return what was recorded of the avatar that a phase began with; None if there is nothing.

    It has `stature_m`, `segments_m`, `model_hash` and `mjcf`. There is nothing for a delayed copy,
    for a phase before any avatar was built, and after an erasure.
    """
    for built in avatars_of_phase(events_of(db, session_id), phase_id, body)[:1]:
        row = db.get(SessionContent, built.content_id)
        found = None if row is None else content_body(row)
        return found if isinstance(found, dict) else None
    return None
