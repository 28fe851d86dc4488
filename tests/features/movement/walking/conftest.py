"""Fixtures that let one process fit models for all applications in this package."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.features.movement.walking import fit_queue, prediction_queue
from app.features.movement.walking.fit_queue import FitQueue
from tests.features.lab import Lab
from tests.features.movement.shared_worker import shared_worker


@pytest.fixture(scope="package", autouse=True)
def _one_process() -> Iterator[None]:
    with shared_worker(
        prediction_queue.load, (prediction_queue, "Worker"), (fit_queue, "new_worker")
    ):
        yield


@pytest.fixture(scope="module")
def walking_lab(lab: Lab, tmp_path_factory: pytest.TempPathFactory) -> Lab:
    """Return the module's application with a separate folder for its fits."""
    lab.context.part(FitQueue).folder = Path(tmp_path_factory.mktemp("fits"))
    return lab
