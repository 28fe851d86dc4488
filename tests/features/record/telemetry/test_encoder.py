"""Tests of compressing chunks in a separate process."""

import os
import signal
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import psutil
import pytest

from app.features.record.telemetry.due import due_chunks
from app.features.record.telemetry.encoder import Encoder, EncoderError
from tests.features.lab import Lab
from tests.features.record.telemetry.test_storage import LATER, fold, numbered, store


@pytest.fixture
def encoder(lab: Lab) -> Iterator[Encoder]:
    """Yield an encoder with its process, in addition to the application's."""
    encoder = Encoder(lab.context.settings.resolved_database_url)
    yield encoder
    encoder.end()


@pytest.fixture
def session_id(lab: Lab) -> str:
    """Return a session with batches that are due for folding at `LATER`."""
    fold(lab)  # from earlier tests
    session_id = str(lab.join()["id"])
    for first in range(0, 300, 10):
        store(lab, session_id, first, numbered(first, 10))
    return session_id


def test_the_process_makes_the_same_chunks_as_a_thread(
    lab: Lab, session_id: str, encoder: Encoder
) -> None:
    """The encoder's process makes exactly the chunks that are made in this process."""
    now = lab.context.clock.utc_now()
    with lab.database.reading() as db:
        here = due_chunks(db, now + LATER)
    assert {chunk["session_id"] for chunk in here} == {session_id}
    assert encoder.due_chunks(now + LATER) == here
    assert encoder.due_chunks(now - timedelta(days=1)) == []


@pytest.mark.one_engine
def test_a_killed_process_is_restarted(lab: Lab, session_id: str, encoder: Encoder) -> None:
    """A killed encoder process makes one call fail and is restarted by the next."""
    now = lab.context.clock.utc_now() + LATER
    assert encoder.due_chunks(now)
    killed = encoder.pid
    assert killed is not None
    os.kill(killed, signal.SIGKILL)
    with pytest.raises(EncoderError, match="has ended"):
        encoder.due_chunks(now)
    assert {chunk["session_id"] for chunk in encoder.due_chunks(now)} == {session_id}
    assert encoder.pid != killed


def test_an_error_in_the_process_is_reported(tmp_path: Path) -> None:
    """An error in the encoder's process is reported to the caller; the process keeps running."""
    encoder = Encoder(f"sqlite:///{tmp_path / 'empty.sqlite'}")
    try:
        for _ in range(2):
            with pytest.raises(EncoderError, match="no such table: telemetry_batches"):
                encoder.due_chunks(datetime(2026, 1, 1, tzinfo=UTC))
    finally:
        encoder.end()


@pytest.mark.one_engine
def test_the_process_ends_when_its_pipe_closes(lab: Lab, encoder: Encoder) -> None:
    """The encoder's process ends when its pipe closes, as after the server was killed."""
    encoder.due_chunks(lab.context.clock.utc_now())
    assert encoder.pid is not None
    process = psutil.Process(encoder.pid)
    encoder.end()
    assert not process.is_running()
