"""Workers that stand for the processes that draw, within the process of a test."""

import threading
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from typing import Any

from app.platform.workers import Worker

WITHIN_S = 10.0
"""How long the results of a process that was ended may take to be dealt with."""


@dataclass
class InlineWorker(Worker):
    """A worker that does its tasks in this process, and counts them."""

    made: int = 0

    def submit(self, task: Callable[..., Any], *args: Any, **_: Any) -> Any:
        """Do a task and return its result as a future that is done."""
        self.made += 1
        done: Future[Any] = Future()
        done.set_result(task(*args))
        return done


class EmptyWorker(InlineWorker):
    """A worker whose results are empty."""

    def submit(self, *_task: Any, **_options: Any) -> Any:
        """Return an empty result as a future that is done."""
        return super().submit(lambda: b"{}")


@dataclass
class HeldWorker(Worker):
    """A worker whose tasks are never done by themselves."""

    held: list["Future[bytes]"] = field(default_factory=list)

    def submit(self, *_task: Any, **_options: Any) -> Any:
        """Return a future that the test completes."""
        self.held.append(Future())
        return self.held[-1]

    def let_go(self) -> Callable[[], None]:
        """Leave the tasks undone, as if each had just been finished."""
        return lambda: None


@dataclass
class KilledWorker(HeldWorker):
    """A worker whose tasks fail in another thread when it is ended, as those of a process do."""

    is_ended: bool = False

    def let_go(self) -> Callable[[], None]:
        """Return what lets the tasks fail and waits until their callbacks have run."""
        return self._fail_all

    def _fail_all(self) -> None:
        failing = threading.Thread(target=self._fail, daemon=True)
        failing.start()
        failing.join(WITHIN_S)
        self.is_ended = not failing.is_alive()

    def _fail(self) -> None:
        for one in self.held:
            one.set_exception(BrokenProcessPool())
