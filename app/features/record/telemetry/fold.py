"""Fold batches into chunks of about a second, stream by stream, as they become due.

Readers merge chunks and batches, so it never matters when this runs.
"""

import logging
import threading
from dataclasses import dataclass, field
from datetime import datetime
from typing import Self, cast

from sqlalchemy import Table, bindparam, delete, select
from sqlalchemy.orm import Session

from app.features.record.telemetry.checkpoints import Checkpointer
from app.features.record.telemetry.due import BATCHES, DUE_AFTER, KEY, Chunks, due_chunks
from app.features.record.telemetry.encoder import Encoder
from app.models import TelemetryChunk
from app.platform.context import AppContext, Part
from app.platform.trouble import explain
from app.rows import insert_rows

log = logging.getLogger(__name__)
TURN_S = 0.2
ATTEMPTS = 3
"""How often folding is tried: an erasure between reading and writing changes the batches."""
FOLDER = "telemetry-folder"
CHUNKS = cast("Table", TelemetryChunk.__table__)


class BatchesChanged(RuntimeError):
    """The stored batches have changed since they were read to be folded."""


@dataclass
class Folder(Part):
    """Folds batches into chunks in a background thread, from `start` until `stop`.

    Chunks are encoded by the `encoder` process, or in this thread if there is none.
    """

    context: AppContext
    encoder: Encoder | None = None
    _stop: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the instance of a server from its context, with a separate encoding process."""
        return cls(context, Encoder(context.settings.resolved_database_url))

    def start(self) -> None:
        """Start the background thread."""
        self._thread = self.context.background.thread(FOLDER, self._run)

    def stop(self) -> None:
        """Stop after the current turn."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(timeout=10.0)
        if self.encoder is not None:
            self.encoder.end()

    def _run(self) -> None:
        checkpoints = Checkpointer(self.context.database)
        while not self._stop.wait(TURN_S):
            try:
                while self.fold_once() and not self._stop.is_set():
                    pass
                checkpoints.turn()
                if self.encoder is not None and self.context.hub.any_headset_connected:
                    self.encoder.begin()
                self.context.background.recovered(FOLDER)
            except Exception as error:  # the next turn retries; nothing is lost in the meantime
                # If the storage is the cause, the storage monitor reports it.
                trouble = explain(error)
                if trouble is None:
                    log.exception("batches could not be folded into chunks; they stay as they are")
                    self.context.background.failed(FOLDER, error)
                else:
                    log.error("batches could not be folded into chunks: %s", trouble.message)
                self._stop.wait(1.0)

    def fold_once(self) -> int:
        """Fold up to one turn's worth of due streams, and return the number of batches folded.

        Raises BatchesChanged if they change at every attempt.
        """
        now = self.context.clock.utc_now()
        for left in reversed(range(ATTEMPTS)):
            # Compress before the write transaction, which telemetry waits for.
            chunks = self._due_chunks(now)
            if not chunks:
                break
            try:
                with self.context.database.writing() as db:
                    _replace(db, chunks)
            except BatchesChanged:
                if not left:
                    raise
            else:
                return sum(chunk["batches"] for chunk in chunks)
        return 0

    def _due_chunks(self, now: datetime) -> Chunks:
        with self.context.database.reading() as db:
            if self.encoder is None:
                return due_chunks(db, now)
            any_due = select(BATCHES.c.epoch).where(BATCHES.c.received_at < now - DUE_AFTER)
            if db.execute(any_due.limit(1)).first() is None:
                return []
        return self.encoder.due_chunks(now)


_DELETE = delete(BATCHES).where(
    *(BATCHES.c[name] == bindparam(f"key_{name}") for name in KEY),
    BATCHES.c.seq_first >= bindparam("seq_from"),
    BATCHES.c.seq_first < bindparam("seq_end"),
)


def _replace(db: Session, chunks: Chunks) -> None:
    """Store chunks and delete the batches they contain.

    Raises BatchesChanged if some of these batches no longer exist, because a session was erased or
    a backup was restored since they were read.
    """
    columns = CHUNKS.c.keys()
    insert_rows(db, CHUNKS, [{name: chunk[name] for name in columns} for chunk in chunks])
    deleted = db.connection().execute(
        _DELETE,
        [
            {
                **{f"key_{name}": chunk[name] for name in KEY},
                "seq_from": chunk["seq_first"],
                "seq_end": chunk["seq_first"] + chunk["frame_count"],
            }
            for chunk in chunks
        ],
    )
    expected = sum(chunk["batches"] for chunk in chunks)
    if deleted.rowcount != expected:
        raise BatchesChanged(f"only {deleted.rowcount} of {expected} batches to fold still exist")
