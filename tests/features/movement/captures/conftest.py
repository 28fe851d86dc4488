"""One process reads the captures of all applications here: to start one takes seconds."""

from collections.abc import Iterator

import pytest

from app.features.movement.captures import workbench
from app.platform.workers import Worker


class SharedWorker(Worker):
    """Outlives the applications that use it."""

    def end(self) -> None:
        """The next application goes on with it."""


@pytest.fixture(scope="package", autouse=True)
def _one_process() -> Iterator[None]:
    worker = SharedWorker(workbench.limit_memory)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(workbench, "Worker", lambda _prepare: worker)
        yield
    Worker.end(worker)
