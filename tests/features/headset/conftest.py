"""A real server for a module, on each engine."""

from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from app.database import open_database
from tests.features.headset.site import Site
from tests.features.lab import ok
from tests.support.postgres import fresh_postgres
from tests.support.server import ADMIN_PASSWORD, LiveServer
from tests.support.sqlite import fresh_sqlite


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def site(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Site]:
    """The server with its operator signed in; each test joins sessions of its own."""
    folder = tmp_path_factory.mktemp("site")
    with ExitStack() as stack:
        if request.param == "postgresql":
            url = stack.enter_context(fresh_postgres())
        else:
            url = fresh_sqlite(folder / "reembody.sqlite")
        environment = {"REEMBODY_DATABASE_URL": url}
        server = stack.enter_context(LiveServer(folder, environment=environment))
        operator = stack.enter_context(server.client())
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        ok(operator.post("/api/login", json=credentials))
        database = open_database(url)
        stack.callback(database.close)
        yield Site(server, operator, database)
