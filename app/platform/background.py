"""Monitor background tasks: threads, queues, worker processes and periodic checks.

Each task has a name. When one ends with an error, it is restarted where that is safe, and
`/api/health` reports it until it works again or has not failed for a while. This module does not
depend on what any of them does.
"""

import asyncio
import logging
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict

from app.clock import Clock

log = logging.getLogger(__name__)
RESTARTS_AFTER_S = 0.5
REMEMBERED_NS = 600_000_000_000
"""How long a failure without a later success is reported: a queue may have no next task."""
Urgency = Literal["critical", "warning"]
State = Literal["failing", "stopped"]


class Failing(BaseModel):
    """A background task that has failed, as reported by the health endpoint and the consoles.

    `state`: "failing" if it is retried, "stopped" until the server is restarted. `times`: how often
    it has failed since it last worked. `error`: the class of the newest error; its message is in
    the log.
    """

    model_config = ConfigDict(frozen=True)

    name: str
    state: State
    urgency: Urgency
    since: datetime
    times: int
    error: str


@dataclass(frozen=True)
class Incident:
    """A period, now over, during which a background task did not work."""

    name: str
    urgency: Urgency
    since: datetime
    until: datetime
    error: str


@dataclass(frozen=True)
class _Trouble:
    shown: Failing
    last_ns: int


@dataclass(eq=False)
class Background:
    """A monitor of background tasks, safe to use from any thread.

    `on_change` is called when a task starts to fail or recovers.
    """

    clock: Clock
    on_change: Callable[[], None] = lambda: None
    _troubles: dict[str, _Trouble] = field(default_factory=dict)
    _critical: set[str] = field(default_factory=set)
    _threads: dict[str, threading.Thread] = field(default_factory=dict)
    _incidents: list[Incident] = field(default_factory=list)
    _lock: threading.RLock = field(default_factory=threading.RLock)

    def thread(
        self, name: str, work: Callable[[], None], *, critical: bool = False
    ) -> threading.Thread:
        """Run `work` in a thread, restarting it whenever it ends with an error.

        The thread ends when `work` returns, which is how to stop it. `critical`: the record of a
        running session depends on it.
        """
        thread = threading.Thread(target=self._keep_doing, args=(name, work), name=name)
        thread.daemon = True
        with self._lock:
            if critical:
                self._critical.add(name)
            self._threads[name] = thread
        thread.start()
        return thread

    def _keep_doing(self, name: str, work: Callable[[], None]) -> None:
        while True:
            try:
                work()
            except Exception as error:
                log.exception("%s ended with an error and is restarted", name)
                self.failed(name, error)
                time.sleep(RESTARTS_AFTER_S)
            except BaseException as error:
                log.exception("%s ended with an error and is not restarted", name)
                self.failed(name, error, state="stopped")
                raise
            else:
                with self._lock:
                    self._threads.pop(name, None)
                return

    def watch_process(self) -> None:
        """Report every other thread of this process that ends with an error, whoever started it."""
        before = threading.excepthook

        def ended(what: threading.ExceptHookArgs) -> None:
            if what.thread is not None and what.exc_value is not None:
                self.failed(what.thread.name, what.exc_value)
            before(what)

        threading.excepthook = ended

    def watch_loop(self, loop: asyncio.AbstractEventLoop) -> None:
        """Report tasks of an event loop that ended with an error that no code retrieved."""

        def ended(loop: asyncio.AbstractEventLoop, what: dict[str, Any]) -> None:
            task, error = what.get("task") or what.get("future"), what.get("exception")
            # An error without a task is a broken connection, not a failure of the server.
            if task is not None and isinstance(error, BaseException):
                self.failed("event-loop", error)
            loop.default_exception_handler(what)

        loop.set_exception_handler(ended)

    def watched(self, name: str, done: "Future[Any]") -> None:
        """Record the outcome of a queue's task under `name`.

        To be called when its future is done.
        """
        if done.cancelled():
            return
        error = done.exception()
        if error is None:
            self.recovered(name)
        else:
            log.error("a task of %s failed", name, exc_info=error)
            self.failed(name, error)

    def failed(
        self,
        name: str,
        error: BaseException,
        *,
        state: State = "failing",
    ) -> None:
        """Record that the named task has failed, and report it from now on."""
        now, now_ns = self.clock.utc_now(), self.clock.monotonic_ns()
        with self._lock:
            before = self._troubles.get(name)
            new = Failing(
                name=name,
                state=state,
                urgency="critical" if name in self._critical else "warning",
                since=now if before is None else before.shown.since,
                times=1 if before is None else before.shown.times + 1,
                error=type(error).__name__,
            )
            self._troubles[name] = _Trouble(new, now_ns)
        if before is None or before.shown.state != state:
            self.on_change()

    def recovered(self, name: str) -> None:
        """Record that the named task works, or works again."""
        # Called often, even by the telemetry writer: skip the lock if nothing has failed.
        if name not in self._troubles:
            return
        with self._lock:
            trouble = self._troubles.pop(name, None)
            if trouble is None:
                return
            self._over(trouble.shown)
        log.warning("%s works again; it had failed since %s", name, trouble.shown.since.isoformat())
        self.on_change()

    def failing(self) -> tuple[Failing, ...]:
        """Return the tasks that fail now or failed recently, oldest first."""
        with self._lock:
            self._look_at_threads()
            self._forget_old()
            shown = [trouble.shown for trouble in self._troubles.values()]
        return tuple(sorted(shown, key=lambda one: (one.since, one.name)))

    def take_incidents(self) -> tuple[Incident, ...]:
        """Return the incidents that are over, each exactly once, for the caller to record."""
        if not self._incidents:
            return ()
        with self._lock:
            taken, self._incidents = tuple(self._incidents), []
        return taken

    def _look_at_threads(self) -> None:
        # A thread may die without reporting it, as when memory runs out while it logs its error.
        for name, thread in list(self._threads.items()):
            trouble = self._troubles.get(name)
            if not thread.is_alive() and (trouble is None or trouble.shown.state != "stopped"):
                self.failed(name, RuntimeError("the thread has died"), state="stopped")

    def _forget_old(self) -> None:
        now_ns = self.clock.monotonic_ns()
        for name, trouble in list(self._troubles.items()):
            lasts = trouble.shown.state == "stopped"
            if not lasts and now_ns - trouble.last_ns > REMEMBERED_NS:
                del self._troubles[name]
                self._over(trouble.shown)

    def _over(self, shown: Failing) -> None:
        self._incidents.append(
            Incident(shown.name, shown.urgency, shown.since, self.clock.utc_now(), shown.error)
        )
