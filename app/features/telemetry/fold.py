"""Folding batches that are older than a second into chunks, one transaction at a time.

A reader merges both, so it never matters when this runs.
"""

import logging
import threading
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import timedelta
from itertools import groupby

import numpy as np
from sqlalchemy import delete, select, tuple_
from sqlalchemy.orm import Session

from app.features.context import AppContext
from app.features.telemetry.encoding import ENCODING, encode_frames
from app.models import TelemetryBatch, TelemetryChunk
from app.wire import Batch, decode_batch

log = logging.getLogger(__name__)
BATCHES_PER_TURN = 400
CHUNK_S = 1.0


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
        while not self._stop.wait(1.0):
            try:
                while self.fold_once() == BATCHES_PER_TURN and not self._stop.is_set():
                    pass
            except Exception:  # the next turn tries again; nothing is lost meanwhile
                log.exception("batches could not be folded; they stay as they are")

    def fold_once(self) -> int:
        """Fold up to BATCHES_PER_TURN batches; how many there were."""
        before = self.context.clock.utc_now() - timedelta(seconds=1)
        with self.context.database.reading() as db:
            due = list(
                db.scalars(
                    select(TelemetryBatch)
                    .where(TelemetryBatch.received_at < before)
                    .order_by(
                        TelemetryBatch.session_id,
                        TelemetryBatch.stream,
                        TelemetryBatch.epoch,
                        TelemetryBatch.seq_first,
                    )
                    .limit(BATCHES_PER_TURN)
                )
            )
            # Compress before the writing turn: telemetry waits for it.
            chunks = [chunk for run in _runs(due) for chunk in _chunks(run)]
        if due:
            with self.context.database.writing() as db:
                _replace(db, due, chunks)
        return len(due)


def _runs(batches: Sequence[TelemetryBatch]) -> list[list[TelemetryBatch]]:
    """Group into runs of one stream, epoch and phase."""
    groups = groupby(batches, key=lambda b: (b.session_id, b.stream, b.epoch, b.phase_id))
    return [list(group) for _, group in groups]


def _chunks(run: Sequence[TelemetryBatch]) -> list[TelemetryChunk]:
    chunks: list[TelemetryChunk] = []
    pending: list[tuple[TelemetryBatch, Batch]] = []
    for row in run:
        decoded = decode_batch(row.message)
        if pending and not _belongs(pending, row, decoded):
            chunks.append(_chunk(pending))
            pending = []
        pending.append((row, decoded))
    return [*chunks, _chunk(pending)] if pending else chunks


def _belongs(
    pending: Sequence[tuple[TelemetryBatch, Batch]], row: TelemetryBatch, decoded: Batch
) -> bool:
    last_row, _ = pending[-1]
    consecutive = row.seq_first == last_row.seq_first + last_row.frame_count
    spans_s = float(decoded.times_s[-1]) - float(pending[0][1].times_s[0])
    return consecutive and not spans_s > CHUNK_S


def _chunk(pending: Sequence[tuple[TelemetryBatch, Batch]]) -> TelemetryChunk:
    first, _ = pending[0]
    times_s = np.concatenate([batch.times_s for _, batch in pending])
    flags = np.concatenate([batch.flags for _, batch in pending])
    values = np.concatenate([batch.values for _, batch in pending])
    # Broken times stay in the data; the index spans the others.
    finite_s = times_s[np.isfinite(times_s)]
    return TelemetryChunk(
        session_id=first.session_id,
        stream=first.stream,
        epoch=first.epoch,
        seq_first=first.seq_first,
        frame_count=len(times_s),
        phase_id=first.phase_id,
        values_per_frame=values.shape[1],
        t_first_s=float(finite_s.min()) if len(finite_s) else 0.0,
        t_last_s=float(finite_s.max()) if len(finite_s) else 0.0,
        encoding=ENCODING,
        data=encode_frames(times_s, flags, values),
    )


def _replace(
    db: Session, batches: Sequence[TelemetryBatch], chunks: Sequence[TelemetryChunk]
) -> None:
    db.add_all(chunks)
    keys = [(row.session_id, row.stream, row.epoch, row.seq_first) for row in batches]
    key = tuple_(
        TelemetryBatch.session_id,
        TelemetryBatch.stream,
        TelemetryBatch.epoch,
        TelemetryBatch.seq_first,
    )
    for start in range(0, len(keys), 100):
        db.execute(delete(TelemetryBatch).where(key.in_(keys[start : start + 100])))
