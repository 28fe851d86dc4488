"""Tests of how the bytes of erased rows are overwritten while others use the database.

That no byte of a person is left is tested in `tests/faults/test_erasure.py`.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from sqlalchemy import select

from app.database import Database, open_database
from app.features.record.erasure import is_overwritten, mark_erasure
from app.features.record.erasure.overwriting import overwrite
from app.models import Account, Participant
from app.settings import Settings
from tests.features.builders import SessionSpec, build_session, build_study


@pytest.fixture
def database(sqlite_url: str) -> Iterator[Database]:
    """Provide a SQLite database with the shipped studies."""
    opened = open_database(sqlite_url)
    with opened.writing() as db:
        build_study(db)
    yield opened
    opened.close()


@contextmanager
def a_reader(database: Database) -> Iterator[None]:
    """Hold a reading transaction open, which keeps the log from being truncated."""
    with database.reading() as db:
        db.scalars(select(Account)).all()
        yield


def test_others_write_while_a_reader_keeps_the_log(database: Database, tmp_path: Path) -> None:
    """A reader delays the overwriting: others write meanwhile, and it is finished afterwards."""
    settings = Settings(data_dir=tmp_path, database_url=str(database.engine.url))
    mark_erasure(settings)
    results: list[bool] = []
    overwriting = threading.Thread(target=lambda: results.append(overwrite(database, settings)))
    with a_reader(database):
        with database.writing() as db:
            build_session(db, SessionSpec("P-0001"))
        overwriting.start()
        for number in range(2, 5):
            with database.writing() as db:
                build_session(db, SessionSpec(f"P-{number:04}"))
        assert (results, is_overwritten(settings)) == ([], False)
    overwriting.join()
    assert (results, is_overwritten(settings)) == ([True], True)
    with database.reading() as db:
        assert set(db.scalars(select(Participant.code))) == {f"P-{n:04}" for n in range(1, 5)}


def test_what_a_reader_prevents_is_left_to_the_next_start(
    database: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A reader who does not end postpones the overwriting, and the marker says so."""
    monkeypatch.setattr("app.features.record.erasure.overwriting.TRIES", 2)
    settings = Settings(data_dir=tmp_path, database_url=str(database.engine.url))
    mark_erasure(settings)
    with a_reader(database):
        with database.writing() as db:
            build_session(db, SessionSpec("P-0001"))
        assert overwrite(database, settings) is False
        assert not is_overwritten(settings)
    assert overwrite(database, settings, starting=True) is True
    assert is_overwritten(settings)
