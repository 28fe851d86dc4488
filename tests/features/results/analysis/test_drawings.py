"""What the server keeps of the process that draws."""

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


class LateToTell(Future[bytes]):
    """Whoever waits for it goes on long before those that asked to be called are."""

    def add_done_callback(self, fn: Callable[[Future[bytes]], object]) -> None:
        """Call it late."""

        def late(done: Future[bytes]) -> None:
            time.sleep(LATE_S)
            fn(done)

        super().add_done_callback(late)


class Pencil(Worker):
    """Draws in a thread."""

    def submit(self, *_task: Any, **_options: Any) -> Any:
        """Something is drawn at once."""
        drawing = LateToTell()
        threading.Timer(0.01, drawing.set_result, [b"{}"]).start()
        return drawing


@pytest.mark.one_engine
def test_who_waited_gets_what_was_drawn(database: Database) -> None:
    """However late it is kept after the process was done with it."""
    drawings = Drawings(str(database.engine.url), lambda: NOW, _worker=Pencil())
    with database.reading() as db:
        drawn, current = drawings.dashboard(db, STUDY, "people")
    assert (drawn.body, current) == (b"{}", True)
