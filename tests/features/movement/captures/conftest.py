"""A fixture that lets one process read the captures of all applications in this package."""

from collections.abc import Iterator

import pytest

from app.features.movement.captures import capture_queue
from tests.features.movement.shared_worker import shared_worker


@pytest.fixture(scope="package", autouse=True)
def _one_process() -> Iterator[None]:
    with shared_worker(capture_queue.limit_memory, (capture_queue, "Worker")):
        yield
