"""Fixtures with running applications for tests over HTTP, on both engines."""

from collections.abc import Iterator

import pytest

from tests.features.lab import Lab, running_lab
from tests.support.postgres import fresh_postgres
from tests.support.sqlite import fresh_sqlite


@pytest.fixture
def fresh_lab(database_url: str) -> Iterator[Lab]:
    """Yield an application on an empty database, for one test alone."""
    with running_lab(database_url) as lab:
        yield lab


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def lab(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    """Yield an application shared by the tests of a module; each creates its own sessions."""
    if request.param == "postgresql":
        with fresh_postgres() as url, running_lab(url) as running:
            yield running
    else:
        file = tmp_path_factory.mktemp("lab") / "reembody.sqlite"
        with running_lab(fresh_sqlite(file)) as running:
            yield running
