"""Decide which phases may be replayed, by whom, and with or without the avatar.

A phase can be replayed once it is over. Blinded readers see the participant's own movement and
nothing of the avatar: both together, or contacts together with the movement that led to them,
would reveal the latency.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app import __version__
from app.errors import Gone, NotFound, NotNow
from app.features.record.headset import participant_info
from app.features.record.sessions import (
    avatar_of_phase,
    erased_session,
    newest_calibration,
    protocol_of_session,
)
from app.features.results.replay.schemas import View
from app.models import Phase, StudySession, TelemetryBatch, TelemetryChunk
from app.platform.access import Caller, is_blind, session_by_id
from app.science.skeleton import Skeleton, SkeletonError, build_skeleton

OVER = ("done", "voided")
USUAL_STATURE_M = 1.7
"""Stature of the body that is drawn if the participant's is unknown."""


@dataclass(frozen=True)
class Replayable:
    """A phase that the caller may replay, and the view that they may see."""

    session: StudySession
    phase: Phase
    view: View

    @property
    def full(self) -> bool:
        """Return whether the view includes the avatar and its contacts."""
        return self.view == "full"


def replayable(db: Session, caller: Caller, session_id: str, phase_id: int) -> Replayable:
    """Return the phase, if the caller may replay it.

    Raises NotFound if there is no such phase, Gone if its data were erased, NotNow before it is
    over.
    """
    session = session_by_id(db, session_id)
    if erased_session(db, session_id):
        raise Gone(
            "the data of this session's participant were erased",
            value=session_id,
            remedy="There is nothing left to replay; the session's page says why.",
        )
    phase = db.get(Phase, (session_id, phase_id))
    if phase is None:
        phase_ids = select(Phase.phase_id).where(Phase.session_id == session_id)
        raise NotFound(
            f"this session has no phase {phase_id}",
            value=phase_id,
            valid=list(db.scalars(phase_ids.order_by(Phase.phase_id))),
            remedy="Choose a phase on the session's page.",
        )
    if phase.status not in OVER:
        raise NotNow(
            "this phase has not ended yet",
            value=phase.status,
            valid=list(OVER),
            remedy="Watch it on the session's page; it can be replayed as soon as it has ended.",
        )
    blind = is_blind(db, caller, protocol_of_session(db, session), session)
    return Replayable(session, phase, "participant" if blind else "full")


@dataclass(frozen=True)
class ReplayedBody:
    """The lengths of the body that a phase is replayed with.

    `stature_m` is None if neither an avatar nor the participant's is known. `segments_m`: measured
    lengths by the names of an avatar's segments.
    """

    stature_m: float | None
    segments_m: Mapping[str, float]

    def skeleton(self) -> Skeleton:
        """Return its skeleton; of the usual proportions where no skeleton has its lengths."""
        stature_m = self.stature_m or USUAL_STATURE_M
        try:
            return build_skeleton(stature_m, self.segments_m)
        except SkeletonError:
            return build_skeleton(stature_m)


def body_of(db: Session, session: StudySession, phase: Phase, *, full: bool) -> ReplayedBody:
    """Return the body shown in a phase; without a record of it, the participant's.

    It is that of the avatar that the phase began with: one that is built later changes nothing
    about a movement that was recorded before. A reader who may not see the avatar (not `full`)
    gets that of the configuration's body, because another one could tell which body was worn.
    A session without a physics avatar shows the arms of the calibration that the phase began with.
    """
    own = (phase.body, None) if full else (None,)
    found = (avatar_of_phase(db, session.id, phase.phase_id, body) for body in own)
    avatar: Mapping[str, Any] | None = next((one for one in found if one is not None), None)
    if avatar is None:
        measured = newest_calibration(db, session, before=phase.started_at)
        segments_m = {} if measured is None else measured.report.get("segments_m", {})
        return ReplayedBody(participant_info(db, session).stature_m, segments_m)
    built_m = avatar.get("stature_m")
    stature_m = built_m if isinstance(built_m, float) else participant_info(db, session).stature_m
    return ReplayedBody(stature_m, avatar.get("segments_m", {}))


def frames_stored(db: Session, phase: Phase) -> int:
    """Return the number of frames of both bodies that are stored for a phase."""
    total = 0
    for table in (TelemetryChunk, TelemetryBatch):
        of_phase = (table.session_id == phase.session_id, table.phase_id == phase.phase_id)
        counted = select(func.coalesce(func.sum(table.frame_count), 0)).where(*of_phase)
        total += int(db.scalar(counted) or 0)
    return total


def movement_tag(db: Session, phase_view: Replayable) -> str:
    """Return an entity tag, with its quotes, that changes whenever the movement may change."""
    phase = phase_view.phase
    state = (
        *(phase.session_id, phase.phase_id, phase.status, phase.active_s, frames_stored(db, phase)),
        *(
            _lengths(body_of(db, phase_view.session, phase, full=phase_view.full)),
            phase_view.view,
            __version__,
        ),
    )
    return f'"{hashlib.sha256(repr(state).encode()).hexdigest()[:32]}"'


def _lengths(body: ReplayedBody) -> tuple[float | None, tuple[tuple[str, float], ...]]:
    return body.stature_m, tuple(sorted(body.segments_m.items()))
