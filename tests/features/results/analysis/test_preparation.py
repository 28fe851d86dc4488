"""Tests of figures that are prepared after a session, and of how results are forgotten."""

from concurrent.futures import CancelledError
from dataclasses import dataclass

import pytest

from app.clock import Clock
from app.database import Database
from app.features.results.analysis.drawing import DrawingRequest, Drawings
from app.features.results.analysis.preparation import IN_ORDER, SETTLED_S, FigurePreparation
from app.models import Phase
from app.platform.background import Background
from tests.features.builders import NOW, STUDY, SessionSpec, build_session
from tests.features.results.analysis.workers import EmptyWorker, HeldWorker, KilledWorker

MANY_S = 10_000.0


@dataclass
class Desk:
    """Drawings with their preparation, whose clock the test sets."""

    drawings: Drawings
    worker: EmptyWorker
    preparation: FigurePreparation
    now_s: float = 0.0

    @classmethod
    def of(cls, database: Database) -> "Desk":
        """Return the desk of a database, whose results are empty."""
        worker = EmptyWorker()
        url = database.engine.url.render_as_string(hide_password=False)
        drawings = Drawings(database, url, lambda: NOW, _worker=worker, _tester=EmptyWorker())
        background = Background(Clock())
        desk: Desk = cls(
            drawings,
            worker,
            FigurePreparation(database, drawings, background, lambda: int(1e9 * desk.now_s)),
        )
        return desk

    def look(self, now_s: float) -> int:
        """Look for changes at a time; return how many results were made."""
        before, self.now_s = self.worker.made, now_s
        self.preparation.look()
        return self.worker.made - before


@pytest.mark.one_engine
def test_figures_are_ready_after_a_session_has_ended(database: Database) -> None:
    """After a session has ended, its figures are made without a request.

    While somebody is in a phase, they wait.
    """
    desk = Desk.of(database)
    assert desk.look(0.0) == 0
    with database.writing() as db:
        session = build_session(db, SessionSpec("P-0001"))
        moving = build_session(db, SessionSpec("P-0002", status="active"))
        phase = db.query(Phase).filter(Phase.session_id == moving.id).first()
        assert phase is not None
        phase.status = "running"
        key = (phase.session_id, phase.phase_id)
    assert session.status == "completed"
    assert desk.look(10.0) == 0
    assert desk.look(10.0 + SETTLED_S + 1.0) == 0
    with database.writing() as db:
        db.get_one(Phase, key).status = "done"
    assert desk.look(20.0 + SETTLED_S) == len(IN_ORDER)
    assert desk.look(MANY_S) == 0
    assert desk.drawings.dashboard(STUDY, "people", group="tasks")[1] is True
    assert desk.drawings.statistics(STUDY, "people")[1] is True
    assert desk.worker.made == len(IN_ORDER)


@pytest.mark.one_engine
def test_a_server_that_starts_prepares_what_it_finds(database: Database) -> None:
    """A server that starts makes the figures of the sessions that have ended before."""
    with database.writing() as db:
        build_session(db, SessionSpec("P-0001"))
    desk = Desk.of(database)
    assert desk.look(0.0) == 0
    assert desk.look(SETTLED_S) == len(IN_ORDER)


@pytest.mark.one_engine
def test_what_was_drawn_during_an_erasure_is_not_kept(database: Database) -> None:
    """Figures are dropped at an erasure, also those that were being drawn."""
    worker = HeldWorker()
    drawings = Drawings(database, str(database.engine.url), lambda: NOW, _worker=worker)
    request = DrawingRequest("dashboard", STUDY, "people", group="progress")
    first = drawings.prepare(request)
    worker.held[0].set_result(b"{}")
    assert first is not None
    assert first.done()
    assert drawings.prepare(request) is None
    drawings.forget(STUDY)
    second = drawings.prepare(request)
    drawings.forget(STUDY)
    worker.held[1].set_result(b"{}")
    assert second is not None
    assert second.exception() is not None
    assert drawings.prepare(request) is not None


@pytest.mark.one_engine
def test_an_erasure_does_not_wait_for_the_results_that_it_ends(database: Database) -> None:
    """An erasure ends the processes with their work, and whoever waits for that work is told."""
    worker, tester = KilledWorker(), KilledWorker()
    url = str(database.engine.url)
    drawings = Drawings(database, url, lambda: NOW, _worker=worker, _tester=tester)
    figures = drawings.prepare(DrawingRequest("dashboard", STUDY, "people"))
    tests = drawings.prepare(DrawingRequest("statistics", STUDY, "people"))
    drawings.forget(STUDY)
    assert (worker.is_ended, tester.is_ended) == (True, True)
    assert isinstance(figures and figures.exception(0), CancelledError)
    assert isinstance(tests and tests.exception(0), CancelledError)


@pytest.mark.one_engine
def test_idle_tests_end_while_others_results_are_stored(database: Database) -> None:
    """The process for tests is ended without holding up the results of what it did before."""
    tester = KilledWorker()
    url = str(database.engine.url)
    drawings = Drawings(database, url, lambda: NOW, _worker=HeldWorker(), _tester=tester)
    drawings.prepare(DrawingRequest("statistics", STUDY, "people"))
    # An erasure has just taken the process away, and its last results are still being dealt with.
    drawings._in_progress.clear()
    drawings.end_tester()
    assert tester.is_ended
