"""Dashboards are drawn in a process of their own and kept until the data change.

Drawing a thousand participants takes many seconds of computing. In a thread of the server it would
hold up every running session; so a process does it, which ends with the server. A page gets what
was drawn last at once, with its time and whether newer data are being drawn.
"""

import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures import TimeoutError as NotYet
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from datetime import datetime

from sqlalchemy import func, make_url, select
from sqlalchemy.orm import Session

from app.database import make_engine
from app.errors import NotDurable
from app.features.studies.service import newest_version, study_by_key
from app.models import Phase, PhaseQuality, StudySession

log = logging.getLogger(__name__)
NICENESS = 5
"""Running sessions go first where both want the processor."""
FIRST_WITHIN_S = 180.0
AGAIN_WITHIN_S = 0.05
"""How long a page waits for newer figures before it gets the older ones."""
State = tuple[object, ...]


@dataclass(frozen=True)
class Drawn:
    """A dashboard as JSON, and the state of the data that it shows."""

    body: bytes
    state: State
    at: datetime


@dataclass
class Drawings:
    """What was drawn, by study and kind; a process draws what is missing, one at a time."""

    url: str
    utc_now: Callable[[], datetime]
    _drawn: dict[tuple[str, str], Drawn] = field(default_factory=dict)
    _under_way: dict[tuple[str, str], "Future[bytes]"] = field(default_factory=dict)
    _pool: ProcessPoolExecutor | None = None
    _lock: threading.RLock = field(default_factory=threading.RLock)

    def dashboard(self, db: Session, study_key: str, kind: str) -> tuple[Drawn, bool]:
        """The newest drawing, and whether it shows the data as they are now.

        Raises NotFound for an unknown study, NotDurable where drawing fails.
        """
        name, state = (study_key, kind), state_of_data(db, study_key, kind)
        with self._lock:
            drawn = self._drawn.get(name)
            if drawn is not None and drawn.state == state:
                return drawn, True
            drawing = self._under_way.get(name) or self._begin(name, state)
        try:
            drawing.result(FIRST_WITHIN_S if drawn is None else AGAIN_WITHIN_S)
        except NotYet:
            if drawn is None:
                raise _failed("it takes too long") from None
        except Exception as error:
            raise _failed(type(error).__name__) from error
        with self._lock:
            newest = self._drawn.get(name) or drawn
        if newest is None:
            raise _failed("nothing was drawn")
        return newest, newest.state == state

    def _begin(self, name: tuple[str, str], state: State) -> "Future[bytes]":
        if self._pool is None:
            context = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(1, mp_context=context, initializer=_step_back)
        try:
            drawing = self._pool.submit(draw, self.url, *name)
        except BrokenProcessPool:
            self._pool = None
            return self._begin(name, state)
        self._under_way[name] = drawing
        drawing.add_done_callback(lambda done: self._keep(name, state, done))
        return drawing

    def _keep(self, name: tuple[str, str], state: State, done: "Future[bytes]") -> None:
        with self._lock:
            self._under_way.pop(name, None)
            if done.cancelled():
                return
            error = done.exception()
            if error is None:
                self._drawn[name] = Drawn(done.result(), state, self.utc_now())
            elif isinstance(error, BrokenProcessPool):
                self._pool = None
        if error is not None:
            log.error("the dashboard of %s could not be drawn", name, exc_info=error)

    def end(self) -> None:
        """Let the process go, with what it is drawing."""
        with self._lock:
            pool, self._pool = self._pool, None
        if pool is not None:
            for process in list(getattr(pool, "_processes", {}).values()):
                process.terminate()
            pool.shutdown(wait=True, cancel_futures=True)


def state_of_data(db: Session, study_key: str, kind: str) -> State:
    """What changes whenever a figure might: sessions, events in them, and computed summaries.

    Corrections and erasures are events, too.
    """
    study = study_by_key(db, study_key)
    sessions = (StudySession.study_id == study.id, StudySession.kind == kind)
    counted = select(func.count(), func.coalesce(func.sum(StudySession.version), 0)).where(
        *sessions
    )
    summaries = (
        select(func.count())
        .select_from(PhaseQuality)
        .join(StudySession, StudySession.id == PhaseQuality.session_id)
        .where(*sessions)
    )
    phases = (
        select(func.count())
        .select_from(Phase)
        .join(StudySession, StudySession.id == Phase.session_id)
        .where(*sessions)
    )
    version = newest_version(db, study).number
    return (version, *db.execute(counted).one(), db.scalar(summaries), db.scalar(phases))


def draw(url: str, study_key: str, kind: str) -> bytes:
    """In the other process: the dashboard as JSON."""
    # Loads pandas and plotly, which the server's own process need not hold.
    from app.features.analysis.dashboard import build_dashboard

    engine = make_engine(url, pooled=make_url(url).get_backend_name() != "sqlite")
    try:
        with Session(engine) as db:
            return build_dashboard(db, study_key, kind).model_dump_json().encode()  # type: ignore[arg-type]
    finally:
        engine.dispose()


def _step_back() -> None:
    # Ctrl-C reaches every process of a terminal; when to end is for the server to say.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(os, "nice"):
        os.nice(NICENESS)


def _failed(why: str) -> NotDurable:
    return NotDurable(
        f"the figures could not be drawn: {why}",
        remedy="Reload the page; if it stays, the server's log has the reason.",
    )
