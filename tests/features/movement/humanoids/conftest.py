"""One process reads the models of all applications in this package."""

from collections.abc import Iterator

import pytest

from app.features.movement.captures import workbench
from tests.features.movement.shared_worker import shared_worker


@pytest.fixture(scope="package", autouse=True)
def _one_process() -> Iterator[None]:
    with shared_worker(workbench.limit_memory, (workbench, "Worker")):
        yield
