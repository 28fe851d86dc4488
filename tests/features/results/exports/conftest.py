"""Fixtures with the shipped study's database, on both engines."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from app.database import Database, open_database
from app.wire import BODY_STREAMS
from tests.features.builders import SessionSpec, build_session, build_study
from tests.features.movement_builders import moving_values, store_chunks
from tests.support.postgres import fresh_postgres
from tests.support.sqlite import fresh_sqlite


@contextmanager
def with_studies(url: str) -> Iterator[Database]:
    """Yield a migrated database with the shipped studies."""
    database = open_database(url)
    try:
        with database.writing() as db:
            build_study(db)
        yield database
    finally:
        database.close()


def fill(database: Database) -> None:
    """Store sessions of two people, one of them with movement, and a simulated one."""
    with database.writing() as db:
        first = build_session(db, SessionSpec("P-0001", open_answer='=HYPERLINK("http://x","y")'))
        build_session(db, SessionSpec("P-0002", status="withdrawn"))
        build_session(db, SessionSpec("SIM-0001", kind="simulated"))
        for seed, stream in enumerate(BODY_STREAMS):
            store_chunks(db, first.id, stream, range(200), moving_values(200, seed))


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """Yield a migrated database with the shipped studies, for one test alone."""
    with with_studies(database_url) as database:
        yield database


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def filled(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Database]:
    """Yield a filled database for a whole module, as exporting only reads."""
    if request.param == "postgresql":
        with fresh_postgres() as url, with_studies(url) as database:
            fill(database)
            yield database
    else:
        file = tmp_path_factory.mktemp("exports") / "reembody.sqlite"
        with with_studies(fresh_sqlite(file)) as database:
            fill(database)
            yield database
