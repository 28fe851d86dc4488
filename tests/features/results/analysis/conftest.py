"""Fixtures with the shipped study's database, on both engines."""

from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from app.database import Database, open_database
from tests.features.builders import SessionSpec, build_session, build_study
from tests.support.postgres import fresh_postgres
from tests.support.sqlite import fresh_sqlite


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """Yield a migrated database with the shipped studies."""
    database = open_database(database_url)
    with database.writing() as db:
        build_study(db)
    yield database
    database.close()


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def lasting_database(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Database]:
    """Yield a database for a whole module, which one fixture fills and the tests only read."""
    with ExitStack() as stack:
        if request.param == "sqlite":
            url = fresh_sqlite(tmp_path_factory.mktemp("lasting") / "reembody.sqlite")
        else:
            url = stack.enter_context(fresh_postgres())
        database = open_database(url)
        stack.callback(database.close)
        with database.writing() as db:
            build_study(db)
        yield database


@pytest.fixture(scope="module")
def three_kinds(lasting_database: Database) -> Database:
    """Return a database with three sessions: a person's, a simulated one and a test."""
    with lasting_database.writing() as db:
        build_session(db, SessionSpec("P-0001"))
        build_session(db, SessionSpec("SIM-0001", kind="simulated"))
        build_session(db, SessionSpec("TEST-0001", kind="test"))
    return lasting_database
