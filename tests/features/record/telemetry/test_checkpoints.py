"""Tests that SQLite's write-ahead log is checkpointed separately from the commits."""

import itertools
import sqlite3
from pathlib import Path

import pytest

from app.database import open_database
from app.features.record.telemetry.checkpoints import Checkpointer
from tests.support.sqlite import fresh_sqlite

PAGE_BYTES = 4096
BETWEEN_TURNS_BYTES = 1024 * PAGE_BYTES


def test_the_write_ahead_log_stays_bounded(tmp_path: Path) -> None:
    """Checkpoints restart the write-ahead log, so that its size stays bounded under writing."""
    database = open_database(fresh_sqlite(tmp_path / "some.sqlite"))
    checkpointer, now_s = Checkpointer(database, lambda: now_s), 0.0
    with database.writing() as db:
        db.connection().exec_driver_sql("CREATE TABLE blobs (data BLOB)")
    piece = b"x" * BETWEEN_TURNS_BYTES
    longest = 0
    for _ in range(40):
        with database.writing() as db:
            db.connection().exec_driver_sql("INSERT INTO blobs VALUES (?)", (piece,))
        now_s += 10.0
        checkpointer.turn()
        longest = max(longest, (tmp_path / "some.sqlite-wal").stat().st_size)
    database.close()
    assert longest < 4 * BETWEEN_TURNS_BYTES
    with sqlite3.connect(tmp_path / "some.sqlite") as read:
        assert read.execute("SELECT count(*), sum(length(data)) FROM blobs").fetchone() == (
            40,
            40 * len(piece),
        )
    read.close()


def test_a_checkpoint_does_not_wait_for_a_reader(tmp_path: Path) -> None:
    """A checkpoint does not wait for a long read."""
    database = open_database(fresh_sqlite(tmp_path / "some.sqlite"))
    with database.reading() as reader:
        reader.connection().exec_driver_sql("SELECT count(*) FROM sessions").fetchall()
        with database.writing() as db:
            db.connection().exec_driver_sql("CREATE TABLE later (x)")
        Checkpointer(database).turn()
    with database.reading() as db:
        assert db.connection().exec_driver_sql("SELECT count(*) FROM later").scalar() == 0
    database.close()


def test_a_fully_copied_log_is_not_copied_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The log is copied only if something was committed since the last complete copy."""
    database = open_database(fresh_sqlite(tmp_path / "some.sqlite"))
    with database.writing() as db:
        db.connection().exec_driver_sql("CREATE TABLE some (x)")
    now_s = itertools.count(0.0, 10.0)
    checkpointer = Checkpointer(database, lambda: next(now_s))
    copies: list[bool] = []
    copy = checkpointer._copy

    def counted() -> bool:
        copies.append(copy())
        return copies[-1]

    monkeypatch.setattr(checkpointer, "_copy", counted)
    for _ in range(3):
        checkpointer.turn()
    assert copies == []
    with database.writing() as db:
        db.connection().exec_driver_sql("INSERT INTO some VALUES (1)")
    for _ in range(3):
        checkpointer.turn()
    assert copies == [True, True]
    database.close()
