"""What is computed of a phase once its frames are on disk, in the background.

All summaries of a phase are stored together, in place of older ones, and all can be computed again
from the stored frames at any time.
"""

import logging
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from app.features.context import AppContext
from app.features.sessions.capture import erased_session, not_erased
from app.features.sessions.service import session_by_id
from app.features.telemetry.joint_errors import joint_error_rows
from app.features.telemetry.latencies import history_s, latency_rows
from app.features.telemetry.movement import Run, phase_runs
from app.features.telemetry.quality_rows import quality_rows
from app.models import JointErrorRow, Phase, PhaseLatency, PhaseQuality

log = logging.getLogger(__name__)
Row = JointErrorRow | PhaseLatency | PhaseQuality
Summary = Callable[[Phase, Sequence[Run]], Sequence[Row]]

SUMMARIES: dict[type[Row], Summary] = {
    JointErrorRow: joint_error_rows,
    PhaseLatency: latency_rows,
    PhaseQuality: quality_rows,
}
"""Each table with what fills it."""


@dataclass
class Summariser:
    """Computes summaries in the background, one phase at a time."""

    context: AppContext
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="summaries")
    )

    def phase_ended(self, session_id: str, phase_id: int) -> None:
        """Queue a phase whose last frame is on disk."""
        self._pool.submit(self._run, session_id, phase_id)

    def catch_up(self) -> None:
        """Queue every phase that ended without summaries, as after a crash or an update.

        Every phase gets rows of its streams' quality, if only to say that it has no frames: where
        they are missing, all is.
        """
        has_quality = select(PhaseQuality.phase_id).where(
            PhaseQuality.session_id == Phase.session_id, PhaseQuality.phase_id == Phase.phase_id
        )
        with self.context.database.reading() as db:
            missing = db.execute(
                select(Phase.session_id, Phase.phase_id)
                .where(Phase.status == "done", ~has_quality.exists(), not_erased(Phase.session_id))
                .order_by(Phase.session_id, Phase.phase_id)
            ).all()
        for session_id, phase_id in missing:
            self.phase_ended(session_id, phase_id)

    def stop(self) -> None:
        """Finish the phase under way and end; what waits is caught up at the next start."""
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _run(self, session_id: str, phase_id: int) -> None:
        try:
            with self.context.database.reading() as db:
                rows = summary_rows(db, session_id, phase_id)
            with self.context.database.writing() as db:
                session_by_id(db, session_id, lock=True)
                if erased_session(db, session_id):
                    return
                replace_rows(db, session_id, phase_id, rows)
        except Exception:
            log.exception("summaries of phase %s of %s failed", phase_id, session_id)
        else:
            self.context.hub.publish(session_id, "session")


def summary_rows(db: Session, session_id: str, phase_id: int) -> list[Row]:
    """All summaries of a phase from its stored frames, which are read once."""
    phase = db.get_one(Phase, (session_id, phase_id))
    runs = phase_runs(db, session_id, phase_id, history_s=history_s(phase))
    return [row for compute in SUMMARIES.values() for row in compute(phase, runs)]


def replace_rows(db: Session, session_id: str, phase_id: int, rows: Sequence[Row]) -> None:
    """Store the summaries of a phase in place of older ones."""
    for table in SUMMARIES:
        db.execute(delete(table).where(table.session_id == session_id, table.phase_id == phase_id))
    db.add_all(rows)
