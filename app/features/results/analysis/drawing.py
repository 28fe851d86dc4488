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
AGAIN_WITHIN_S = 0.05
"""How long a page waits for newer figures before it gets the older ones."""
MOST_KEPT_BYTES = 64_000_000
What = Literal["dashboard", "statistics"]


@dataclass(frozen=True)
class Asked:
    """A request for a dashboard or for the study's tests; also the key of the cached result."""

    what: What
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

    The cache holds up to MOST_KEPT_BYTES and evicts the least recently requested results. Tests
    have
    a worker process of their own: those of a thousand participants take minutes, and figures must
    not
    wait for them.
    """

    url: str
    utc_now: Callable[[], datetime]
    _drawn: "OrderedDict[Asked, Drawn]" = field(default_factory=OrderedDict)
    _under_way: dict[Asked, "Future[None]"] = field(default_factory=dict)
    _worker: Worker = field(default_factory=Worker)
    _tester: Worker = field(default_factory=Worker)
    _lock: threading.RLock = field(default_factory=threading.RLock)

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the drawings of a server."""
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
        where
        drawing fails.
        """
        return self._newest(db, Asked("dashboard", study_key, kind, chosen, group))

    def statistics(self, db: Session, study_key: str, kind: DashboardKind) -> tuple[Drawn, bool]:
        """Return the latest results of the study's tests, and whether they are of the current data.

        Raises as `dashboard` does.
        """
        return self._newest(db, Asked("statistics", study_key, kind))

    def sheet(
        self, study_key: str, kind: DashboardKind, chosen: FigureFilter, figure: str
    ) -> bytes:
        """Return the rows of one figure as CSV; raise NotFound for an unknown study or figure."""
        making = self._worker.submit(sheet, self.url, study_key, kind, chosen, figure)
        try:
            return making.result(FIRST_WITHIN_S)
        except NotYet:
            raise _failed("it takes too long") from None
        except ReembodyError:
            raise
        except Exception as error:
            raise _failed(type(error).__name__) from error

    def _newest(self, db: Session, asked: Asked) -> tuple[Drawn, bool]:
        state = state_of_data(db, asked.study_key, asked.kind)
        with self._lock:
            drawn = self._drawn.get(asked)
            if drawn is not None:
                self._drawn.move_to_end(asked)
                if drawn.state == state:
                    return drawn, True
            drawing = self._under_way.get(asked) or self._begin(asked, state)
        try:
            drawing.result(FIRST_WITHIN_S if drawn is None else AGAIN_WITHIN_S)
        except NotYet:
            if drawn is None:
                raise _failed("it takes too long") from None
        except Exception as error:
            raise _failed(type(error).__name__) from error
        with self._lock:
            newest = self._drawn.get(asked) or drawn
        if newest is None:
            raise _failed("nothing was drawn")
        return newest, newest.state == state

    def _begin(self, asked: Asked, state: State) -> "Future[None]":
        worker = self._tester if asked.what == "statistics" else self._worker
        drawing = worker.submit(draw, self.url, asked)
        # Not the worker's future: whoever waits for that one resumes before the result is cached.
        kept: Future[None] = Future()
        self._under_way[asked] = kept
        drawing.add_done_callback(lambda done: self._keep(asked, state, done, kept))
        return kept

    def _keep(
        self, asked: Asked, state: State, done: "Future[bytes]", kept: "Future[None]"
    ) -> None:
        error = CancelledError() if done.cancelled() else done.exception()
        with self._lock:
            self._under_way.pop(asked, None)
            if error is None:
                self._drawn[asked] = Drawn(done.result(), state, self.utc_now())
                self._drawn.move_to_end(asked)
                self._let_go()
        if error is None:
            kept.set_result(None)
            return
        kept.set_exception(error)
        if not done.cancelled():
            log.error("the %s of %s could not be made", asked.what, asked.study_key, exc_info=error)

    def _let_go(self) -> None:
        """Evict the least recently requested results; keep the newest, however large it is."""
        size = sum(len(one.body) for one in self._drawn.values())
        while size > MOST_KEPT_BYTES and len(self._drawn) > 1:
            _, oldest = self._drawn.popitem(last=False)
            size -= len(oldest.body)

    def stop(self) -> None:
        """End the worker processes, including any work in progress."""
        self._worker.end()
        self._tester.end()


def draw(url: str, asked: Asked) -> bytes:
    """Return a dashboard or the study's test results as JSON; runs in the worker process."""
    # Loads pandas and plotly, which the server's own process does not need.
    from app.features.results.analysis import in_process

    if asked.what == "statistics":
        return in_process.compute(url, asked.study_key, asked.kind)
    return in_process.draw(url, asked.study_key, asked.kind, asked.chosen, asked.group)


def sheet(
    url: str, study_key: str, kind: DashboardKind, chosen: FigureFilter, figure: str
) -> bytes:
    """Return the rows of one figure as CSV; runs in the worker process."""
    from app.features.results.analysis import in_process

    return in_process.sheet(url, study_key, kind, chosen, figure)


def _failed(why: str) -> NotDurable:
    return NotDurable(
        f"the figures could not be drawn: {why}",
        remedy="Reload the page; if it stays, the server's log has the reason.",
    )
