"""What a column gives back is what was stored, or an error that says that it is not."""

from datetime import UTC, datetime, timedelta, timezone

import pytest
from sqlalchemy import text

from app.database import Database, open_database, referenced_row
from app.errors import DamagedValue
from app.models import Account

NOON = datetime(2026, 11, 22, 12, 0, 0, 123456, UTC)


@pytest.fixture
def database(sqlite_url: str) -> Database:
    """One account, made at noon in another zone."""
    database = open_database(sqlite_url)
    there = NOON.astimezone(timezone(timedelta(hours=9)))
    with database.writing() as db:
        db.add(Account(username="ada", password_hash="x", role="admin", created_at=there))
    return database


def created_at(database: Database) -> datetime:
    """As it is read."""
    with database.reading() as db:
        return db.query(Account).one().created_at


def test_a_time_comes_back_in_utc_to_the_microsecond(database: Database) -> None:
    """SQLite keeps no zone."""
    assert created_at(database) == NOON
    assert created_at(database).tzinfo is UTC


def test_a_row_that_leads_nowhere_is_a_damaged_value(database: Database) -> None:
    """Of rows that are never deleted; the others may just have been."""
    with (
        database.reading() as db,
        pytest.raises(DamagedValue, match="'gone' names no row of Account"),
    ):
        referenced_row(db, Account, "gone")


@pytest.mark.parametrize("damaged", ["2026-11-22 12:00:0\x7f", "2026-99-22 12:00:00", 7])
def test_what_is_no_time_is_a_damaged_value(database: Database, damaged: str | int) -> None:
    """One bit of a text is enough; whoever reads it hears that the database is damaged."""
    with database.writing() as db:
        db.execute(text("UPDATE accounts SET created_at = :damaged"), {"damaged": damaged})
    with pytest.raises(DamagedValue, match="where a time should be"):
        created_at(database)
