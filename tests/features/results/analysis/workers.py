"""Workers that stand for the processes that draw, within the process of a test."""

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

from app.platform.workers import Worker


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

    def end(self) -> None:
        """Leave the tasks undone, as if each had just been finished."""
