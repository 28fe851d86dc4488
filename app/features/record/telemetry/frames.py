"""Read movement back, merging chunks and the batches that are not folded yet."""

import logging
from collections.abc import Callable, Iterator, Sequence
from heapq import merge

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.telemetry.encoding import DamagedChunkError, Frames, decode_frames
from app.models import TelemetryBatch, TelemetryChunk, TelemetryStream
from app.wire import MalformedBatchError, StreamName, decode_batch

Piece = TelemetryChunk | TelemetryBatch
log = logging.getLogger(__name__)


def epochs_of(db: Session, session_id: str, stream: str) -> list[int]:
    """Return the epochs in which this stream was sent, in order."""
    query = select(TelemetryStream.epoch).where(
        TelemetryStream.session_id == session_id, TelemetryStream.stream == stream
    )
    return list(db.scalars(query.order_by(TelemetryStream.epoch)))


def iter_frames(
    db: Session,
    session_id: str,
    stream: str,
    epoch: int,
    phase_id: int | None = None,
    *,
    since_s: float | None = None,
    told: Callable[[Piece, Frames | None], None] | None = None,
) -> Iterator[tuple[int, Frames]]:
    """Yield frames of about a second at a time in seq order, each with its phase_id.

    `phase_id` restricts them to one phase, and `since_s` leaves out chunks that end before that
    client time. A damaged chunk is left out too, so that it does not make the whole session
    unreadable: the session's receipt counts its frames as missing. `told` is given every piece with
    its frames, a damaged one with None.
    """
    for piece in iter_pieces(db, session_id, stream, epoch, phase_id, since_s=since_s):
        try:
            frames = decode_piece(piece)
        except DamagedChunkError as error:
            log.warning("%s of %s, seq %d: %s", stream, session_id, piece.seq_first, error)
            frames = None
        if told is not None:
            told(piece, frames)
        if frames is not None:
            yield piece.phase_id, frames


def iter_pieces(
    db: Session,
    session_id: str,
    stream: str,
    epoch: int,
    phase_id: int | None = None,
    *,
    since_s: float | None = None,
) -> Iterator[Piece]:
    """Yield the stored chunks and unfolded batches in seq order, without decoding them.

    The arguments are those of `iter_frames`.
    """
    # Read batches first: one that is folded between the two reads is then seen twice, never missed;
    # seqs that were already seen are skipped below.
    batches = _batches(db, session_id, stream, epoch, phase_id)
    chunk_query = (
        select(TelemetryChunk)
        .where(
            TelemetryChunk.session_id == session_id,
            TelemetryChunk.stream == stream,
            TelemetryChunk.epoch == epoch,
        )
        .order_by(TelemetryChunk.seq_first)
    )
    if phase_id is not None:
        chunk_query = chunk_query.where(TelemetryChunk.phase_id == phase_id)
    if since_s is not None:
        chunk_query = chunk_query.where(TelemetryChunk.t_last_s >= since_s)
    # If a chunk and a batch begin at the same seq, the chunk comes first, as it contains more.
    chunks = db.scalars(chunk_query.execution_options(yield_per=64))
    pieces: Iterator[Piece] = merge(chunks, batches, key=lambda piece: piece.seq_first)
    next_seq = 0
    for row in pieces:
        if row.seq_first >= next_seq:
            yield row
            next_seq = row.seq_first + row.frame_count


def decode_piece(piece: Piece) -> Frames:
    """Decode a chunk or a batch; raises DamagedChunkError if its bytes are not what was written."""
    return _of_chunk(piece) if isinstance(piece, TelemetryChunk) else _of_batch(piece)


def phase_frames(
    db: Session, session_id: str, stream: str, phase_id: int
) -> list[tuple[int, Frames]]:
    """Return all frames of a phase as (epoch, frames), for each epoch that has any."""
    runs = []
    for epoch in epochs_of(db, session_id, stream):
        pieces = [frames for _, frames in iter_frames(db, session_id, stream, epoch, phase_id)]
        if pieces:
            runs.append((epoch, concatenate(pieces)))
    return runs


def concatenate(pieces: Sequence[Frames], stream: StreamName = StreamName.TARGET) -> Frames:
    """Join consecutive pieces into one; an empty sequence gives no frames, of this stream."""
    if not pieces:
        return Frames(
            seq=np.empty(0, np.int64),
            times_s=np.empty(0),
            flags=np.empty(0, np.uint8),
            values=np.empty((0, stream.values_per_frame), np.float32),
        )
    return Frames(
        seq=np.concatenate([piece.seq for piece in pieces]),
        times_s=np.concatenate([piece.times_s for piece in pieces]),
        flags=np.concatenate([piece.flags for piece in pieces]),
        values=np.concatenate([piece.values for piece in pieces]),
    )


def _batches(
    db: Session, session_id: str, stream: str, epoch: int, phase_id: int | None
) -> list[TelemetryBatch]:
    query = select(TelemetryBatch).where(
        TelemetryBatch.session_id == session_id,
        TelemetryBatch.stream == stream,
        TelemetryBatch.epoch == epoch,
    )
    if phase_id is not None:
        query = query.where(TelemetryBatch.phase_id == phase_id)
    return list(db.scalars(query.order_by(TelemetryBatch.seq_first)))


def _of_chunk(chunk: TelemetryChunk) -> Frames:
    return decode_frames(
        chunk.data,
        encoding=chunk.encoding,
        seq_first=chunk.seq_first,
        frame_count=chunk.frame_count,
        values_per_frame=chunk.values_per_frame,
    )


def _of_batch(row: TelemetryBatch) -> Frames:
    try:
        batch = decode_batch(row.message)
    except MalformedBatchError as error:
        raise DamagedChunkError(str(error)) from error
    return Frames(
        seq=np.arange(row.seq_first, row.seq_first + row.frame_count),
        times_s=batch.times_s,
        flags=batch.flags,
        values=batch.values,
    )
