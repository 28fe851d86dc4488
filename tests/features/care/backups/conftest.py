"""Filled databases on both engines, and ways to look at them."""

from collections.abc import Iterator

import pytest

from app.database import Database, open_database
from tests.support.filled import fill


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """A database with rows in every table."""
    opened = open_database(database_url)
    fill(opened.engine)
    yield opened
    opened.close()


@pytest.fixture
def sqlite(sqlite_url: str) -> Iterator[Database]:
    """A filled SQLite database."""
    opened = open_database(sqlite_url)
    fill(opened.engine)
    yield opened
    opened.close()
