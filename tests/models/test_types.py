"""Tests that column types return what was stored, or raise an error if it is damaged."""

from datetime import UTC, datetime, timedelta, timezone

import pytest
from sqlalchemy import text

from app.database import Database, open_database, referenced_row
from app.errors import DamagedValue
from app.models import Account

NOON = datetime(2026, 11, 22, 12, 0, 0, 123456, UTC)


@pytest.fixture
def database(sqlite_url: str) -> Database:
    """Return a database with one account, created at noon in another time zone."""
    database = open_database(sqlite_url)
    there = NOON.astimezone(timezone(timedelta(hours=9)))
    with database.writing() as db:
        db.add(Account(username="ada", password_hash="x", role="admin", created_at=there))
    return database


def created_at(database: Database) -> datetime:
    """Return the account's time as it is read."""
    with database.reading() as db:
        return db.query(Account).one().created_at


def test_a_time_comes_back_in_utc_to_the_microsecond(database: Database) -> None:
    """A time is returned in UTC to the microsecond, though SQLite stores no time zone."""
    assert created_at(database) == NOON
    assert created_at(database).tzinfo is UTC


def test_a_reference_to_a_missing_row_is_a_damaged_value(database: Database) -> None:
    """A reference to a missing row of a table that never deletes rows raises DamagedValue."""
    with (
        database.reading() as db,
        pytest.raises(DamagedValue, match="'gone' names no row of Account"),
    ):
        referenced_row(db, Account, "gone")


@pytest.mark.parametrize("damaged", ["2026-11-22 12:00:0\x7f", "2026-99-22 12:00:00", 7])
def test_an_invalid_time_is_a_damaged_value(database: Database, damaged: str | int) -> None:
    """A stored value that is not a time raises DamagedValue."""
    with database.writing() as db:
        db.execute(text("UPDATE accounts SET created_at = :damaged"), {"damaged": damaged})
    with pytest.raises(DamagedValue, match="where a time should be"):
        created_at(database)
