"""One process computes for all applications here: to start one takes seconds."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.features.movement.walking import bench, desk
from app.features.movement.walking.desk import FittingDesk
from app.platform.workers import Worker
from tests.features.lab import Lab


class SharedWorker(Worker):
    """Outlives the applications that use it."""

    def end(self) -> None:
        """The next application goes on with it."""


@pytest.fixture(scope="package", autouse=True)
def _one_process() -> Iterator[None]:
    worker = SharedWorker(bench.load)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bench, "Worker", lambda _prepare: worker)
        patch.setattr(desk, "new_worker", lambda: worker)
        yield
    Worker.end(worker)


@pytest.fixture(scope="module")
def walking_lab(lab: Lab, tmp_path_factory: pytest.TempPathFactory) -> Lab:
    """The module's application; its fits have a folder of their own."""
    lab.context.part(FittingDesk).folder = Path(tmp_path_factory.mktemp("fits"))
    return lab
