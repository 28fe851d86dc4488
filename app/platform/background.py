"""What runs beside the requests, and whether it does: threads, queues, workers, watches.

Each has a name. One that ends by an error is noticed, started again where that is safe, and named
by `/api/health` until it works again, or has not failed for a while. Nothing here knows what any of
them does.
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
"""How long a failure is named that nothing has proved to be over: a queue may have no next task."""
Urgency = Literal["critical", "warning"]
State = Literal["failing", "stopped"]


class Failing(BaseModel):
    """Something in the background that has failed, as health and the consoles name it.

    `state`: whether it goes on and is tried again, or has stopped until the server is restarted.
    `times`: how often it failed since it worked last. `error`: the kind of the newest error; what
    it says stands in the log.
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
    """A time, now over, in which something in the background did not work."""

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
    """Safe from any thread. `on_change` is called when something begins or ceases to fail."""

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
        """Have `work` done in a thread; it is begun anew whenever it ends by an error.

        It ends for good when `work` returns, which is how it is stopped. `critical`: the record of
        a running session depends on it.
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
                log.exception("%s ended by an error and is started again", name)
                self.failed(name, error)
                time.sleep(RESTARTS_AFTER_S)
            except BaseException as error:
                log.exception("%s ended for good", name)
                self.failed(name, error, state="stopped")
                raise
            else:
                with self._lock:
                    self._threads.pop(name, None)
                return

    def watch_process(self) -> None:
        """Name every other thread of this process that ends by an error, whoever began it."""
        before = threading.excepthook

        def ended(what: threading.ExceptHookArgs) -> None:
            if what.thread is not None and what.exc_value is not None:
                self.failed(what.thread.name, what.exc_value)
            before(what)

        threading.excepthook = ended

    def watch_loop(self, loop: asyncio.AbstractEventLoop) -> None:
        """The same for tasks of an event loop that ended by an error which nobody looked at."""

        def ended(loop: asyncio.AbstractEventLoop, what: dict[str, Any]) -> None:
            task, error = what.get("task") or what.get("future"), what.get("exception")
            # Without a task it is a connection that broke: nothing of ours.
            if task is not None and isinstance(error, BaseException):
                self.failed("event-loop", error)
            loop.default_exception_handler(what)

        loop.set_exception_handler(ended)

    def watched(self, name: str, done: "Future[Any]") -> None:
        """Take note of how a task of a queue ends; for `Future.add_done_callback`, by name."""
        if done.cancelled():
            return
        error = done.exception()
        if error is None:
            self.well(name)
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
        """Something has failed; it is named from now on."""
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

    def well(self, name: str) -> None:
        """It works, or works again."""
        # Asked for often, and by the writer of all movement: no lock where nothing ever failed.
        if name not in self._troubles:
            return
        with self._lock:
            trouble = self._troubles.pop(name, None)
            if trouble is None:
                return
            self._over(trouble.shown)
        log.warning("%s works again; it did not since %s", name, trouble.shown.since.isoformat())
        self.on_change()

    def failing(self) -> tuple[Failing, ...]:
        """What does not work now, or failed lately, the oldest first."""
        with self._lock:
            self._look_at_threads()
            self._forget_old()
            shown = [trouble.shown for trouble in self._troubles.values()]
        return tuple(sorted(shown, key=lambda one: (one.since, one.name)))

    def take_incidents(self) -> tuple[Incident, ...]:
        """What is over, each once: for whoever puts it on record."""
        if not self._incidents:
            return ()
        with self._lock:
            taken, self._incidents = tuple(self._incidents), []
        return taken

    def _look_at_threads(self) -> None:
        # One may be gone although nobody ended it, as when memory ran out in its last words.
        for name, thread in list(self._threads.items()):
            known = self._troubles.get(name)
            if not thread.is_alive() and (known is None or known.shown.state != "stopped"):
                self.failed(name, RuntimeError("the thread is gone"), state="stopped")

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
