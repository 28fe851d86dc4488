"""The tables of what a lab's doors brought to sessions: trackers, how they lay, and companions."""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import Session

from app.features.design.studies import study_by_key
from app.features.record.companion import ENCODING as OF_COMPANIONS
from app.features.record.companion import decode_frames
from app.features.record.lab_trackers import ENCODING as OF_TRACKERS
from app.features.record.lab_trackers import decode_samples
from app.features.results.analysis.codebook import COMPANION_POSE, columns_of
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import finished, of_kind, sessions_context
from app.models import StudySession, TrackerAlignment, TrackerChunk

_WORLD = (*(f"world_{axis}_m" for axis in "xyz"), *(f"world_q{axis}" for axis in "wxyz"))
_NS_PER_S = 1e9
_S_PER_MIN = 60.0


def tracker_alignments_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per alignment of a session's trackers, or end of one, in order of time."""
    query = (
        select(TrackerAlignment)
        .join(StudySession, StudySession.id == TrackerAlignment.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(TrackerAlignment.session_id, TrackerAlignment.at, TrackerAlignment.id)
    )
    context = sessions_context(db, study_key, kind)
    own = [one.name for one in columns_of("tracker_alignments") if one.name not in context]
    rows = [_alignment(row) for row in db.scalars(query)]
    frame = pd.DataFrame(rows, columns=["session_id", *own], dtype=object)
    return finished(context.merge(frame, on="session_id"), "tracker_alignments")


def _alignment(row: TrackerAlignment) -> dict[str, Any]:
    found: dict[str, Any] = row.figures.get("alignment") or {}
    jump: dict[str, Any] = row.figures.get("jump") or {}
    mount, quality = found.get("mount", {}), found.get("quality", {})
    world = (*found.get("position_m", (None,) * 3), *found.get("rotation", (None,) * 4))
    drift = found.get("drift_m_s", (None,) * 3)
    return {
        "session_id": row.session_id,
        "changed_at_utc": row.at,
        "change": row.change,
        "client_t_s": row.client_t_s,
        "door": row.door,
        "source": row.source,
        "tracker": row.tracker,
        "delay_s": mount.get("delay_s"),
        "delay_uncertainty_s": mount.get("delay_uncertainty_s"),
        "residual_m": quality.get("residual_m"),
        "residual_p95_m": quality.get("residual_p95_m"),
        "residual_rad": quality.get("residual_rad"),
        "foot_uncertainty_m": quality.get("uncertainty_m"),
        "outliers": quality.get("outliers"),
        **dict(zip(_WORLD, world, strict=True)),
        **{
            f"drift_{axis}_m_per_min": None if one is None else one * _S_PER_MIN
            for axis, one in zip("xyz", drift, strict=True)
        },
        "reference_client_t_s": found.get("reference_s"),
        "jump_side": jump.get("side"),
        "jump_m": jump.get("offset_m"),
        "jump_rad": jump.get("offset_rad"),
    }


def has_tracker_samples(db: Session, session_id: str) -> bool:
    """Return whether anything that trackers sent is stored of a session."""
    return _has(db, session_id, OF_TRACKERS)


def has_companion_frames(db: Session, session_id: str) -> bool:
    """Return whether the participant of a session was shown a companion."""
    return _has(db, session_id, OF_COMPANIONS)


def tracker_samples(
    db: Session, session_id: str, *, simulated: bool, avatar: str
) -> Iterator[pd.DataFrame]:
    """Yield what trackers and the headset's head sent for a session, in pieces of about a second.

    The columns are those of the codebook's table `trackers`. `simulated` and `avatar` are the
    session's, which every table repeats.
    """
    for row in _chunks(db, session_id, OF_TRACKERS):
        found = decode_samples(row.trackers, row.sample_count, row.data)
        yield pd.DataFrame(
            {
                "simulated": simulated,
                "avatar": avatar,
                "door": row.door,
                "source": row.source,
                "tracker": np.array(found.trackers, dtype=object)[found.tracker],
                "tracked": found.tracked,
                "source_s": found.source_s,
                "arrival_s": found.arrival_s,
                "arrived_at_utc": _utc(row, found.arrival_s),
                "mapped_s": found.mapped_s,
                "mapped_uncertainty_s": found.uncertainty_s,
                **{f"{axis}_m": found.positions_m[:, n] for n, axis in enumerate("xyz")},
                **{f"q{axis}": found.rotations[:, n] for n, axis in enumerate("wxyz")},
            }
        )


def companion_frames(
    db: Session, session_id: str, *, simulated: bool, avatar: str
) -> Iterator[pd.DataFrame]:
    """Yield the poses of a session's companion as they were shown, in pieces of about a second.

    The columns are those of the codebook's table `companions`. `simulated` and `avatar` are the
    session's, which every table repeats.
    """
    for row in _chunks(db, session_id, OF_COMPANIONS):
        found = decode_frames(row.sample_count, row.data)
        yield pd.DataFrame(
            {
                "simulated": simulated,
                "avatar": avatar,
                "door": row.door,
                "source": row.source,
                "source_s": found.source_s,
                "arrival_s": found.arrival_s,
                "mapped_s": found.mapped_s,
                "sent_s": found.sent_s,
                "sent_at_utc": _utc(row, found.sent_s),
                **dict(zip(COMPANION_POSE, found.values.T, strict=True)),
            }
        )


def _of(session_id: str, encoding: str) -> tuple[ColumnElement[bool], ...]:
    return TrackerChunk.session_id == session_id, TrackerChunk.encoding == encoding


def _has(db: Session, session_id: str, encoding: str) -> bool:
    query = select(TrackerChunk.number).where(*_of(session_id, encoding)).limit(1)
    return db.scalar(query) is not None


def _chunks(db: Session, session_id: str, encoding: str) -> Iterable[TrackerChunk]:
    query = select(TrackerChunk).where(*_of(session_id, encoding)).order_by(TrackerChunk.number)
    return db.scalars(query.execution_options(yield_per=16))


def _utc(row: TrackerChunk, server_s: NDArray[np.float64]) -> pd.DatetimeIndex:
    """Return times of a chunk by the server's monotonic clock as times of day."""
    late_ns = np.round((server_s - row.first_s) * _NS_PER_S).astype("int64")
    return pd.Timestamp(row.first_at) + pd.to_timedelta(late_ns, unit="ns")
