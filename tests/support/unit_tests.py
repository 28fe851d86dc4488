"""A pytest plugin for `./run check`: skip tests that need more than this process.

A test is skipped if it needs a server in a process of its own, PostgreSQL or a browser. If its
fixtures show that, it is deselected before it runs. If only its body does, the helper of
`tests.support` that would start such a thing calls `needs` and the test is skipped there: so no
list of tests has to be maintained.
"""

import os

import pytest

UNITS_VARIABLE = "REEMBODY_TEST_UNITS"
STARTERS = frozenset({"live_server", "shared_server", "postgres_url", "browser"})
"""The fixtures of `tests/conftest.py` and `tests/e2e` that start something."""


def needs(what: str) -> None:
    """Skip the running test if tests that need `what` are to be skipped."""
    if os.environ.get(UNITS_VARIABLE):
        pytest.skip(f"left to ./run test: it needs {what}")


def pytest_configure() -> None:
    """Pass the choice on to the worker processes."""
    os.environ[UNITS_VARIABLE] = "1"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect the tests whose fixtures need more than this process."""
    left_out = [item for item in items if _needs_more(item)]
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if not _needs_more(item)]


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """Succeed if all tests of a folder were deselected."""
    if exitstatus == pytest.ExitCode.NO_TESTS_COLLECTED:
        session.exitstatus = pytest.ExitCode.OK


def _needs_more(item: pytest.Item) -> bool:
    fixtures = set(getattr(item, "fixturenames", ()))
    return bool(STARTERS & fixtures) or "postgresql" in item.name
