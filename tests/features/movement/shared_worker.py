"""One worker process for all applications of a package's tests, as starting one takes seconds."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from app.platform.workers import Worker


class SharedWorker(Worker):
    """A worker that outlives the applications that use it."""

    def end(self) -> None:
        """Keep the process running for the next application."""


@contextmanager
def shared_worker(prepare: Callable[[], None], *makers: tuple[object, str]) -> Iterator[None]:
    """Make each maker (its module and name) return one worker, and end it afterwards."""
    worker = SharedWorker(prepare)
    with pytest.MonkeyPatch.context() as patch:
        for module, name in makers:
            patch.setattr(module, name, lambda *_arguments: worker)
        yield
    Worker.end(worker)
