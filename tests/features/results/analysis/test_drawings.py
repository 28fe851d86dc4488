"""Tests of how the server caches results of the drawing process."""

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

import pytest

from app.database import Database
from app.features.results.analysis.drawing import Drawings
from app.platform.workers import Worker
from tests.features.builders import NOW, STUDY

LATE_S = 0.2


class LateCallbacks(Future[bytes]):
    """A future whose callbacks run long after its waiters have continued."""

    def add_done_callback(self, fn: Callable[[Future[bytes]], object]) -> None:
        """Register a callback that is called late."""

        def late(done: Future[bytes]) -> None:
            time.sleep(LATE_S)
            fn(done)

        super().add_done_callback(late)


class ThreadedWorker(Worker):
    """A worker that draws in a thread."""

    def submit(self, *_task: Any, **_options: Any) -> Any:
        """Start the work in a thread and return a future that is done after 10 ms."""
        drawing = LateCallbacks()
        threading.Timer(0.01, drawing.set_result, [b"{}"]).start()
        return drawing


@pytest.mark.one_engine
def test_a_waiting_request_gets_its_drawing(database: Database) -> None:
    """A request that waits for a drawing gets it, even if it is cached only later."""
    url = str(database.engine.url)
    drawings = Drawings(database, url, lambda: NOW, _worker=ThreadedWorker())
    drawn, current = drawings.dashboard(STUDY, "people")
    assert (drawn.body, current) == (b"{}", True)
