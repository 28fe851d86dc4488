"""Builders of stored movement: chunks and batches as the telemetry writer stores them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from sqlalchemy.orm import Session

from app.features.record.telemetry.encoding import ENCODING, encode_frames
from app.models import TelemetryBatch, TelemetryChunk, TelemetryStream
from app.wire import VALUES_PER_FRAME, StreamName, encode_batch
from tests.features.builders import NOW

RATE_HZ = 90


def moving_values(count: int, seed: int) -> NDArray[np.float32]:
    """Return plausible frames (count, 91): a root near the origin and random unit quaternions."""
    rng = np.random.default_rng(seed)
    rotations = rng.normal(size=(count, 22, 4))
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    root = rng.normal(scale=0.1, size=(count, 3))
    values = np.concatenate((root, rotations.reshape(count, -1)), axis=1)
    assert values.shape == (count, VALUES_PER_FRAME)
    return values.astype(np.float32)


def store_chunks(
    db: Session,
    session_id: str,
    stream: StreamName,
    seqs: Sequence[int],
    values: NDArray[np.float32],
    *,
    epoch: int = 1,
    phase_id: int = 1,
    per_chunk: int = RATE_HZ,
) -> None:
    """Store frames `values` (n, w) at increasing `seqs` (n); a gap starts a new chunk."""
    _stream(db, session_id, stream, epoch, int(seqs[-1]) + 1, len(seqs))
    for begin, end in _runs(seqs, per_chunk):
        times_s = np.asarray(seqs[begin:end], np.float64) / RATE_HZ
        db.add(
            TelemetryChunk(
                session_id=session_id,
                stream=stream,
                epoch=epoch,
                seq_first=int(seqs[begin]),
                frame_count=end - begin,
                phase_id=phase_id,
                values_per_frame=values.shape[1],
                t_first_s=float(times_s[0]),
                t_last_s=float(times_s[-1]),
                encoding=ENCODING,
                data=encode_frames(times_s, np.ones(end - begin, np.uint8), values[begin:end]),
            )
        )
    db.flush()


def store_batch(
    db: Session,
    session_id: str,
    stream: StreamName,
    seq_first: int,
    values: NDArray[np.float32],
    *,
    epoch: int = 1,
    phase_id: int = 1,
) -> None:
    """Store frames that have not been folded into a chunk yet."""
    count = len(values)
    message = encode_batch(
        stream,
        epoch=epoch,
        phase_id=phase_id,
        seq_first=seq_first,
        times_s=np.arange(seq_first, seq_first + count) / RATE_HZ,
        flags=np.ones(count, np.uint8),
        values=values,
        active_s=1.0,
        closed_at_s=1.0,
    )
    db.add(
        TelemetryBatch(
            session_id=session_id,
            stream=stream,
            epoch=epoch,
            seq_first=seq_first,
            frame_count=count,
            phase_id=phase_id,
            received_at=NOW,
            message=message,
        )
    )
    db.flush()


def _stream(
    db: Session, session_id: str, stream: StreamName, epoch: int, next_seq: int, stored: int
) -> None:
    db.merge(
        TelemetryStream(
            session_id=session_id,
            stream=stream,
            epoch=epoch,
            next_seq=next_seq,
            frames_stored=stored,
            frames_flagged=0,
            phase_id=1,
            active_s=1.0,
            first_at=NOW,
            last_at=NOW,
        )
    )
    db.flush()


def _runs(seqs: Sequence[int], longest: int) -> list[tuple[int, int]]:
    """Return (begin, end) of runs of consecutive seqs, each at most `longest` long."""
    runs, begin = [], 0
    for at in range(1, len(seqs) + 1):
        if at == len(seqs) or seqs[at] != seqs[at - 1] + 1 or at - begin == longest:
            runs.append((begin, at))
            begin = at
    return runs
