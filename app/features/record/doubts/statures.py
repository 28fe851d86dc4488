"""Read the statures that held in each phase: the participant's, calibrations', worn bodies'.

Models of avatars are long, and there may be thousands, so of each only the stature is kept, once it
was read.
"""

import json
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any, NamedTuple

from sqlalchemy import ColumnElement, func, select
from sqlalchemy.orm import Session

from app.features.record.doubts.laws import Stature
from app.features.record.sessions import (
    AVATAR,
    AVATAR_EVENTS,
    CALIBRATION,
    avatars_of_phase,
    content_body,
)
from app.models import Phase, SessionContent, SessionEvent, StudySession
from app.platform.immutable_cache import ImmutableCache

HEIGHT = "height"
PARTICIPANT, CALIBRATED, WORN = "the participant", "the calibration", "a body that was worn"
TAIL = 64
"""How many characters at the end of a stored avatar are read; keys are in alphabetical order."""
_STATURES: ImmutableCache[str, float | None] = ImmutableCache(20_000)


def read_statures(
    db: Session, chosen: ColumnElement[bool], phases: Sequence[Phase]
) -> dict[tuple[str, int], tuple[Stature, ...]]:
    """Return the statures of phases of the `chosen` sessions, by session and phase id."""
    of_chosen = SessionContent.session_id.in_(select(StudySession.id).where(chosen))
    small = select(SessionContent).where(of_chosen, SessionContent.kind.in_((HEIGHT, CALIBRATION)))
    measured: dict[str, list[_Measured]] = defaultdict(list)
    for row in db.scalars(small.order_by(SessionContent.created_at, SessionContent.id)):
        if isinstance(body := content_body(row), Mapping):
            measured[row.session_id].append(_Measured(row.kind, row.created_at, body))
    # What was erased has no stature any more, whatever was read before.
    kept = select(SessionContent.id).where(
        of_chosen, SessionContent.kind == AVATAR, SessionContent.salt.is_not(None)
    )
    avatars = set(db.scalars(kept))
    logs: dict[str, list[SessionEvent]] = defaultdict(list)
    if avatars:
        events = select(SessionEvent).where(
            SessionEvent.session_id.in_(select(StudySession.id).where(chosen)),
            SessionEvent.type.in_(AVATAR_EVENTS),
        )
        for event in db.scalars(events.order_by(SessionEvent.session_id, SessionEvent.seq)):
            logs[event.session_id].append(event)
    found: dict[tuple[str, int], tuple[Stature, ...]] = {}
    for phase in phases:
        worn = [
            Stature(WORN, stature_m)
            for one in avatars_of_phase(logs[phase.session_id], phase.phase_id, phase.body)
            if one.content_id in avatars
            and (stature_m := _built_for(db, one.content_id)) is not None
        ]
        own = (*_of_participant(measured[phase.session_id], phase), *worn)
        if own:
            found[phase.session_id, phase.phase_id] = own
    return found


class _Measured(NamedTuple):
    """A height or a calibration: what was stored of it, and when."""

    kind: str
    at: datetime
    body: Mapping[str, Any]


def _of_participant(measured: Sequence[_Measured], phase: Phase) -> list[Stature]:
    """Return the participant's height, and the calibrations from the phase's beginning to its end.

    Of those before the phase only the newest counts: a calibration corrects the one before.
    """
    began, ended = phase.started_at or phase.prepared_at, phase.ended_at
    height: Stature | None = None
    before: Stature | None = None
    during: list[Stature] = []
    for kind, at, body in measured:
        if kind == HEIGHT:
            height = _stature(PARTICIPANT, body.get("matched") or body.get("stated")) or height
        elif (one := _stature(CALIBRATED, body.get("stature_m"))) is not None:
            if at <= began:
                before = one
            elif ended is None or at <= ended:
                during.append(one)
    return [one for one in (height, before, *during) if one is not None]


def _stature(whose: str, stature_m: object) -> Stature | None:
    return Stature(whose, float(stature_m)) if isinstance(stature_m, int | float) else None


def _built_for(db: Session, content_id: str) -> float | None:
    """Return the stature for which an avatar was built; None if its content does not say so."""
    body = SessionContent.body
    tail = select(func.substr(body, func.length(body) - TAIL)).where(
        SessionContent.id == content_id
    )

    def read() -> float | None:
        found = re.search(r'"stature_m": ([0-9.]+)}$', db.scalar(tail) or "")
        if found is not None:
            return float(found[1])
        text = db.scalar(select(body).where(SessionContent.id == content_id))
        one = _stature(WORN, json.loads(text or "{}").get("stature_m"))
        return None if one is None else one.stature_m

    return _STATURES.get(db, content_id, read)
