"""Draw dashboards in a worker process and cache them until the data change.

Drawing a thousand participants takes many seconds of computing. In a thread of the server it would
delay every running session, so a worker process does it, which ends with the server. A page
immediately receives the last figures drawn, with their time and whether they are up to date. The
study's tests are computed and cached in the same way.
"""

import logging
import threading
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from concurrent.futures import TimeoutError as NotYet
from dataclasses import dataclass, field
from datetime import datetime
from typing import Literal, Self

from sqlalchemy.orm import Session

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

    url: str
    utc_now: Callable[[], datetime]
    _cache: "OrderedDict[DrawingRequest, Drawn]" = field(default_factory=OrderedDict)
    _in_progress: dict[DrawingRequest, "Future[None]"] = field(default_factory=dict)
    _worker: Worker = field(default_factory=Worker)
    _tester: Worker = field(default_factory=Worker)
    _lock: threading.RLock = field(default_factory=threading.RLock)

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the cache of a server's dashboards and tests, with its worker processes."""
        background = context.background
        return cls(
            context.settings.resolved_database_url,
            context.clock.utc_now,
            _worker=Worker().watched_by(background, "figures"),
            _tester=Worker().watched_by(background, "statistics"),
        )

    def dashboard(
        self,
        db: Session,
        study_key: str,
        kind: DashboardKind,
        chosen: FigureFilter = NO_FILTER,
        group: FigureGroup | None = None,
    ) -> tuple[Drawn, bool]:
        """Return the latest dashboard, and whether it shows the current data.

        `group` limits it to one group of figures. Raises NotFound for an unknown study, NotDurable
        where drawing fails.
        """
        return self._newest(db, DrawingRequest("dashboard", study_key, kind, chosen, group))

    def statistics(self, db: Session, study_key: str, kind: DashboardKind) -> tuple[Drawn, bool]:
        """Return the latest results of the study's tests, and whether they are of the current data.

        Raises the same errors as `dashboard`.
        """
        return self._newest(db, DrawingRequest("statistics", study_key, kind))

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

    def _newest(self, db: Session, request: DrawingRequest) -> tuple[Drawn, bool]:
        state = state_of_data(db, request.study_key, request.kind)
        with self._lock:
            drawn = self._cache.get(request)
            if drawn is not None:
                self._cache.move_to_end(request)
                if drawn.state == state:
                    return drawn, True
            drawing = self._in_progress.get(request) or self._start(request, state)
        try:
            drawing.result(FIRST_WITHIN_S if drawn is None else REFRESH_WITHIN_S)
        except NotYet:
            if drawn is None:
                raise _failed("it took too long") from None
        except Exception as error:
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
        drawing.add_done_callback(lambda done: self._store_result(request, state, done, stored))
        return stored

    def _store_result(
        self, request: DrawingRequest, state: State, done: "Future[bytes]", stored: "Future[None]"
    ) -> None:
        error = CancelledError() if done.cancelled() else done.exception()
        with self._lock:
            self._in_progress.pop(request, None)
            if error is None:
                self._cache[request] = Drawn(done.result(), state, self.utc_now())
                self._cache.move_to_end(request)
                self._evict()
        if error is None:
            stored.set_result(None)
            return
        stored.set_exception(error)
        if not done.cancelled():
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


def _failed(why: str) -> NotDurable:
    return NotDurable(
        f"the figures could not be drawn: {why}",
        remedy="Reload the page; if the problem remains, see the server's log.",
    )
