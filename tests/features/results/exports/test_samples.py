"""Tests of a session's frames as one wide CSV file."""

import csv
import io

import numpy as np
import pytest
from sqlalchemy.orm import Session

from app.database import Database
from app.features.results.analysis.codebook import columns_of
from app.features.results.exports.writing.samples import SampleFile
from app.models import StudySession
from app.wire import FINGER_STREAMS, StreamName
from tests.features.builders import SessionSpec, build_session
from tests.features.movement_builders import moving_values, store_batch, store_chunks

TARGET, ACTUAL = StreamName.TARGET, StreamName.ACTUAL
NAMES = [column.name for column in columns_of("samples")]


def _rows(db: Session, session: StudySession) -> list[dict[str, str]]:
    file = SampleFile(db, session.id, session.kind == "simulated", session.avatar)
    text = b"".join(file.pieces()).decode()
    assert "\r" not in text
    return list(csv.DictReader(io.StringIO(text)))


def _values(rows: list[dict[str, str]], stream: str) -> np.ndarray:
    names = [name for name in NAMES if name.startswith(f"{stream}_")]
    return np.array([[float(row[name]) for name in names] for row in rows]).astype(np.float32)


@pytest.fixture
def session(database: Database) -> StudySession:
    """Return a session without any movement."""
    with database.writing() as db:
        return build_session(db, SessionSpec("P-0001"))


def test_exported_values_equal_the_stored_ones_exactly(
    database: Database, session: StudySession
) -> None:
    """Every exported value of both streams reads back as the stored single-precision number."""
    target, actual = moving_values(250, 1), moving_values(250, 2)
    with database.writing() as db:
        store_chunks(db, session.id, TARGET, range(250), target)
        store_chunks(db, session.id, ACTUAL, range(250), actual, per_chunk=70)
    with database.reading() as db:
        rows = _rows(db, session)
    assert list(rows[0]) == NAMES
    assert [int(row["seq"]) for row in rows] == list(range(250))
    assert np.array_equal(_values(rows, "target"), target)
    assert np.array_equal(_values(rows, "actual"), actual)
    assert [float(row["t_s"]) for row in rows] == [seq / 90 for seq in range(250)]
    assert {(row["simulated"], row["avatar"], row["active"], row["flagged"]) for row in rows} == {
        ("false", "delayed_copy", "true", "false")
    }


def test_frames_are_joined_on_epoch_and_seq(database: Database, session: StudySession) -> None:
    """Frames are joined by epoch and seq; a frame in one stream leaves the other's cells empty."""
    with database.writing() as db:
        store_chunks(db, session.id, TARGET, [0, 1, 2, 7, 8], moving_values(5, 1), epoch=1)
        store_chunks(db, session.id, ACTUAL, [1, 2, 3, 8], moving_values(4, 2), epoch=1)
        store_chunks(db, session.id, ACTUAL, [0, 1], moving_values(2, 3), epoch=5, phase_id=4)
    with database.reading() as db:
        rows = _rows(db, session)
    found = [
        (
            int(row["epoch"]),
            int(row["seq"]),
            row["target_root_x_m"] != "",
            row["actual_RightToes_qz"] != "",
        )
        for row in rows
    ]
    assert found == [
        (1, 0, True, False),
        (1, 1, True, True),
        (1, 2, True, True),
        (1, 3, False, True),
        (1, 7, True, False),
        (1, 8, True, True),
        (5, 0, False, True),
        (5, 1, False, True),
    ]
    assert [row["phase_id"] for row in rows] == ["1"] * 6 + ["4"] * 2


def test_batches_that_are_not_folded_are_exported(
    database: Database, session: StudySession
) -> None:
    """Batches that have not been folded into chunks are exported together with the chunks."""
    values = moving_values(100, 1)
    with database.writing() as db:
        store_chunks(db, session.id, TARGET, range(90), values[:90])
        store_batch(db, session.id, TARGET, 90, values[90:])
    with database.reading() as db:
        rows = _rows(db, session)
    assert np.array_equal(_values(rows, "target"), values)


def test_bad_samples_are_exported_unchanged_and_flagged(
    database: Database, session: StudySession
) -> None:
    """NaN, infinity and non-unit rotations are exported unchanged in flagged rows."""
    values = moving_values(5, 1)
    values[1, 0] = np.nan
    values[2, 1] = -np.inf
    values[3, 3:7] = (2.0, 0.0, 0.0, 0.0)
    with database.writing() as db:
        store_chunks(db, session.id, ACTUAL, range(5), values)
    with database.reading() as db:
        rows = _rows(db, session)
    assert [row["flagged"] for row in rows] == ["false", "true", "true", "true", "false"]
    assert (rows[1]["actual_root_x_m"], rows[2]["actual_root_y_m"]) == ("NaN", "-Infinity")
    assert np.array_equal(_values(rows, "actual"), values, equal_nan=True)


@pytest.mark.one_engine
def test_a_session_without_movement_has_a_file_with_a_header(
    database: Database, session: StudySession
) -> None:
    """A session without movement has a file with only a header."""
    with database.reading() as db:
        assert _rows(db, session) == []


def test_at_most_a_second_of_each_stream_is_in_memory(
    database: Database, session: StudySession
) -> None:
    """A stream that is far ahead of the other is exported without reading it into memory."""
    with database.writing() as db:
        store_chunks(db, session.id, TARGET, range(900), moving_values(900, 1))
        store_chunks(db, session.id, ACTUAL, range(890, 900), moving_values(10, 2))
    with database.reading() as db:
        pieces = list(SampleFile(db, session.id, simulated=False, avatar="x").pieces())
    assert max(piece.count(b"\n") for piece in pieces) <= 90


@pytest.mark.one_engine
def test_fingers_are_exported_in_a_file_of_their_own(
    database: Database, session: StudySession
) -> None:
    """Every exported value of the fingers reads back as the stored one, and NaN as NaN."""
    names = [column.name for column in columns_of("fingers")]
    values = np.random.default_rng(4).normal(size=(90, 120)).astype(np.float32)
    values[40:, 60:] = np.nan
    with database.writing() as db:
        for stream in FINGER_STREAMS:
            store_chunks(db, session.id, stream, range(90), values)
    with database.reading() as db:
        file = SampleFile(db, session.id, simulated=False, avatar=session.avatar, fingers=True)
        rows = list(csv.DictReader(io.StringIO(b"".join(file.pieces()).decode())))
        blinded = SampleFile(*(db, session.id, False, session.avatar), blinded=True, fingers=True)
        first = next(csv.DictReader(io.StringIO(b"".join(blinded.pieces()).decode())))
    assert list(rows[0]) == names
    for prefix in ("target", "actual"):
        own = [name for name in names if name.startswith(f"{prefix}_")]
        found = np.array([[float(row[name]) for name in own] for row in rows]).astype(np.float32)
        assert np.array_equal(found, values, equal_nan=True)
    # The avatar's would reveal its latency.
    assert first["target_LeftThumbDistal_qw"]
    assert not first["actual_LeftThumbDistal_qw"]
