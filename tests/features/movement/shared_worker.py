"""One worker process for all applications of a package's tests, as starting one takes seconds."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from app.platform.workers import Worker


class SharedWorker(Worker):
    """A worker that outlives the applications that use it."""

    def end(self) -> None:
        """Ignore the end of an application, so that the process serves the next one."""


@contextmanager
def shared_worker(prepare: Callable[[], None], *makers: tuple[object, str]) -> Iterator[None]:
    """Make factories, given by module and name, return one shared worker; end it afterwards."""
    worker = SharedWorker(prepare)
    with pytest.MonkeyPatch.context() as patch:
        for module, name in makers:
            patch.setattr(module, name, lambda *_arguments: worker)
        yield
    Worker.end(worker)
