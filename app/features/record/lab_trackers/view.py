"""Show the trackers that a session's headset uses, in the units of the lab's page."""

import math
from typing import Literal

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.movement.live import DoorKey, LiveTracking
from app.features.record.lab_trackers.link import REFERENCE, TrackerLink
from app.features.record.lab_trackers.schemas import (
    AlignmentView,
    DoubledLimb,
    LookedAround,
    SessionBehindDoor,
    SessionTrackers,
    SourceChoice,
    WornTracker,
)
from app.features.record.lab_trackers.service import LabTrackers
from app.features.record.sessions import state_of
from app.models import Participant, StudySession
from app.platform.context import AppContext
from app.science.alignment import Alignment, Looking
from app.wire import GOALS

_MM_PER_M = 1000.0
_MS_PER_S = 1000.0
_S_PER_MIN = 60.0


def session_trackers(db: Session, context: AppContext, session: StudySession) -> SessionTrackers:
    """Return the trackers that a session's headset uses, and those that it could use."""
    chosen = state_of(session).trackers
    shown = SessionTrackers(
        door=None if chosen is None else chosen.door,
        source=None if chosen is None else chosen.source,
        choices=_choices(db, context),
        status=None,
        state=session.status,
    )
    followed = context.part(LabTrackers).followed(session.id)
    if followed is None:
        return shown
    now_s = context.clock.monotonic_ns() / 1e9
    link = followed.link
    step = link.step()
    alignment = None if step is None else step.watched.alignment
    latencies = link.latencies_s()
    return shown.model_copy(
        update={
            "status": link.status(now_s),
            "problem": None if step is None else step.problem,
            "looking": None if step is None or step.looking is None else _looking(step.looking),
            "alignment": None if alignment is None else alignment_view(alignment, link, now_s),
            "trackers": [
                WornTracker(
                    tracker=one.tracker,
                    limb=one.limb,
                    used=one.is_used,
                    tracked=one.tracked,
                    silent_s=one.silent_s,
                )
                for one in link.trackers(now_s)
            ],
            "others": link.others(now_s),
            "doubled": [
                DoubledLimb(limb=limb, trackers=trackers)
                for limb, trackers in link.doubled(now_s).items()
            ],
            "latency_ms": _ms(latencies, 50.0),
            "latency_p95_ms": _ms(latencies, 95.0),
            "stored": followed.waiting.stored,
            "waiting_lost": followed.waiting.lost,
            "refits": followed.refits,
            "jumps": followed.jumps,
        }
    )


def sessions_behind(db: Session, door: DoorKey) -> list[SessionBehindDoor]:
    """Return the sessions that lose something once a door is closed, the oldest first."""
    rows = db.execute(
        select(StudySession, Participant.code)
        .join(Participant, Participant.id == StudySession.participant_id)
        .where(StudySession.status.in_(("planned", "active")))
        .order_by(StudySession.created_at, StudySession.id)
    )
    found = []
    for session, code in rows:
        state = state_of(session)
        uses: list[Literal["trackers", "companion"]] = []
        if state.trackers is not None and state.trackers.door == door:
            uses.append("trackers")
        if state.companion is not None and state.companion.door == door:
            uses.append("companion")
        if uses:
            found.append(SessionBehindDoor(session_id=session.id, participant_code=code, uses=uses))
    return found


def alignment_view(alignment: Alignment, link: TrackerLink, now_s: float) -> AlignmentView:
    """Return the figures of an alignment."""
    mount, quality = alignment.mount, alignment.quality
    headset_s = link.headset_s(now_s)
    return AlignmentView(
        delay_ms=_MS_PER_S * mount.delay_s,
        delay_uncertainty_ms=_MS_PER_S * mount.delay_uncertainty_s,
        residual_mm=_MM_PER_M * quality.residual_m,
        residual_p95_mm=_MM_PER_M * quality.residual_p95_m,
        residual_deg=math.degrees(quality.residual_rad),
        foot_mm=_MM_PER_M * quality.uncertainty_m,
        drift_mm_min=_MM_PER_M * _S_PER_MIN * float(np.linalg.norm(alignment.drift_m_s)),
        outliers=quality.outliers,
        fitted_s=max(0.0, headset_s - alignment.end_s),
    )


def _choices(db: Session, context: AppContext) -> list[SourceChoice]:
    found: dict[tuple[str, str], SourceChoice] = {}
    for one in context.part(LiveTracking).view(db).sources:
        worn = [each.limb for each in one.trackers if each.limb in GOALS]
        key = (one.door, one.name)
        if key in found and not found[key].is_silent:
            continue
        found[key] = SourceChoice(
            door=one.door,
            source=one.name,
            is_silent=one.is_silent,
            limbs=len(worn) - worn.count(REFERENCE),
            has_reference=REFERENCE in worn,
        )
    return list(found.values())


def _looking(found: Looking) -> LookedAround:
    return LookedAround(
        turn_deg=math.degrees(found.turn_rad),
        nod_deg=math.degrees(found.nod_rad),
        progress=found.progress,
    )


def _ms(latencies_s: list[float], percentile: float) -> float | None:
    return _MS_PER_S * float(np.percentile(latencies_s, percentile)) if latencies_s else None
