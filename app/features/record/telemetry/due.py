"""Combine the batches that are due into chunks of about a second.

A stream is due when its oldest batch has waited a little over a second. So the work for many
sessions is spread over time instead of coming in one burst per second.
"""

import logging
from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta
from typing import Any, NamedTuple, cast

import numpy as np
from sqlalchemy import Table, func, select
from sqlalchemy.orm import Session

from app.features.record.telemetry.encoding import ENCODING, encode_frames
from app.models import TelemetryBatch
from app.wire import Batch, MalformedBatchError, decode_batch

log = logging.getLogger(__name__)
CHUNK_S = 1.0
DUE_AFTER = timedelta(seconds=1.2)
QUIET_AFTER = timedelta(seconds=3)
"""After this long without a batch, the rest of a stream is put into a shorter chunk."""
STREAMS_PER_TURN = 20
BATCHES_PER_STREAM = 150
BATCHES = cast("Table", TelemetryBatch.__table__)
KEY = ("session_id", "stream", "epoch")
Chunks = list[dict[str, Any]]
"""Rows of the table of chunks, each with `batches`: how many batches it replaces."""


class Waiting(NamedTuple):
    """A stored batch that is not in a chunk yet, with its decoded content."""

    received_at: datetime
    phase_id: int
    seq_first: int
    frame_count: int
    batch: Batch

    @property
    def seq_end(self) -> int:
        """Return one past the batch's last seq."""
        return self.seq_first + self.frame_count


def due_chunks(db: Session, now: datetime) -> Chunks:
    """Return the chunks that are due, of up to `STREAMS_PER_TURN` streams."""
    return [chunk for key in _due(db, now) for chunk in _sound_chunks(db, key, now)]


def _due(db: Session, now: datetime) -> list[dict[str, Any]]:
    """Return the keys of the streams whose oldest batch has waited long enough."""
    key = [BATCHES.c[name] for name in KEY]
    query = (
        select(*key)
        .where(BATCHES.c.received_at < now - DUE_AFTER)
        .group_by(*key)
        .order_by(func.min(BATCHES.c.received_at))
        .limit(STREAMS_PER_TURN)
    )
    return [dict(row) for row in db.execute(query).mappings()]


def _sound_chunks(db: Session, key: dict[str, Any], now: datetime) -> list[dict[str, Any]]:
    """Return the due chunks of a stream; none if one of its batches is damaged.

    The batches of such a stream stay as they are.
    """
    try:
        return _chunks_of(db, key, now)
    except MalformedBatchError as error:
        log.error("a stored batch of %s is damaged: %s", key, error)
        return []


def _chunks_of(db: Session, key: dict[str, Any], now: datetime) -> list[dict[str, Any]]:
    rows = db.execute(
        select(
            BATCHES.c.received_at,
            BATCHES.c.phase_id,
            BATCHES.c.seq_first,
            BATCHES.c.frame_count,
            BATCHES.c.message,
        )
        .where(*(BATCHES.c[name] == value for name, value in key.items()))
        .order_by(BATCHES.c.seq_first)
        .limit(BATCHES_PER_STREAM)
    )
    waiting = [Waiting(*row[:4], decode_batch(row[4])) for row in rows]
    pieces = list(_cut(waiting))
    if pieces and pieces[-1][-1].received_at >= now - QUIET_AFTER:
        pieces.pop()  # more batches of this chunk are still to come
    return [{**key, **_chunk(piece)} for piece in pieces]


def _cut(waiting: Sequence[Waiting]) -> Iterator[list[Waiting]]:
    """Group batches of one phase without a gap, each group about a second long."""
    pending: list[Waiting] = []
    for one in waiting:
        if pending and not _belongs(pending, one):
            yield pending
            pending = []
        pending.append(one)
    if pending:
        yield pending


def _belongs(pending: Sequence[Waiting], one: Waiting) -> bool:
    first, last = pending[0], pending[-1]
    spans_s = float(one.batch.times_s[-1]) - float(first.batch.times_s[0])
    same = one.phase_id == last.phase_id and one.seq_first == last.seq_end
    return same and not spans_s > CHUNK_S


def _chunk(piece: Sequence[Waiting]) -> dict[str, Any]:
    first = piece[0]
    times_s = np.concatenate([one.batch.times_s for one in piece])
    flags = np.concatenate([one.batch.flags for one in piece])
    values = np.concatenate([one.batch.values for one in piece])
    # Invalid times stay in the data, but are left out of the index.
    finite_s = times_s[np.isfinite(times_s)]
    return {
        "batches": len(piece),
        "seq_first": first.seq_first,
        "frame_count": len(times_s),
        "phase_id": first.phase_id,
        "values_per_frame": values.shape[1],
        "t_first_s": float(finite_s.min()) if len(finite_s) else 0.0,
        "t_last_s": float(finite_s.max()) if len(finite_s) else 0.0,
        "encoding": ENCODING,
        "data": encode_frames(times_s, flags, values),
    }
