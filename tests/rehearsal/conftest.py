"""Provide one rehearsal on each database, performed once for all tests of this folder."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy.orm import Session

from app.database import open_database
from app.rehearsal.rehearse import RehearsalPlan
from tests.rehearsal.performed import (
    BRIEF,
    LONGER,
    SHIPPED,
    SHORT,
    STUDY,
    Performed,
    performed_once,
)
from tests.support import postgres
from tests.support.shared_run import once

CAPTURE = Path("motion") / "cmu_bvh" / "02_01.bvh"
SPEED = 20.0


PERFORMED = [
    "sqlite, captured movement",
    "postgresql",
    pytest.param("sqlite, shipped length", marks=pytest.mark.long),
]


@pytest.fixture(scope="module", params=PERFORMED)
def performed(request: pytest.FixtureRequest) -> Performed:
    """Provide a finished rehearsal at high speed with short phases, on each database.

    Each database has a different seed: the tests must pass whatever the participant does. On
    PostgreSQL phases are too brief for a task with the foot, except in the long form.
    """
    long = request.config.getoption("--long")
    brief, short = (LONGER, LONGER) if long else (BRIEF, SHORT)
    if request.param == "postgresql":
        url = _kept_postgres()
        plan = RehearsalPlan(url="", study=STUDY, speed=2 * SPEED, seed=2)
        environment = {"REEMBODY_DATABASE_URL": url}
        return performed_once("rehearsal-postgresql", plan, url, environment, brief)
    shared_data: Path = request.getfixturevalue("shared_data")
    plan = RehearsalPlan(url="", study=STUDY, speed=SPEED, seed=1, capture=shared_data / CAPTURE)
    if request.param == "sqlite, shipped length":
        return performed_once("rehearsal-shipped", plan, None, {}, SHIPPED)
    return performed_once("rehearsal-sqlite", plan, None, {}, short)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Extend the timeout, since the first test waits minutes for the whole rehearsal."""
    for item in items:
        if "performed" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.timeout(900))


@pytest.fixture
def db(performed: Performed) -> Iterator[Session]:
    """Provide a database session on the rehearsal's record."""
    database = open_database(performed.database_url)
    try:
        with database.reading() as session:
            yield session
    finally:
        database.close()


def _kept_postgres() -> str:
    """Return the URL of a database that all test processes share for the whole run."""
    cluster = postgres.migrated_cluster()
    with once("rehearsal-database") as mark:
        if mark:
            cluster.execute(f"CREATE DATABASE {{}} TEMPLATE {postgres.TEMPLATE}", "rehearsal")
            mark.touch()
    return cluster.url("rehearsal")
