"""Fixtures that let one process simulate for all applications in this package."""

from collections.abc import Iterator

import pytest

from app.features.results.pilot import pilot_queue
from tests.features.lab import Lab, ok
from tests.features.movement.shared_worker import shared_worker
from tests.features.results.pilot.pilots import short_study


def nothing() -> None:
    """Prepare nothing in the process."""


@pytest.fixture(scope="package", autouse=True)
def _one_process() -> Iterator[None]:
    with shared_worker(nothing, (pilot_queue, "new_worker")):
        yield


@pytest.fixture(scope="module")
def study(lab: Lab) -> Lab:
    """Return the application with the short study in it."""
    ok(lab.operator.post("/api/studies", json={"yaml": short_study()}))
    return lab
