"""Store the runs of a study's road: their records in pieces, and how the participant crossed."""

import hashlib
import logging
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import NotFound, NotNow, Withdrawn
from app.features.record.headset import recording_of
from app.features.record.sessions import require_capture_of
from app.models import RoadChunk, RoadCrossing, RoadRun, StudySession
from app.protocol import PARTICIPANT, StudyRoad
from app.science.cosimulation import (
    Crossing,
    Record,
    Timing,
    crossings_of,
    header_line,
    steps_of,
)

log = logging.getLogger(__name__)
INTERRUPTED = "interrupted"
REFUSED = (Withdrawn, NotNow, NotFound)
"""Why nothing may be stored: see `require_recording`; or the session was deleted with its study."""
MAX_REASON = 400


@dataclass(frozen=True)
class RunPlan:
    """What is run: see `RoadRun`."""

    id: str
    session_id: str
    phase_id: int
    part: int
    seed: int
    begins_at_s: float
    header: dict[str, Any]


def require_recording(db: Session, session: StudySession) -> None:
    """Raise unless movement of a session may be stored; lock it before storing.

    Raises:
        Withdrawn: the participant has withdrawn, or their data were erased.
        NotNow: they refuse to take part.
    """
    require_capture_of(db, session)
    if recording_of(db, session) == "refused":
        raise NotNow(
            "the participant refuses to take part: nothing of the road is stored",
            remedy="Settle the consent with the participant; then load this page again.",
        )


def next_part(db: Session, session_id: str, phase_id: int) -> int:
    """Return the number of a phase's next run."""
    count = select(func.count()).select_from(RoadRun)
    of_phase = count.where(RoadRun.session_id == session_id, RoadRun.phase_id == phase_id)
    return (db.scalar(of_phase) or 0) + 1


def store_begin(db: Session, plan: RunPlan, step_s: float, now: datetime) -> None:
    """Store that a run begins, with the first line of its record."""
    db.add(
        RoadRun(
            id=plan.id,
            session_id=plan.session_id,
            phase_id=plan.phase_id,
            part=plan.part,
            seed=plan.seed,
            begins_at_s=plan.begins_at_s,
            header=plan.header,
            began_at=now,
            ended="running",
        )
    )
    db.flush()
    store_lines(db, plan.id, plan.session_id, 0, [header_line(plan.header, step_s)])


def store_lines(
    db: Session, run_id: str, session_id: str, number: int, lines: Sequence[str]
) -> None:
    """Store the next lines of a run's record."""
    data = zlib.compress("".join(lines).encode(), 6)
    db.add(RoadChunk(run_id=run_id, number=number, session_id=session_id, data=data))
    db.flush()


def record_of(db: Session, run_id: str) -> bytes:
    """Return the bytes of a run's record, as far as they are stored."""
    rows = db.scalars(
        select(RoadChunk.data).where(RoadChunk.run_id == run_id).order_by(RoadChunk.number)
    )
    return b"".join(map(zlib.decompress, rows))


def store_end(
    db: Session, row: RoadRun, record: Record, road: StudyRoad, timing: Timing, now: datetime
) -> None:
    """Store how a run ended, and how the participant crossed in it; not the hash of its lines."""
    errors = [one.error_m for one in record.guesses if one.error_m is not None]
    row.ended = "partner lost" if record.lost else "complete"
    row.reason, row.ended_at = record.lost[:MAX_REASON], now
    row.steps, row.guesses = max(0, len(record.steps) - 1), len(record.guesses)
    row.worst_guess_m = max(errors, default=None)
    steps = sorted(timing.steps_s)
    row.timing = {
        "p50_s": steps[len(steps) // 2] if steps else None,
        "p99_s": steps[min(len(steps) - 1, int(len(steps) * 0.99))] if steps else None,
        "waited_s": dict(timing.waited_s),
    }
    db.add_all(_crossings(row, record, road))
    db.flush()


def store_interruption(
    db: Session, row: RoadRun, road: StudyRoad, reason: str, now: datetime
) -> None:
    """End a run that broke off in its middle, with what is stored of its record."""
    content = record_of(db, row.id)
    record = Record(row.header, road.step_s, steps_of(content.decode().splitlines()), (), reason)
    row.ended, row.reason, row.ended_at = INTERRUPTED, reason[:MAX_REASON], now
    row.steps, row.sha256 = max(0, len(record.steps) - 1), hashlib.sha256(content).hexdigest()
    try:
        crossings = _crossings(row, record, road)
    except Exception:
        # Else the run would go on for ever, and the server that ends it could not start.
        log.exception("the crossings of the run %s cannot be measured", row.id)
        crossings = []
    db.add_all(crossings)
    db.flush()


def _crossings(row: RoadRun, record: Record, road: StudyRoad) -> list[RoadCrossing]:
    """Return the crossings after the warm-up, in the phase's active time."""
    warm_up = round(road.warm_up_s / road.step_s)
    after = Record(record.header, record.step_s, record.steps[warm_up:], (), record.lost)
    late_s = row.begins_at_s - warm_up * road.step_s
    found = crossings_of(after, road.road.road(), PARTICIPANT)
    return [_crossing(row, number, one, late_s) for number, one in enumerate(found, start=1)]


def _crossing(row: RoadRun, number: int, one: Crossing, late_s: float) -> RoadCrossing:
    def active_s(scene_s: float | None) -> float | None:
        return None if scene_s is None else round(scene_s + late_s, 6)

    hit = one.collision
    return RoadCrossing(
        run_id=row.id,
        number=number,
        session_id=row.session_id,
        phase_id=row.phase_id,
        steps_on_s=active_s(one.steps_on_s),
        steps_off_s=active_s(one.steps_off_s),
        is_across=one.is_across,
        waited_s=one.waited_s,
        gap_accepted_s=one.gap_accepted_s,
        gaps_refused_s=list(one.gaps_refused_s),
        least_time_to_collision_s=one.least_time_to_collision_s,
        least_post_encroachment_s=one.least_post_encroachment_s,
        closest_m=one.closest_m,
        collision_car=None if hit is None else hit.car,
        collision_s=None if hit is None else active_s(hit.time_s),
        collision_speed_m_s=None if hit is None else hit.car_speed_m_s,
    )
