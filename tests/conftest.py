"""Fixtures for all tests: shared data, migrated databases, live servers.

Nothing is started or migrated before a test needs it, so a test of pure science stays fast.
"""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.support import postgres, shared_run
from tests.support.forked_workers import use_fork_server
from tests.support.nursery import (
    CHEAP_PASSWORDS,
    STUDIES,
    make_passwords_cheap,
    nursery,
    ship_studies_from,
)
from tests.support.repetitions import repeat_at_length
from tests.support.server import LiveServer
from tests.support.shared_data import SHARED_DATA_VARIABLE, shared_data_folder
from tests.support.shipped_studies import delayed_copies
from tests.support.sqlite import fresh_sqlite
from tests.support.statement_cache import share_statement_caches

# An example's duration depends on the machine, not only on the code.
settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option `--long`, which also runs the tests marked `long`."""
    parser.addoption("--long", action="store_true", help="also run the tests marked `long`")


def pytest_configure(config: pytest.Config) -> None:
    """Create the folder that the run's processes share, unless it exists."""
    if config.getoption("--long"):
        repeat_at_length()
    if not _is_worker(config):
        shared_run.open_run()


def pytest_unconfigure(config: pytest.Config) -> None:
    """Stop and remove everything that the run created, also after an interruption."""
    if not _is_worker(config):
        postgres.stop_cluster()
        shared_run.close_run()


@pytest.fixture(scope="session", autouse=True)
def _cheap_passwords() -> None:
    """Hash passwords cheaply: the usual sixth of a second would be spent a thousand times.

    Commands that the nursery does not start still use the full cost.
    """
    make_passwords_cheap()
    os.environ[CHEAP_PASSWORDS] = "1"


@pytest.fixture(scope="session", autouse=True)
def _compiled_once() -> None:
    """Share compiled SQL: each test has its own database, and most statements are the same."""
    share_statement_caches()


@pytest.fixture(scope="session", autouse=True)
def _delayed_copies() -> None:
    """Ship studies without a physics avatar; see `tests.support.shipped_studies`."""
    folder = delayed_copies()
    ship_studies_from(folder)
    os.environ[STUDIES] = str(folder)


@pytest.fixture(scope="session", autouse=True)
def _cheap_workers() -> None:
    """Fork the worker processes of applications in this process instead of spawning them."""
    use_fork_server(lambda: nursery().workers)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect long tests unless `--long` is given; a skip would suggest a missing requirement."""
    if config.getoption("--long"):
        return
    long = [item for item in items if _is_long(item)]
    if long:
        config.hook.pytest_deselected(items=long)
        items[:] = [item for item in items if not _is_long(item)]


def _is_long(item: pytest.Item) -> bool:
    again = "postgresql" in item.name and item.get_closest_marker("one_engine")
    return bool(item.get_closest_marker("long") or again)


def _is_worker(config: pytest.Config) -> bool:
    return hasattr(config, "workerinput")


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Provide the published data that tests compare with; they are not in the repository."""
    folder = shared_data_folder()
    if not folder.is_dir():
        pytest.skip(f"no shared data in {folder}; {SHARED_DATA_VARIABLE} can name the folder")
    return folder


@pytest.fixture
def sqlite_url(tmp_path: Path) -> str:
    """Provide the URL of a migrated, empty SQLite file."""
    return fresh_sqlite(tmp_path / "reembody.sqlite")


@pytest.fixture
def postgres_url() -> Iterator[str]:
    """Provide the URL of a migrated, empty PostgreSQL database."""
    with postgres.fresh_postgres() as url:
        yield url


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest) -> str:
    """Provide the URL of a migrated, empty database: the test runs on both engines."""
    fixture = {"sqlite": "sqlite_url", "postgresql": "postgres_url"}[request.param]
    return str(request.getfixturevalue(fixture))


@pytest.fixture
def live_server(tmp_path: Path) -> Iterator[LiveServer]:
    """Provide a real server in its own process, on an empty data folder, for this test alone."""
    with LiveServer(tmp_path / "live") as server:
        yield server


@pytest.fixture(scope="module")
def shared_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """Provide one real server for all tests of a module, which must not depend on its state."""
    with LiveServer(tmp_path_factory.mktemp("live")) as server:
        yield server
