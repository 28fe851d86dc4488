"""The poses in which a session's participant was shown a companion."""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import Session

from app.features.record.companion import ENCODING, decode_frames
from app.features.results.analysis.codebook import COMPANION_POSE
from app.models import TrackerChunk

_NS_PER_S = 1e9


def has_companion_frames(db: Session, session_id: str) -> bool:
    """Return whether the participant of a session was shown a companion."""
    query = select(TrackerChunk.number).where(*_shown(session_id)).limit(1)
    return db.scalar(query) is not None


def companion_frames(
    db: Session, session_id: str, *, simulated: bool, avatar: str
) -> Iterator[pd.DataFrame]:
    """Yield the poses of a session's companion as they were shown, in pieces of about a second.

    The columns are those of the codebook's table `companions`. `simulated` and `avatar` are the
    session's, which every table repeats.
    """
    query = select(TrackerChunk).where(*_shown(session_id)).order_by(TrackerChunk.number)
    for row in db.scalars(query.execution_options(yield_per=16)):
        found = decode_frames(row.sample_count, row.data)
        late_ns = np.round((found.sent_s - row.first_s) * _NS_PER_S).astype("int64")
        frame = {
            "simulated": simulated,
            "avatar": avatar,
            "door": row.door,
            "source": row.source,
            "source_s": found.source_s,
            "arrival_s": found.arrival_s,
            "mapped_s": found.mapped_s,
            "sent_s": found.sent_s,
            "sent_at_utc": pd.Timestamp(row.first_at) + pd.to_timedelta(late_ns, unit="ns"),
            **dict(zip(COMPANION_POSE, found.values.T, strict=True)),
        }
        yield pd.DataFrame(frame)


def _shown(session_id: str) -> tuple[ColumnElement[bool], ...]:
    return TrackerChunk.session_id == session_id, TrackerChunk.encoding == ENCODING
