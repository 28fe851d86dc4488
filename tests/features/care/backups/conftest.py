"""Fixtures with filled databases, for the tests of backups."""

from collections.abc import Iterator

import pytest

from app.database import Database, open_database
from tests.support.filled import fill


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """Yield a database with rows in every table, once on each engine."""
    opened = open_database(database_url)
    fill(opened.engine)
    yield opened
    opened.close()


@pytest.fixture
def sqlite(sqlite_url: str) -> Iterator[Database]:
    """Yield a SQLite database with rows in every table."""
    opened = open_database(sqlite_url)
    fill(opened.engine)
    yield opened
    opened.close()
