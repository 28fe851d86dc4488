"""Tests of storing batches, folding them into chunks and reading them back, without a network."""

import threading
from dataclasses import replace
from datetime import datetime, timedelta

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray
from sqlalchemy import delete, func, select

from app.clock import Clock
from app.database import Database
from app.features.record.telemetry.due import Chunks, due_chunks
from app.features.record.telemetry.encoder import Encoder
from app.features.record.telemetry.encoding import ENCODING, Frames, decode_frames, encode_frames
from app.features.record.telemetry.fold import Folder
from app.features.record.telemetry.frames import concatenate, iter_frames, phase_frames
from app.features.record.telemetry.ingest import Intake
from app.features.record.telemetry.positions import Outcome
from app.models import TelemetryBatch, TelemetryChunk
from app.wire import VALUES_PER_FRAME, StreamName, decode_batch, flag_frames
from tests.features.lab import Lab
from tests.wire.samples import bits, every_odd_float, message, standing

# Batches are stamped ahead of the clock, so that the application's own folder ignores them.
AHEAD_S = 600.0
LATER = timedelta(seconds=AHEAD_S + 60)


@given(raw=arrays(np.uint32, st.tuples(st.integers(1, 30), st.just(VALUES_PER_FRAME))))
@settings(max_examples=50)
def test_a_chunk_is_decoded_to_the_same_bits(
    raw: np.ndarray[tuple[int, int], np.dtype[np.uint32]],
) -> None:
    """A chunk is decoded to the same bits, including NaN payloads, denormals and signed zeros."""
    count = len(raw)
    times_s = np.linspace(5.0, 6.0, count)
    flags = np.arange(count, dtype=np.uint8)
    data = encode_frames(times_s, flags, raw.view(np.float32))
    frames = decode_frames(
        data, encoding=ENCODING, seq_first=7, frame_count=count, values_per_frame=VALUES_PER_FRAME
    )
    assert np.array_equal(bits(frames.values), raw)
    assert np.array_equal(frames.times_s, times_s)
    assert np.array_equal(frames.flags, flags)
    assert frames.seq.tolist() == list(range(7, 7 + count))


def test_an_unknown_encoding_is_refused() -> None:
    """A chunk in an unknown encoding is refused."""
    with pytest.raises(ValueError, match="unknown encoding 'later/2'"):
        decode_frames(b"", encoding="later/2", seq_first=0, frame_count=1, values_per_frame=91)


def store(
    lab: Lab,
    session_id: str,
    first: int,
    values: NDArray[np.float32],
    *,
    ahead_s: float = AHEAD_S,
    phase_id: int = 0,
    times_s: NDArray[np.float64] | None = None,
) -> Outcome:
    """Store one batch as if it arrived `ahead_s` from now."""
    sent = message(values, seq_first=first, phase_id=phase_id, times_s=times_s)
    batch = decode_batch(sent)
    outcome = Outcome()
    now = lab.context.clock.utc_now() + timedelta(seconds=ahead_s)
    flags = flag_frames(batch.times_s, batch.values)
    with lab.database.writing() as db:
        intake = Intake(db, lab.context, now)
        intake.store_batch(session_id, batch.header, sent, flags, outcome)
        intake.flush()
    return outcome


def fold(lab: Lab) -> int:
    """Fold everything that is due at `LATER` and return how many batches were folded."""
    clock = Clock(utc_now=lambda: lab.context.clock.utc_now() + LATER)
    folder = Folder(replace(lab.context, clock=clock))
    folded = 0
    while turn := folder.fold_once():
        folded += turn
    return folded


def read(database: Database, session_id: str, phase_id: int | None = None) -> Frames:
    """Return the target stream as a reader gets it."""
    with database.reading() as db:
        pieces = iter_frames(db, session_id, StreamName.TARGET, 1, phase_id)
        return concatenate([frames for _, frames in pieces])


def batches(lab: Lab, session_id: str) -> int:
    """Return how many batches of a session are not folded yet."""
    with lab.database.reading() as db:
        query = select(func.count()).select_from(TelemetryBatch)
        return db.scalar(query.where(TelemetryBatch.session_id == session_id)) or 0


def numbered(first: int, count: int) -> NDArray[np.float32]:
    """Return frames whose hip height is their own seq."""
    values = standing(count)
    values[:, 1] = np.arange(first, first + count)
    return values


@pytest.fixture
def session_id(lab: Lab) -> str:
    """Return a session without data."""
    return str(lab.join()["id"])


def test_folding_changes_nothing_that_is_read(lab: Lab, session_id: str) -> None:
    """A reader gets the same frames, bit by bit, before and after folding."""
    for first in range(0, 300, 10):
        store(lab, session_id, first, numbered(first, 10))
    store(lab, session_id, 300, every_odd_float())
    before = read(lab.database, session_id)
    fold(lab)
    after = read(lab.database, session_id)
    assert np.array_equal(bits(after.values), bits(before.values))
    assert np.array_equal(after.seq, np.arange(311))
    assert batches(lab, session_id) == 0


def test_recent_batches_are_not_folded(lab: Lab, session_id: str) -> None:
    """Batches that are not due yet are not folded."""
    store(lab, session_id, 0, numbered(0, 10), ahead_s=6000)
    fold(lab)
    assert batches(lab, session_id) == 1


def test_a_chunk_never_spans_two_phases(lab: Lab, session_id: str) -> None:
    """A chunk never contains frames of two phases."""
    for first, phase_id in ((0, 0), (10, 1), (20, 1), (30, 2)):
        store(lab, session_id, first, numbered(first, 10), phase_id=phase_id)
    fold(lab)
    assert read(lab.database, session_id, 1).values[:, 1].tolist() == list(range(10, 30))
    with lab.database.reading() as db:
        ((epoch, frames),) = phase_frames(db, session_id, StreamName.TARGET, 2)
    assert (epoch, len(frames)) == (1, 10)


def test_readers_get_every_frame_once_while_folding(lab: Lab, session_id: str) -> None:
    """A reader gets every frame exactly once while batches are folded."""
    done = threading.Event()

    def keep_folding() -> None:
        while not done.is_set():
            fold(lab)

    folder = threading.Thread(target=keep_folding)
    folder.start()
    try:
        for first in range(0, 200, 10):
            store(lab, session_id, first, numbered(first, 10))
            seen = read(lab.database, session_id).seq
            assert seen.tolist() == list(range(first + 10))
    finally:
        done.set()
        folder.join()


def test_folding_survives_a_wall_clock_set_back(lab: Lab, session_id: str) -> None:
    """Batches are folded and read in order although the wall clock was set back between them."""
    for second, ahead_s in enumerate((6000.0, 6000.0, AHEAD_S, AHEAD_S)):
        times_s = 2.0 * second + np.linspace(0.0, 0.1, 10)
        store(lab, session_id, 10 * second, numbered(0, 10), ahead_s=ahead_s, times_s=times_s)
    fold(lab)
    assert batches(lab, session_id) == 0
    assert read(lab.database, session_id).seq.tolist() == list(range(40))


def test_a_chunk_waits_until_it_is_whole(lab: Lab, session_id: str) -> None:
    """While a stream continues only whole seconds are folded; the rest follows when it stops."""
    now = lab.context.clock.utc_now()
    folder = Folder(replace(lab.context, clock=Clock(utc_now=lambda: now + LATER)))
    for batch in range(16):
        times_s = (10 * batch + np.arange(10)) / 90.0
        newest_s = LATER.total_seconds() - (15 - batch) / 9.0
        store(lab, session_id, 10 * batch, numbered(0, 10), ahead_s=newest_s, times_s=times_s)
    while folder.fold_once():
        pass
    assert batches(lab, session_id) == 7
    later = Folder(replace(lab.context, clock=Clock(utc_now=lambda: now + 2 * LATER)))
    assert later.fold_once() == 7
    assert read(lab.database, session_id).seq.tolist() == list(range(160))


class ErasingEncoder(Encoder):
    """An encoder during whose first call a session's batches are deleted."""

    def __init__(self, lab: Lab, erased_id: str) -> None:
        super().__init__("")
        self.lab, self.erased_id = lab, erased_id

    def due_chunks(self, now: datetime) -> Chunks:
        """Return the due chunks, and then delete the batches of the erased session."""
        with self.lab.database.reading() as db:
            chunks = due_chunks(db, now)
        with self.lab.database.writing() as db:
            db.execute(delete(TelemetryBatch).where(TelemetryBatch.session_id == self.erased_id))
        return chunks


def test_a_session_that_is_erased_meanwhile_is_not_folded(lab: Lab, session_id: str) -> None:
    """A session that is erased while its chunks are made is not folded; others are."""
    fold(lab)
    erased_id = str(lab.join()["id"])
    for one in (session_id, erased_id):
        store(lab, one, 0, numbered(0, 10))
    clock = Clock(utc_now=lambda: lab.context.clock.utc_now() + LATER)
    folder = Folder(replace(lab.context, clock=clock), ErasingEncoder(lab, erased_id))
    assert folder.fold_once() == 1
    assert read(lab.database, session_id).seq.tolist() == list(range(10))
    assert read(lab.database, erased_id).seq.tolist() == []


def test_a_chunk_with_invalid_times_is_found_by_its_valid_ones(lab: Lab, session_id: str) -> None:
    """A chunk whose first and last times are invalid is still found by time."""
    times_s = np.linspace(100.0, 100.5, 10)
    times_s[[0, -1]] = np.nan
    store(lab, session_id, 0, numbered(0, 10), times_s=times_s)
    fold(lab)
    with lab.database.reading() as db:
        (chunk,) = db.scalars(select(TelemetryChunk).where(TelemetryChunk.session_id == session_id))
        found = list(iter_frames(db, session_id, StreamName.TARGET, 1, since_s=100.2))
    assert (chunk.t_first_s, chunk.t_last_s) == (times_s[1], times_s[-2])
    assert len(found) == 1


def test_notices_are_only_about_new_frames(lab: Lab, session_id: str) -> None:
    """Bad frames that were stored before are not reported again when resent."""
    bad = standing(10)
    bad[:5, 3] = 2.0
    assert len(store(lab, session_id, 0, bad).notices) == 1
    assert store(lab, session_id, 0, np.concatenate([bad, standing(2)])).notices == []
    assert len(read(lab.database, session_id)) == 12
