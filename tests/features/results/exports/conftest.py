"""A database with the shipped study, on both engines."""

from collections.abc import Iterator

import pytest

from app.database import Database, open_database
from app.wire import StreamName
from tests.features.builders import SessionSpec, build_session, build_study
from tests.features.movement_builders import moving_values, store_chunks


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """A migrated database that knows the shipped studies."""
    database = open_database(database_url)
    with database.writing() as db:
        build_study(db)
    yield database
    database.close()


@pytest.fixture
def filled(database: Database) -> Database:
    """Two people and one simulated session, one person with movement."""
    with database.writing() as db:
        first = build_session(db, SessionSpec("P-0001", open_answer='=HYPERLINK("http://x","y")'))
        build_session(db, SessionSpec("P-0002", status="withdrawn"))
        build_session(db, SessionSpec("SIM-0001", kind="simulated"))
        for seed, stream in enumerate(StreamName):
            store_chunks(db, first.id, stream, range(200), moving_values(200, seed))
    return database
