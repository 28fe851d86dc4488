"""A database with the shipped study, on both engines."""

from collections.abc import Iterator

import pytest

from app.database import Database, open_database
from tests.features.builders import build_study


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """A migrated database that knows the shipped studies."""
    database = open_database(database_url)
    with database.writing() as db:
        build_study(db)
    yield database
    database.close()
