"""Compressing in a process of its own."""

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
    """A process of its own beside the application's."""
    encoder = Encoder(lab.context.settings.resolved_database_url)
    yield encoder
    encoder.end()


@pytest.fixture
def session_id(lab: Lab) -> str:
    """A session with movement that is due a minute after it came."""
    fold(lab)  # what others have left
    session_id = str(lab.join()["id"])
    for first in range(0, 300, 10):
        store(lab, session_id, first, numbered(first, 10))
    return session_id


def test_the_process_gives_the_chunks_that_a_thread_would(
    lab: Lab, session_id: str, encoder: Encoder
) -> None:
    """The same rows to the last bit; what is not due is not there."""
    now = lab.context.clock.utc_now()
    with lab.database.reading() as db:
        here = due_chunks(db, now + LATER)
    assert {chunk["session_id"] for chunk in here} == {session_id}
    assert encoder.due_chunks(now + LATER) == here
    assert encoder.due_chunks(now - timedelta(days=1)) == []


@pytest.mark.one_engine
def test_a_process_that_was_killed_is_started_anew(
    lab: Lab, session_id: str, encoder: Encoder
) -> None:
    """The turn in which it is found dead fails, the next one folds."""
    now = lab.context.clock.utc_now() + LATER
    assert encoder.due_chunks(now)
    killed = encoder.pid
    assert killed is not None
    os.kill(killed, signal.SIGKILL)
    with pytest.raises(EncoderError, match="has ended"):
        encoder.due_chunks(now)
    assert {chunk["session_id"] for chunk in encoder.due_chunks(now)} == {session_id}
    assert encoder.pid != killed


def test_what_goes_wrong_there_is_told_here(tmp_path: Path) -> None:
    """A database without tables: the error names what is missing, and the process lives on."""
    encoder = Encoder(f"sqlite:///{tmp_path / 'empty.sqlite'}")
    try:
        for _ in range(2):
            with pytest.raises(EncoderError, match="no such table: telemetry_batches"):
                encoder.due_chunks(datetime(2026, 1, 1, tzinfo=UTC))
    finally:
        encoder.end()


@pytest.mark.one_engine
def test_it_ends_when_nobody_asks_any_more(lab: Lab, encoder: Encoder) -> None:
    """The end of the line is the end of the process, also of a server that was killed."""
    encoder.due_chunks(lab.context.clock.utc_now())
    assert encoder.pid is not None
    process = psutil.Process(encoder.pid)
    encoder.end()
    assert not process.is_running()
