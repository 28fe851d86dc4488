"""Draw dashboards in a worker process and cache them until the data change.

Drawing a thousand participants takes many seconds of computing. In a thread of the server it would
delay every running session, so a worker process does it, which ends with the server. A page
immediately receives the last figures drawn, with their time and whether they are up to date. The
study's tests are computed and cached in the same way.

Results are only in memory: they contain participants' values, so a file of them would have to be
erased, restored and left out of backups with their data. A server that starts draws them again.
"""

import logging
import threading
from collections import OrderedDict
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError, Future
from concurrent.futures import TimeoutError as NotYet
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Literal, Self

from app.database import Database
from app.errors import NotDurable, ReembodyError
from app.features.results.analysis.schemas import (
    NO_FILTER,
    DashboardKind,
    FigureFilter,
    FigureGroup,
)
from app.features.results.analysis.state import State, state_of_data
from app.platform.context import AppContext, Part
from app.platform.workers import Worker

log = logging.getLogger(__name__)
FIRST_WITHIN_S = 180.0
REFRESH_WITHIN_S = 0.05
"""How long a page waits for newer figures before it gets the older ones."""
MAX_CACHED_BYTES = 64_000_000
ResultKind = Literal["dashboard", "statistics"]
GROUPS: tuple[FigureGroup, ...] = (
    *("embodiment", "answers", "tasks", "movement", "demographics", "quality", "progress"),
)
"""The groups of figures, in the order in which a dashboard of all figures has them."""


@dataclass(frozen=True)
class DrawingRequest:
    """A request for a dashboard or for the study's tests; also the key of the cached result."""

    result_kind: ResultKind
    study_key: str
    kind: DashboardKind
    chosen: FigureFilter = NO_FILTER
    group: FigureGroup | None = None


@dataclass(frozen=True)
class Drawn:
    """A dashboard or the study's tests as JSON, and the state of the data that it was made from."""

    body: bytes
    state: State
    at: datetime


@dataclass
class Drawings(Part):
    """The cached dashboards and tests; a worker process makes what is missing, one at a time.

    The cache holds up to MAX_CACHED_BYTES and evicts the least recently requested results. Tests
    have a worker process of their own: those of a thousand participants take minutes, and figures
    must not wait for them.
    """

    database: Database
    url: str
    utc_now: Callable[[], datetime]
    _cache: "OrderedDict[DrawingRequest, Drawn]" = field(default_factory=OrderedDict)
    _in_progress: dict[DrawingRequest, "Future[None]"] = field(default_factory=dict)
    _worker: Worker = field(default_factory=Worker)
    _tester: Worker = field(default_factory=Worker)
    _forgotten: int = 0
    _lock: threading.RLock = field(default_factory=threading.RLock)

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the cache of a server's dashboards and tests, with its worker processes."""
        background = context.background
        return cls(
            context.database,
            context.settings.resolved_database_url,
            context.clock.utc_now,
            _worker=Worker().watched_by(background, "figures"),
            _tester=Worker().watched_by(background, "statistics"),
        )

    def dashboard(
        self,
        study_key: str,
        kind: DashboardKind,
        chosen: FigureFilter = NO_FILTER,
        group: FigureGroup | None = None,
    ) -> tuple[Drawn, bool]:
        """Return the latest dashboard, and whether it shows the current data.

        `group` limits it to one group of figures. Raises NotFound for an unknown study, NotDurable
        where drawing fails.
        """
        return self._newest(DrawingRequest("dashboard", study_key, kind, chosen, group))

    def statistics(self, study_key: str, kind: DashboardKind) -> tuple[Drawn, bool]:
        """Return the latest results of the study's tests, and whether they are of the current data.

        Raises the same errors as `dashboard`.
        """
        return self._newest(DrawingRequest("statistics", study_key, kind))

    def sheet(
        self, study_key: str, kind: DashboardKind, chosen: FigureFilter, figure: str
    ) -> bytes:
        """Return the rows of one figure as CSV; raise NotFound for an unknown study or figure."""
        future = self._worker.submit(sheet, self.url, study_key, kind, chosen, figure)
        try:
            return future.result(FIRST_WITHIN_S)
        except NotYet:
            raise _failed("it took too long") from None
        except ReembodyError:
            raise
        except Exception as error:
            raise _failed(type(error).__name__) from error

    def prepare(self, request: DrawingRequest) -> "Future[None] | None":
        """Start to make a result for whoever will ask for it.

        Returns the future of the work, or None if the result of the current data is cached.
        """
        state = self._state(request)
        with self._lock:
            drawn = self._cache.get(request)
            if drawn is not None and drawn.state == state:
                return None
            return self._in_progress.get(request) or self._start(request, state)

    def end_tester(self) -> None:
        """End the process for tests if it is idle: its tables are of no use to a later test."""
        with self._lock:
            if any(one.result_kind == "statistics" for one in self._in_progress):
                return
            end = self._tester.let_go()
        end()

    def forget(self, study_key: str) -> None:
        """Delete everything made from a study's data, some of which have just been erased.

        The worker processes end, because their memory contains the study's tables. Requests that
        wait for them start anew.
        """
        with self._lock:
            self._forgotten += 1
            for request in [one for one in self._cache if one.study_key == study_key]:
                del self._cache[request]
            self._in_progress.clear()
            ends = [self._worker.let_go(), self._tester.let_go()]
        # Without the lock, which the results that fail now need.
        for end in ends:
            end()

    def _joined(self, request: DrawingRequest, state: State) -> Drawn | None:
        """Return all figures, joined from their groups if those are cached and current."""
        if request.result_kind != "dashboard" or request.group is not None:
            return None
        found = [self._cache.get(replace(request, group=group)) for group in GROUPS]
        groups = [one for one in found if one is not None and one.state == state]
        if len(groups) < len(GROUPS):
            return None
        body = join_figures([one.body for one in groups])
        return Drawn(body, state, min(one.at for one in groups))

    def _state(self, request: DrawingRequest) -> State:
        """Return the state of the data now.

        In a transaction of its own: one that stayed open while a worker draws would keep an erasure
        from truncating the database's log.
        """
        with self.database.reading() as db:
            return state_of_data(db, request.study_key, request.kind)

    def _newest(self, request: DrawingRequest) -> tuple[Drawn, bool]:
        state = self._state(request)
        with self._lock:
            forgotten = self._forgotten
            drawn = self._joined(request, state) or self._cache.get(request)
            if request in self._cache:
                self._cache.move_to_end(request)
            if drawn is not None and drawn.state == state:
                return drawn, True
            drawing = self._in_progress.get(request) or self._start(request, state)
        try:
            drawing.result(FIRST_WITHIN_S if drawn is None else REFRESH_WITHIN_S)
        except NotYet:
            if drawn is None:
                raise _failed("it took too long") from None
        except Exception as error:
            if self._forgotten != forgotten:
                return self._newest(request)
            raise _failed(type(error).__name__) from error
        with self._lock:
            newest = self._cache.get(request) or drawn
        if newest is None:
            raise _failed("nothing was drawn")
        return newest, newest.state == state

    def _start(self, request: DrawingRequest, state: State) -> "Future[None]":
        worker = self._tester if request.result_kind == "statistics" else self._worker
        drawing = worker.submit(draw, self.url, request)
        # Not the worker's future: whoever waits for that one resumes before the result is cached.
        stored: Future[None] = Future()
        self._in_progress[request] = stored
        begun = self._forgotten
        drawing.add_done_callback(
            lambda done: self._store_result(request, state, begun, done, stored)
        )
        return stored

    def _store_result(
        self,
        request: DrawingRequest,
        state: State,
        begun: int,
        done: "Future[bytes]",
        stored: "Future[None]",
    ) -> None:
        error = CancelledError() if done.cancelled() else done.exception()
        with self._lock:
            if begun != self._forgotten:
                # Made from data that have been erased since.
                error = CancelledError()
            else:
                self._in_progress.pop(request, None)
            if error is None:
                self._cache[request] = Drawn(done.result(), state, self.utc_now())
                self._cache.move_to_end(request)
                self._evict()
        if error is None:
            stored.set_result(None)
            return
        stored.set_exception(error)
        if not isinstance(error, CancelledError):
            log.error(
                "the %s of %s could not be drawn",
                request.result_kind,
                request.study_key,
                exc_info=error,
            )

    def _evict(self) -> None:
        """Evict the least recently requested results; keep the newest, however large it is."""
        size = sum(len(one.body) for one in self._cache.values())
        while size > MAX_CACHED_BYTES and len(self._cache) > 1:
            _, oldest = self._cache.popitem(last=False)
            size -= len(oldest.body)

    def stop(self) -> None:
        """End the worker processes, including any work in progress."""
        with self._lock:
            # What is in progress has not failed.
            self._forgotten += 1
        self._worker.end()
        self._tester.end()


def draw(url: str, request: DrawingRequest) -> bytes:
    """Return a dashboard or the study's test results as JSON; runs in the worker process."""
    # Loads pandas and plotly, which the server's own process does not need.
    from app.features.results.analysis import worker_tasks

    if request.result_kind == "statistics":
        return worker_tasks.compute(url, request.study_key, request.kind)
    return worker_tasks.draw(url, request.study_key, request.kind, request.chosen, request.group)


def sheet(
    url: str, study_key: str, kind: DashboardKind, chosen: FigureFilter, figure: str
) -> bytes:
    """Return the rows of one figure as CSV; runs in the worker process."""
    from app.features.results.analysis import worker_tasks

    return worker_tasks.sheet(url, study_key, kind, chosen, figure)


def join_figures(bodies: Sequence[bytes]) -> bytes:
    """Return the dashboard of all figures from those of its groups, in the order of `GROUPS`.

    All must be of the same data and filter. The figures are the last field of a dashboard.
    """
    # Quotes within a JSON string are escaped, so this is found nowhere else.
    opening = b'"figures":['
    begin = bodies[0].index(opening) + len(opening)
    figures = (body[body.index(opening) + len(opening) : -len(b"]}")] for body in bodies)
    return bodies[0][:begin] + b",".join(filter(None, figures)) + b"]}"


def _failed(why: str) -> NotDurable:
    return NotDurable(
        f"the figures could not be drawn: {why}",
        remedy="Reload the page; if the problem remains, see the server's log.",
    )
