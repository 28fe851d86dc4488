"""A pytest plugin that leaves tests out which need more than this process: `./run check`'s choice.

A test is left out when it asks for a server in a process of its own, for PostgreSQL or for a
browser. Where its fixtures tell, it is deselected before it begins. Where only its body does, the
helper of `tests.support` that would start such a thing calls `needs` and the test is skipped there:
so nothing here, and nobody who writes a test, keeps a list.
"""

import os

import pytest

UNITS_VARIABLE = "REEMBODY_TEST_UNITS"
STARTERS = frozenset({"live_server", "shared_server", "postgres_url", "browser"})
"""The fixtures of `tests/conftest.py` and `tests/e2e` behind which something is started."""


def needs(what: str) -> None:
    """Skip the test that runs, if it is to be left out where it needs `what`."""
    if os.environ.get(UNITS_VARIABLE):
        pytest.skip(f"left to ./run test: it needs {what}")


def pytest_configure() -> None:
    """Tell the worker processes, too."""
    os.environ[UNITS_VARIABLE] = "1"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect what is known to need more."""
    left_out = [item for item in items if _needs_more(item)]
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if not _needs_more(item)]


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """A folder whose tests all need more has nothing to find wrong here."""
    if exitstatus == pytest.ExitCode.NO_TESTS_COLLECTED:
        session.exitstatus = pytest.ExitCode.OK


def _needs_more(item: pytest.Item) -> bool:
    fixtures = set(getattr(item, "fixturenames", ()))
    return bool(STARTERS & fixtures) or "postgresql" in item.name
