"""Store what the trackers and the head of a session sent, and how the worlds lay."""

from dataclasses import asdict
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.features.movement.live import Sample
from app.features.record.lab_trackers.samples import ENCODING, encode_samples
from app.features.record.sessions import ReportAlignment, apply_command, state_of
from app.models import StudySession, TrackerAlignment, TrackerChunk, new_id
from app.platform.context import AppContext
from app.science.alignment import Alignment, Jump, Watched

MAX_WAITING = 400_000
"""The most samples of a session that wait for the disk: minutes of the busiest source."""


def next_number(db: Session, session_id: str) -> int:
    """Return the number of a session's next chunk."""
    newest = select(func.max(TrackerChunk.number)).where(TrackerChunk.session_id == session_id)
    return (db.scalar(newest) or 0) + 1


def store_samples(
    db: Session, session_id: str, samples: list[Sample], *, now: datetime, now_s: float
) -> int:
    """Store samples as a chunk of each source; return how many poses there were.

    `now` and `now_s` are the same moment, by the time of day and by the server's monotonic clock.
    """
    groups: dict[tuple[str, str, str], list[Sample]] = {}
    for one in samples:
        groups.setdefault((one.door, one.source, one.address), []).append(one)
    first, stored = next_number(db, session_id), 0
    for number, ((door, source, address), group) in enumerate(groups.items(), start=first):
        trackers, count, data = encode_samples(group)
        stored += count
        db.add(
            TrackerChunk(
                session_id=session_id,
                number=number,
                door=door,
                source=source,
                address=address,
                first_s=group[0].arrival_s,
                last_s=group[-1].arrival_s,
                first_at=now - timedelta(seconds=now_s - group[0].arrival_s),
                sample_count=count,
                trackers=trackers,
                encoding=ENCODING,
                data=data,
            )
        )
    db.flush()
    return stored


def store_change(
    db: Session,
    context: AppContext,
    session: StudySession,
    watched: Watched,
    *,
    place: tuple[str, str, str],
) -> None:
    """Store what a step of watching changed, and all but a refit as an event of the session.

    A refit comes every few seconds, so as events they would hide all others. `place`: the door, the
    source, and the tracker on the head. `session` must have been read with `lock=True`.
    """
    alignment, jump, change = watched.alignment, watched.jump, watched.change
    if change is None or recording_ends(session):
        return
    client_t_s = jump.time_s if jump is not None and change != "recentred" else watched.fitted_s
    door, source, tracker = place
    row = TrackerAlignment(
        id=new_id(),
        session_id=session.id,
        at=context.clock.utc_now(),
        change=change,
        client_t_s=client_t_s,
        door=door,
        source=source,
        tracker=tracker,
        figures={"alignment": _figures(alignment), "jump": _figures(jump)},
    )
    db.add(row)
    db.flush()
    if change == "refit":
        return
    known = alignment if change in ("first", "recentred") else None
    command = ReportAlignment(
        change=change,
        alignment_id=row.id,
        client_t_s=client_t_s,
        delay_s=None if known is None else known.mount.delay_s,
        residual_m=None if known is None else known.quality.residual_m,
        uncertainty_m=None if known is None else known.quality.uncertainty_m,
        offset_m=None if jump is None else jump.offset_m,
        offset_rad=None if jump is None else jump.offset_rad,
    )
    apply_command(db, context, session, command, actor="system")


def recording_ends(session: StudySession) -> bool:
    """Return whether nothing more may be stored about a session's trackers."""
    state = state_of(session)
    return state.erased or state.trackers is None


def _figures(found: Alignment | Jump | None) -> dict[str, Any] | None:
    return None if found is None else _plain(asdict(found))


def _plain(value: Any) -> Any:
    """Return arrays as lists, in whatever they are."""
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return value.tolist() if hasattr(value, "tolist") else value
