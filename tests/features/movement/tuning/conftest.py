"""Fixtures that let one process tune for all applications in this package."""

from collections.abc import Iterator

import pytest

from app.features.movement.tuning import desk, tuning_queue
from tests.features.movement.shared_worker import shared_worker


@pytest.fixture(scope="package", autouse=True)
def _one_process() -> Iterator[None]:
    with shared_worker(desk.load, (desk, "Worker"), (tuning_queue, "new_worker")):
        yield
