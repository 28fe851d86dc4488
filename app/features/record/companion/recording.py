"""Store in which poses a companion was shown to a session's participant."""

from datetime import datetime, timedelta
from itertools import groupby

from sqlalchemy.orm import Session

from app.features.record.companion.frames import ENCODING, ShownFrame, encode_frames
from app.features.record.lab_trackers import next_number
from app.features.record.sessions import Companion
from app.models import TrackerChunk
from app.science.skeleton import JOINT_NAMES

MAX_WAITING = 40_000
"""The most poses of a session that wait for the disk: minutes of a companion."""
ShownPose = tuple[Companion, ShownFrame]
"""Whom a participant was shown, and in which pose."""


def store_frames(
    db: Session, session_id: str, frames: list[ShownPose], *, now: datetime, now_s: float
) -> int:
    """Store poses as a chunk of each companion and sender; return how many there were.

    `now` and `now_s` are the same moment, by the time of day and by the server's monotonic clock.
    """
    number = next_number(db, session_id)
    parts = groupby(frames, lambda one: (one[0].door, one[0].source, one[1].address))
    for at, ((door, source, address), part) in enumerate(parts):
        group = [frame for _, frame in part]
        db.add(
            TrackerChunk(
                session_id=session_id,
                number=number + at,
                door=door,
                source=source,
                address=address,
                first_s=group[0].sent_s,
                last_s=group[-1].sent_s,
                first_at=now - timedelta(seconds=now_s - group[0].sent_s),
                sample_count=len(group),
                trackers=list(JOINT_NAMES),
                encoding=ENCODING,
                data=encode_frames(group),
            )
        )
    db.flush()
    return len(frames)
