"""Fixtures with a real server per module, on each engine."""

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

from app.database import open_database
from tests.features.lab import ok
from tests.features.record.headset.site import Site
from tests.support.postgres import fresh_postgres
from tests.support.server import ADMIN_PASSWORD, LiveServer
from tests.support.sqlite import fresh_sqlite


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def site(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Site]:
    """Yield a server with a signed-in operator; each test creates its own sessions."""
    with running_site(request.param, tmp_path_factory.mktemp("site"), {}) as site:
        yield site


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def quick_site(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Site]:
    """Yield a server that counts a headset as silent after one second."""
    quick = {"REEMBODY_HEADSET_SILENT_S": "1"}
    with running_site(request.param, tmp_path_factory.mktemp("site"), quick) as site:
        yield site


@contextmanager
def running_site(engine: str, folder: Path, settings: Mapping[str, str]) -> Iterator[Site]:
    """Run a server on an engine with these `REEMBODY_*` settings for the duration of the block."""
    with ExitStack() as stack:
        if engine == "postgresql":
            url = stack.enter_context(fresh_postgres())
        else:
            url = fresh_sqlite(folder / "reembody.sqlite")
        environment = {"REEMBODY_DATABASE_URL": url, **settings}
        server = stack.enter_context(LiveServer(folder, environment=environment))
        operator = stack.enter_context(server.client())
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        ok(operator.post("/api/login", json=credentials))
        database = open_database(url)
        stack.callback(database.close)
        yield Site(server, operator, database)
