"""One run of a study's road: its partners advance in a thread, and the record goes to the disk."""

import hashlib
import logging
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from sqlalchemy.orm import Session

from app.adapters.cosimulation import partners_of_study
from app.errors import ReembodyError
from app.features.record.road.participant import Participant
from app.features.record.road.recording import (
    REFUSED,
    RunPlan,
    store_end,
    store_interruption,
    store_lines,
)
from app.models import RoadRun
from app.platform.context import AppContext
from app.protocol import StudyRoad
from app.science.cosimulation import (
    Clocks,
    Conductor,
    CosimulationError,
    Lateness,
    Record,
    Row,
    Timing,
    header_line,
    step_line,
)
from app.wire import RoadHello

log = logging.getLogger(__name__)
STEPS_IN_CHUNK = 50
LONGEST_S = 4 * 3600.0
"""A scene is over when its phase is; this is only the length of its loop."""
Ended = Callable[[str], None]


@dataclass(frozen=True)
class SceneState:
    """How a scene goes, for the operator.

    `is_heard`: the headset's socket is open. `waits_for`: programs that have not connected yet.
    """

    phase_id: int
    steps: int
    guesses: int
    cars: int
    is_heard: bool
    waits_for: tuple[str, ...]
    problem: str
    is_over: bool


class RoadScene:
    """A scene that runs from `start` until its phase ends.

    `participant`: where the socket says where the person is. `require` raises the reason if nothing
    of the session may be stored; it is called in each transaction that stores. `on_end` is called
    from the scene's thread, with the problem if it broke off; `refusal` is the reason if it did
    because nothing more may be stored.
    """

    def __init__(
        self,
        context: AppContext,
        plan: RunPlan,
        road: StudyRoad,
        participant: Participant,
        require: Callable[[Session], None],
    ) -> None:
        self.plan, self.participant = plan, participant
        self.on_end: Ended | None = None
        self.problem = ""
        self.refusal: ReembodyError | None = None
        self.is_over = False
        self._context, self._road, self._require = context, road, require
        self._lines: list[str] = []
        # Of what is stored; the caller has stored the first line.
        self._hash = hashlib.sha256(header_line(plan.header, road.step_s).encode())
        self._chunk = 1
        self._steps = self._guesses = self._cars = 0
        self._has_begun = False
        self._thread = threading.Thread(target=self._run, name="road", daemon=True)

    def is_of(self, hello: RoadHello) -> bool:
        """Return whether a headset goes on with this scene, after a lost connection."""
        return (hello.run, hello.phase_id) == (self.plan.id, self.plan.phase_id)

    def start(self) -> None:
        """Begin the warm-up."""
        self._thread.start()

    def end(self, *, wait: bool) -> None:
        """Let it be over; `wait` until all of it is stored."""
        self.participant.end()
        if wait:
            self._thread.join()

    @property
    def state(self) -> SceneState:
        """How it goes now."""
        heard = self.participant.is_heard
        now = (self.plan.phase_id, self._steps, self._guesses, self._cars, heard)
        has_begun = self._has_begun or self.is_over
        return SceneState(
            *now,
            () if has_begun else self._road.programs(),
            self.problem,
            self.is_over,
        )

    def _run(self) -> None:
        try:
            self._finish(*self._conducted())
        except REFUSED as refusal:
            self.refusal = refusal
            self._break_off(refusal.message)
        except Exception as error:
            log.exception("the road of session %s has ended", self.plan.session_id)
            self._break_off(f"The scene has failed: {error}")
        finally:
            self.is_over = True
            if self.on_end is not None:
                self.on_end(self.problem)

    def _conducted(self) -> tuple[Record, Timing]:
        """Run the scene to its end; one that cannot begin is like one that has lost a partner."""
        is_over = self.participant.is_over
        try:
            with partners_of_study(self._road, self.plan.seed, is_over) as (partners, _):
                late = self._road.participant_late.lateness()
                # A headset that is away for minutes is waited for: its phase is paused meanwhile.
                patient = Lateness(late.rule, late.patience_s, late.at_most_s, LONGEST_S)
                together = [(self.participant, patient), *partners]
                clocks = Clocks(time.perf_counter, self.participant.pace)
                conductor = Conductor(together, self._road.step_s, clocks)
                steps = round(LONGEST_S / self._road.step_s)
                return conductor.run(steps, self.plan.header, self._note)
        except (CosimulationError, OSError) as error:
            if self._has_begun:
                raise
            return Record(self.plan.header, self._road.step_s, (), (), str(error)), Timing((), {})

    def _note(self, number: int, rows: tuple[Row, ...]) -> None:
        self._steps, self._has_begun = number, True
        self._guesses += sum(row.origin == "guessed" for row in rows)
        self._cars = sum(row.state.kind == "car" for row in rows)
        self._lines.append(step_line(number, rows, self._road.step_s))
        if len(self._lines) >= STEPS_IN_CHUNK:
            self._store()

    def _store(self) -> None:
        """Store the lines so far; if the disk refuses, they wait for the next second.

        Raises:
            Withdrawn, NotNow, NotFound: nothing more of the session may be stored.
        """
        if not self._lines:
            return
        try:
            with self._context.database.writing() as db:
                self._store_with(db, self._lines)
        except REFUSED:
            raise
        except Exception as error:
            log.exception("the road of session %s could not be stored", self.plan.session_id)
            self._context.background.failed("road", error)
            return
        self._context.background.recovered("road")
        self._hash.update("".join(self._lines).encode())
        self._chunk += 1
        self._lines = []

    def _store_with(self, db: Session, lines: list[str]) -> RoadRun:
        """Store lines with whatever else a transaction stores; return the run."""
        self._require(db)
        row = db.get_one(RoadRun, self.plan.id)
        store_lines(db, self.plan.id, self.plan.session_id, self._chunk, lines)
        return row

    def _finish(self, record: Record, timing: Timing) -> None:
        self.problem = record.lost
        lines = [*self._lines, *record.last_lines()]
        with self._context.database.writing() as db:
            row = self._store_with(db, lines)
            # As of the record's bytes, which would take seconds to be written once more.
            whole = self._hash.copy()
            whole.update("".join(lines).encode())
            row.sha256 = whole.hexdigest()
            store_end(db, row, record, self._road, timing, self._context.clock.utc_now())

    def _break_off(self, problem: str) -> None:
        """End the run with what may be stored of it; if the disk refuses, the next run ends it."""
        self.problem = problem
        with suppress(*REFUSED):
            self._store()
        try:
            with self._context.database.writing() as db:
                row = db.get(RoadRun, self.plan.id)
                if row is not None:  # else it was erased meanwhile
                    now = self._context.clock.utc_now()
                    store_interruption(db, row, self._road, problem, now)
        except Exception as error:
            log.exception("the road of session %s could not be ended", self.plan.session_id)
            self._context.background.failed("road", error)
