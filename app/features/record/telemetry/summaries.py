"""Compute the summaries of a phase in the background, once its frames are on disk.

All summaries of a phase are stored together and replace older ones. They can be recomputed from the
stored frames at any time.
"""

import logging
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

from sqlalchemy import ColumnElement, and_, delete, or_, select
from sqlalchemy.orm import Session

from app.features.record.alarms import Change, Condition, store_change
from app.features.record.doubts import doubts_of
from app.features.record.sessions import erased_session, judge_again, not_erased
from app.features.record.telemetry.joint_errors import joint_error_rows
from app.features.record.telemetry.latencies import history_s, latency_rows
from app.features.record.telemetry.movement import Run, phase_runs
from app.features.record.telemetry.quality_rows import quality_rows
from app.models import (
    JointErrorCourseRow,
    JointErrorRow,
    Phase,
    PhaseLatency,
    PhaseQuality,
    TelemetryBatch,
    TelemetryChunk,
)
from app.platform.access import session_by_id
from app.platform.context import AppContext, Part
from app.platform.trouble import explain

log = logging.getLogger(__name__)
SUMMARIES_OF_PHASES = "phase-summaries"
Row = JointErrorRow | JointErrorCourseRow | PhaseLatency | PhaseQuality
Tables = tuple[type[Row], ...]
Summary = Callable[[Phase, Sequence[Run]], Sequence[Row]]

JOINT_ERRORS: Tables = (JointErrorRow, JointErrorCourseRow)
SUMMARIES: dict[Tables, Summary] = {
    JOINT_ERRORS: joint_error_rows,
    (PhaseLatency,): latency_rows,
    (PhaseQuality,): quality_rows,
}
"""The tables of summaries, with the functions that compute their rows."""


@dataclass
class Summariser(Part):
    """Computes summaries of stored phases in the background, one phase at a time."""

    context: AppContext
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="summaries")
    )
    _older: deque[tuple[str, int]] = field(default_factory=deque)

    def phase_ended(self, session_id: str, phase_id: int) -> None:
        """Queue a phase whose last frame is on disk."""
        self._pool.submit(self._run, session_id, phase_id, tuple(SUMMARIES))

    def start(self) -> None:
        """Queue every finished phase that has no summaries, for example after a crash.

        Every phase gets quality rows, even if it has no frames, so if they are missing, all
        summaries are. Phases from a version that did not compute courses of joint errors get these,
        too, one at a time while nothing else is queued.
        """
        with self.context.database.reading() as db:
            missing = _ended(db, ~_has(PhaseQuality))
            self._older.extend(_ended(db, and_(_has(PhaseQuality), _lacks_its_course())))
        for session_id, phase_id in missing:
            self.phase_ended(session_id, phase_id)
        self._take_older()

    def stop(self) -> None:
        """Finish the current phase and stop; queued phases are processed at the next start."""
        self._older.clear()
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _take_older(self) -> None:
        """Queue the next older phase only, so that a phase ending now waits for at most one."""
        if self._older:
            self._pool.submit(self._run_older, *self._older.popleft())

    def _run_older(self, session_id: str, phase_id: int) -> None:
        self._run(session_id, phase_id, (JOINT_ERRORS,))
        self._take_older()

    def _run(self, session_id: str, phase_id: int, selected: Sequence[Tables]) -> None:
        try:
            with self.context.database.reading() as db:
                rows = summary_rows(db, session_id, phase_id, selected)
            with self.context.database.writing() as db:
                session = session_by_id(db, session_id, lock=True)
                if erased_session(db, session_id):
                    return
                replace_rows(db, session_id, phase_id, rows, selected)
                db.flush()
                judge_again(db, session, [one.phase_id for one in doubts_of(db, session_id)])
            self._report_doubts(session_id, phase_id)
        except Exception as error:
            log.exception("summaries of phase %s of %s failed", phase_id, session_id)
            if explain(error) is None:
                self.context.background.failed(SUMMARIES_OF_PHASES, error)
        else:
            self.context.background.recovered(SUMMARIES_OF_PHASES)
            self.context.hub.publish(session_id, "session")

    def _report_doubts(self, session_id: str, phase_id: int) -> None:
        """Raise an alarm about a doubtful phase while the participant can still repeat it."""
        with self.context.database.reading() as db:
            doubts = [one for one in doubts_of(db, session_id) if one.phase_id == phase_id]
        if not doubts:
            return
        now = self.context.clock.utc_now()
        message = f"phase {phase_id} does not count: {'; '.join(one.words for one in doubts)}"
        condition = Condition("doubtful", message)
        with self.context.database.writing() as db:
            if session_by_id(db, session_id, lock=True).ended_at is None:
                # Only one such alarm can be open, so first clear that of an earlier phase.
                store_change(db, session_id, Change("cleared", condition, now))
                store_change(db, session_id, Change("raised", condition, now))
                self.context.hub.publish_after_commit(db, session_id)


def _ended(db: Session, condition: ColumnElement[bool]) -> list[tuple[str, int]]:
    """Return the finished phases that satisfy a condition, in order."""
    query = (
        select(Phase.session_id, Phase.phase_id)
        .where(Phase.status == "done", condition, not_erased(Phase.session_id))
        .order_by(Phase.session_id, Phase.phase_id)
    )
    return [(session_id, phase_id) for session_id, phase_id in db.execute(query)]


def _has(table: type[Row | TelemetryBatch | TelemetryChunk]) -> ColumnElement[bool]:
    """Return the SQL condition that a phase has a row in a table."""
    own = select(table.phase_id).where(
        table.session_id == Phase.session_id, table.phase_id == Phase.phase_id
    )
    return own.exists()


def _lacks_its_course() -> ColumnElement[bool]:
    """Return the SQL condition that a phase has joint errors and frames, but no error course."""
    recorded = or_(_has(TelemetryChunk), _has(TelemetryBatch))
    return and_(_has(JointErrorRow), ~_has(JointErrorCourseRow), recorded)


def summary_rows(
    db: Session, session_id: str, phase_id: int, selected: Sequence[Tables] = tuple(SUMMARIES)
) -> list[Row]:
    """Compute summaries of a phase from its stored frames, which are read once.

    `selected`: which tables to compute; all by default.
    """
    phase = db.get_one(Phase, (session_id, phase_id))
    runs = phase_runs(db, session_id, phase_id, history_s=history_s(phase))
    return [row for tables in selected for row in SUMMARIES[tables](phase, runs)]


def replace_rows(
    db: Session,
    session_id: str,
    phase_id: int,
    rows: Sequence[Row],
    selected: Sequence[Tables] = tuple(SUMMARIES),
) -> None:
    """Store these summaries of a phase, replacing older ones."""
    for table in (one for tables in selected for one in tables):
        db.execute(delete(table).where(table.session_id == session_id, table.phase_id == phase_id))
    db.add_all(rows)
