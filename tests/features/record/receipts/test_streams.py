"""Tests that a receipt counts the stored frames, names every gap and detects every changed bit."""

import hashlib
from typing import Any

import numpy as np
import pytest
from sqlalchemy import delete, select, update
from sqlalchemy.orm import Session

from app.features.record.telemetry.encoding import ENCODING, decode_frames, encode_frames
from app.features.record.telemetry.frames import iter_frames
from app.models import TelemetryChunk, TelemetryStream
from tests.features.record.receipts.conftest import FRAMES, StoredSession


def target(stored: StoredSession, *more: Any) -> tuple[Any, ...]:
    """Return conditions for the chunks of the target in epoch 1."""
    return (
        TelemetryChunk.session_id == stored.session_id,
        TelemetryChunk.stream == "target",
        TelemetryChunk.epoch == 1,
        *more,
    )


def test_a_complete_record_has_no_missing_frames(stored: StoredSession) -> None:
    """In a complete record the sent and stored frames of every stream and epoch agree."""
    streams = stored.receipt().streams
    assert [(one.stream, one.epoch, one.sent, one.stored, one.missing) for one in streams] == [
        ("actual", 1, FRAMES, FRAMES, 0),
        ("target", 1, FRAMES, FRAMES, 0),
        ("target", 2, 100, 100, 0),
    ]
    assert all(one.gaps == () for one in streams)


@pytest.mark.one_engine
def test_a_deleted_chunk_is_reported_as_a_gap(stored: StoredSession) -> None:
    """A deleted chunk is reported as a gap by its seqs, although all counters are unchanged."""
    stored.change(
        lambda db: db.execute(
            delete(TelemetryChunk).where(*target(stored, TelemetryChunk.seq_first == 90))
        )
    )
    found = stored.stream()
    assert (found.sent, found.stored, found.missing) == (FRAMES, FRAMES - 90, 90)
    assert found.gaps == ((90, 180),)
    receipt = stored.receipt()
    assert not receipt.complete
    assert "target, epoch 1: 90 of 400 are missing (seq 90 to 179)" in receipt.problems


@pytest.mark.one_engine
def test_frames_that_were_made_but_never_sent_are_missing(stored: StoredSession) -> None:
    """Frames that the client reported as made but never sent count as missing."""
    stored.change(
        lambda db: db.execute(
            update(TelemetryStream)
            .where(TelemetryStream.epoch == 2, TelemetryStream.stream == "target")
            .values(produced=130)
        )
    )
    found = stored.stream(epoch=2)
    assert (found.sent, found.stored, found.missing, found.gaps) == (130, 100, 30, ((100, 130),))


@pytest.mark.one_engine
def test_a_chunk_that_cannot_be_read_counts_as_missing(stored: StoredSession) -> None:
    """The frames of a chunk with a flipped bit count as missing and damaged."""

    def damage(db: Session) -> None:
        chunk = db.scalars(
            select(TelemetryChunk).where(*target(stored, TelemetryChunk.seq_first == 180))
        ).one()
        data = bytearray(chunk.data)
        data[len(data) // 2] ^= 1
        chunk.data = bytes(data)

    stored.change(damage)
    found = stored.stream()
    assert (found.missing, found.damaged, found.gaps) == (90, 90, ((180, 270),))
    with stored.database.reading() as db:
        read = [frames for _, frames in iter_frames(db, stored.session_id, "target", 1)]
    assert sum(len(frames) for frames in read) == FRAMES - 90
    assert "target, epoch 1: 90 frames can no longer be read" in stored.receipt().problems


def test_the_digest_does_not_depend_on_chunk_boundaries(stored: StoredSession) -> None:
    """The digest of a stream depends on its frames, not on how they are divided into chunks."""
    before = stored.stream().sha256

    def merge_two(db: Session) -> None:
        first, second = db.scalars(
            select(TelemetryChunk)
            .where(*target(stored, TelemetryChunk.seq_first < 180))
            .order_by(TelemetryChunk.seq_first)
        )
        pieces = [
            decode_frames(
                chunk.data,
                encoding=ENCODING,
                seq_first=chunk.seq_first,
                frame_count=chunk.frame_count,
                values_per_frame=chunk.values_per_frame,
            )
            for chunk in (first, second)
        ]
        first.data = encode_frames(
            np.concatenate([piece.times_s for piece in pieces]),
            np.concatenate([piece.flags for piece in pieces]),
            np.concatenate([piece.values for piece in pieces]),
        )
        first.frame_count += second.frame_count
        db.delete(second)

    stored.change(merge_two)
    assert stored.stream().sha256 == before
    assert stored.stream("actual").sha256 != before


@pytest.mark.one_engine
@pytest.mark.parametrize("epoch", [2])
def test_an_empty_stream_has_no_missing_frames(stored: StoredSession, epoch: int) -> None:
    """A stream of which nothing was sent has no missing frames."""
    stored.change(
        lambda db: (
            db.execute(delete(TelemetryChunk).where(TelemetryChunk.epoch == epoch)),
            db.execute(
                update(TelemetryStream)
                .where(TelemetryStream.epoch == epoch)
                .values(next_seq=0, produced=0)
            ),
        )
    )
    found = stored.stream(epoch=epoch)
    assert (found.sent, found.stored, found.missing) == (0, 0, 0)
    assert found.sha256 == hashlib.sha256().hexdigest()
