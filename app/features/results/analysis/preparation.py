"""Draw the figures of a study after a session has ended, so that nobody has to wait for them.

The page's groups of figures and the study's tests are made without a filter, one after the other,
in the worker processes of `Drawings`, while no phase is running. Only the number and the versions
of sessions that have ended are looked at regularly, which takes a millisecond.
"""

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import wait
from dataclasses import dataclass, field
from typing import Self, cast, get_args

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.database import Database
from app.features.results.analysis.drawing import DrawingRequest, Drawings
from app.features.results.analysis.schemas import DashboardKind, FigureGroup
from app.models import Phase, Study, StudySession
from app.platform.background import Background
from app.platform.context import AppContext, Part

THREAD = "figure-preparation"
LOOK_EVERY_S = 5.0
SETTLED_S = 30.0
"""How long after the last session ended: several often end together, and summaries follow."""
STARTED_S = 5.0
"""How long after the first look, when the server has answered its first pages."""
AGAIN_S = 180.0
"""When to look once more whether a late summary has changed the data."""
AT_START = 3
"""How many studies and kinds to prepare at the server's start, those of the newest sessions."""
IN_MOTION = ("running", "walk_back", "freezing")
"""The states of a phase in which somebody moves, so that the processor is needed."""
IN_ORDER: tuple[FigureGroup, ...] = (
    *("embodiment", "tasks", "movement", "answers", "demographics", "progress", "quality"),
)
"""The groups of figures in the order in which the page requests them."""
Place = tuple[str, DashboardKind]
"""A study's key and a kind of sessions."""
Ended = tuple[int, int]
"""The number of ended sessions and the sum of their versions, which changes with each of them."""


@dataclass
class _Change:
    """When the ended sessions of a place last changed, and when its figures are to be made."""

    ended: Ended
    due_s: list[float]


@dataclass(eq=False)
class FigurePreparation(Part):
    """Makes the figures and tests of studies whose ended sessions have changed."""

    database: Database
    drawings: Drawings
    background: Background
    monotonic_ns: Callable[[], int]
    _changes: dict[Place, _Change] = field(default_factory=dict)
    _has_looked: bool = False
    _stop: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the preparation of a server's figures."""
        clock = context.clock
        return cls(context.database, context.part(Drawings), context.background, clock.monotonic_ns)

    def start(self) -> None:
        """Start the thread that looks for changes."""
        self._thread = self.background.thread(THREAD, self._run)

    def stop(self) -> None:
        """Stop the thread, without waiting for figures in progress."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(timeout=10.0)

    def _run(self) -> None:
        while not self._stop.wait(LOOK_EVERY_S):
            self.look()
            self.background.recovered(THREAD)

    def look(self) -> None:
        """Note which ended sessions have changed, and make the figures that are due."""
        with self.database.reading() as db:
            self._note(_ended_sessions(db))
            due = [place for place, one in self._changes.items() if self._is_due(one)]
            if not due or _is_busy(db):
                return
        for place in due:
            change = self._changes[place]
            begun_s = self._now_s()
            if self._prepare(place):
                change.due_s = [at_s for at_s in change.due_s if at_s > begun_s]

    def _note(self, found: dict[Place, Ended]) -> None:
        now_s = self._now_s()
        for number, (place, ended) in enumerate(found.items()):
            known = self._changes.get(place)
            if known is not None and known.ended == ended:
                continue
            if self._has_looked:
                due_s = [now_s + SETTLED_S, now_s + AGAIN_S]
            else:
                due_s = [now_s + STARTED_S] if number < AT_START else []
            self._changes[place] = _Change(ended, due_s)
        self._has_looked = True

    def _now_s(self) -> float:
        return self.monotonic_ns() / 1e9

    def _is_due(self, change: _Change) -> bool:
        return any(at_s <= self._now_s() for at_s in change.due_s)

    def _prepare(self, place: Place) -> bool:
        """Make what is missing of a place; return False if it has to wait for a quieter time."""
        for request in _standard(place):
            with self.database.reading() as db:
                if self._stop.is_set() or _is_busy(db):
                    return False
            making = self.drawings.prepare(request)
            # If it fails, `Drawings` has logged it, and whoever asks for it is told.
            while making is not None and not making.done() and not self._stop.is_set():
                wait([making], LOOK_EVERY_S)
        self.drawings.end_tester()
        return True


def _standard(place: Place) -> Iterator[DrawingRequest]:
    """Yield what the pages of a study's results request first."""
    study_key, kind = place
    for group in IN_ORDER:
        yield DrawingRequest("dashboard", study_key, kind, group=group)
    yield DrawingRequest("statistics", study_key, kind)


def _ended_sessions(db: Session) -> dict[Place, Ended]:
    """Return the ended sessions of every study and kind, those with the newest first."""
    query = (
        select(
            Study.key,
            StudySession.kind,
            func.count(),
            func.sum(StudySession.version),
        )
        .join(Study, Study.id == StudySession.study_id)
        .where(
            StudySession.ended_at.is_not(None),
            StudySession.kind.in_(get_args(DashboardKind)),
            Study.archived_at.is_(None),
        )
        .group_by(Study.key, StudySession.kind)
        .order_by(func.max(StudySession.ended_at).desc(), Study.key, StudySession.kind)
    )
    return {
        (key, cast("DashboardKind", kind)): (number, int(versions))
        for key, kind, number, versions in db.execute(query)
    }


def _is_busy(db: Session) -> bool:
    """Return whether somebody is moving in a phase now."""
    query = (
        select(Phase.phase_id)
        .join(StudySession, StudySession.id == Phase.session_id)
        .where(StudySession.status == "active", Phase.status.in_(IN_MOTION))
        .limit(1)
    )
    return db.scalar(query) is not None
