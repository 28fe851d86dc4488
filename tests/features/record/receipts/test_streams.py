"""A receipt counts what is really stored, names every hole, and notices every changed bit."""

import hashlib
from typing import Any

import numpy as np
import pytest
from sqlalchemy import delete, select, update
from sqlalchemy.orm import Session

from app.features.record.telemetry.encoding import ENCODING, decode_frames, encode_frames
from app.features.record.telemetry.frames import iter_frames
from app.models import TelemetryChunk, TelemetryStream
from tests.features.record.receipts.conftest import FRAMES, Kept


def target(kept: Kept, *more: Any) -> tuple[Any, ...]:
    """Which chunks: those of the target in epoch 1."""
    return (
        TelemetryChunk.session_id == kept.session_id,
        TelemetryChunk.stream == "target",
        TelemetryChunk.epoch == 1,
        *more,
    )


def test_a_whole_record_misses_nothing(kept: Kept) -> None:
    """Sent and stored agree in every stream of every epoch."""
    streams = kept.receipt().streams
    assert [(one.stream, one.epoch, one.sent, one.stored, one.missing) for one in streams] == [
        ("actual", 1, FRAMES, FRAMES, 0),
        ("target", 1, FRAMES, FRAMES, 0),
        ("target", 2, 100, 100, 0),
    ]
    assert all(one.gaps == () for one in streams)


@pytest.mark.one_engine
def test_a_chunk_that_is_gone_leaves_a_named_hole(kept: Kept) -> None:
    """Although every counter still says that all is there."""
    kept.change(
        lambda db: db.execute(
            delete(TelemetryChunk).where(*target(kept, TelemetryChunk.seq_first == 90))
        )
    )
    found = kept.stream()
    assert (found.sent, found.stored, found.missing) == (FRAMES, FRAMES - 90, 90)
    assert found.gaps == ((90, 180),)
    receipt = kept.receipt()
    assert not receipt.complete
    assert "target, epoch 1: 90 of 400 are missing (seq 90 to 179)" in receipt.problems


@pytest.mark.one_engine
def test_what_the_client_made_and_never_sent_is_missing(kept: Kept) -> None:
    """The client told how far it had come; its journal was lost with it."""
    kept.change(
        lambda db: db.execute(
            update(TelemetryStream)
            .where(TelemetryStream.epoch == 2, TelemetryStream.stream == "target")
            .values(produced=130)
        )
    )
    found = kept.stream(epoch=2)
    assert (found.sent, found.stored, found.missing, found.gaps) == (130, 100, 30, ((100, 130),))


@pytest.mark.one_engine
def test_a_chunk_that_cannot_be_read_counts_as_missing(kept: Kept) -> None:
    """One flipped bit in a chunk is noticed, and the rest is still counted."""

    def damage(db: Session) -> None:
        chunk = db.scalars(
            select(TelemetryChunk).where(*target(kept, TelemetryChunk.seq_first == 180))
        ).one()
        data = bytearray(chunk.data)
        data[len(data) // 2] ^= 1
        chunk.data = bytes(data)

    kept.change(damage)
    found = kept.stream()
    assert (found.missing, found.damaged, found.gaps) == (90, 90, ((180, 270),))
    with kept.database.reading() as db:
        read = [frames for _, frames in iter_frames(db, kept.session_id, "target", 1)]
    assert sum(len(frames) for frames in read) == FRAMES - 90
    assert "target, epoch 1: 90 frames can no longer be read" in kept.receipt().problems


def test_the_digest_does_not_depend_on_how_frames_were_cut(kept: Kept) -> None:
    """Two records of the same frames have the same digest, and one other bit changes it."""
    before = kept.stream().sha256

    def merge_two(db: Session) -> None:
        first, second = db.scalars(
            select(TelemetryChunk)
            .where(*target(kept, TelemetryChunk.seq_first < 180))
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

    kept.change(merge_two)
    assert kept.stream().sha256 == before
    assert kept.stream("actual").sha256 != before


@pytest.mark.one_engine
@pytest.mark.parametrize("epoch", [2])
def test_an_empty_stream_is_not_a_hole(kept: Kept, epoch: int) -> None:
    """A run of the client that sent nothing misses nothing."""
    kept.change(
        lambda db: (
            db.execute(delete(TelemetryChunk).where(TelemetryChunk.epoch == epoch)),
            db.execute(
                update(TelemetryStream)
                .where(TelemetryStream.epoch == epoch)
                .values(next_seq=0, produced=0)
            ),
        )
    )
    found = kept.stream(epoch=epoch)
    assert (found.sent, found.stored, found.missing) == (0, 0, 0)
    assert found.sha256 == hashlib.sha256().hexdigest()
