"""Folding batches into chunks of about a second, stream by stream, as each becomes due.

A stream is due when its oldest batch has waited a little over a second. So the work of many
sessions spreads over time instead of coming in one burst a second. A reader merges both, so it
never matters when this runs.
"""

import logging
import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Any, NamedTuple, cast

import numpy as np
from sqlalchemy import Table, bindparam, delete, func, insert, select
from sqlalchemy.orm import Session

from app.features.context import AppContext
from app.features.telemetry.checkpoints import Checkpointer
from app.features.telemetry.encoding import ENCODING, encode_frames
from app.models import TelemetryBatch, TelemetryChunk
from app.wire import Batch, MalformedBatchError, decode_batch

log = logging.getLogger(__name__)
CHUNK_S = 1.0
DUE_AFTER = timedelta(seconds=1.2)
QUIET_AFTER = timedelta(seconds=3)
"""A stream that has been quiet for so long gets its last, shorter chunk."""
TURN_S = 0.1
STREAMS_PER_TURN = 20
BATCHES_PER_STREAM = 150
BATCHES = cast("Table", TelemetryBatch.__table__)
CHUNKS = cast("Table", TelemetryChunk.__table__)


class BatchesChanged(RuntimeError):
    """What was to be folded is not what is stored any more; the next turn looks anew."""


class Waiting(NamedTuple):
    """A batch as it lies in its table, with its decoded content."""

    received_at: datetime
    phase_id: int
    seq_first: int
    frame_count: int
    batch: Batch

    @property
    def seq_end(self) -> int:
        """One past its last seq."""
        return self.seq_first + self.frame_count


@dataclass
class Folder:
    """Folds in the background. `start` once, `stop` at the end."""

    context: AppContext
    _stop: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None

    def start(self) -> None:
        """Begin to fold."""
        self._thread = threading.Thread(target=self._run, name="telemetry-folder", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """End after the turn under way."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(timeout=10.0)

    def _run(self) -> None:
        checkpoints = Checkpointer(self.context.database)
        while not self._stop.wait(TURN_S):
            try:
                while self.fold_once() and not self._stop.is_set():
                    pass
                checkpoints.turn()
            except Exception:  # the next turn tries again; nothing is lost meanwhile
                log.exception("batches could not be folded; they stay as they are")
                self._stop.wait(1.0)

    def fold_once(self) -> int:
        """Fold the streams that are due, up to a turn's worth; how many batches that were."""
        now = self.context.clock.utc_now()
        # Compress before the writing turn: telemetry waits for it.
        with self.context.database.reading() as db:
            chunks = [chunk for key in _due(db, now) for chunk in _sound_chunks(db, key, now)]
        if chunks:
            with self.context.database.writing() as db:
                _replace(db, chunks)
        return sum(chunk["batches"] for chunk in chunks)


_KEY = ("session_id", "stream", "epoch")
_DELETE = delete(BATCHES).where(
    *(BATCHES.c[name] == bindparam(f"key_{name}") for name in _KEY),
    BATCHES.c.seq_first >= bindparam("seq_from"),
    BATCHES.c.seq_first < bindparam("seq_end"),
)


def _due(db: Session, now: datetime) -> list[dict[str, Any]]:
    """The streams with a full chunk, or with a rest that nothing has followed for a while."""
    key = [BATCHES.c[name] for name in _KEY]
    oldest, newest = func.min(BATCHES.c.received_at), func.max(BATCHES.c.received_at)
    query = (
        select(*key)
        .group_by(*key)
        .having((oldest < now - DUE_AFTER) | (newest < now - QUIET_AFTER))
        .order_by(oldest)
        .limit(STREAMS_PER_TURN)
    )
    return [dict(row) for row in db.execute(query).mappings()]


def _sound_chunks(db: Session, key: dict[str, Any], now: datetime) -> list[dict[str, Any]]:
    """The chunks of a stream; none, if a batch of it can no longer be read: it stays as it is."""
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
        pieces.pop()  # more of this chunk is still to come
    return [{**key, **_chunk(piece)} for piece in pieces]


def _cut(waiting: Sequence[Waiting]) -> Iterator[list[Waiting]]:
    """Runs of one phase without a hole, each about a second long."""
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
    # Broken times stay in the data; the index spans the others.
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


def _replace(db: Session, chunks: Sequence[dict[str, Any]]) -> None:
    """Store chunks and delete the batches they hold; nothing, if these are no longer there.

    A backup may have been restored since they were read.
    """
    columns = CHUNKS.c.keys()
    db.execute(insert(CHUNKS), [{name: chunk[name] for name in columns} for chunk in chunks])
    deleted = db.connection().execute(
        _DELETE,
        [
            {
                **{f"key_{name}": chunk[name] for name in _KEY},
                "seq_from": chunk["seq_first"],
                "seq_end": chunk["seq_first"] + chunk["frame_count"],
            }
            for chunk in chunks
        ],
    )
    expected = sum(chunk["batches"] for chunk in chunks)
    if deleted.rowcount != expected:
        raise BatchesChanged(f"{deleted.rowcount} of {expected} batches were there to be folded")
