"""Read a session's stored record while no server runs, as the next start will find it."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.database import open_database
from app.features.record.sessions import certain_active_s, plan_of, state_of
from app.features.record.telemetry import positions_of
from app.models import ClientReport, TelemetryBatch, TelemetryChunk
from app.platform.access import session_by_id
from app.wire.messages import REPORT_STREAM
from tests.faults.schedule import kind_of
from tests.rehearsal.ledger import Key
from tests.support.server import LiveServer


@contextmanager
def record_of(server: LiveServer) -> Iterator[Session]:
    """Open the database of a server, which need not be running."""
    database = open_database(f"sqlite:///{server.data_dir / 'reembody.sqlite'}")
    try:
        with database.reading() as db:
            yield db
    finally:
        database.close()


@dataclass(frozen=True)
class OnDisk:
    """The stored state of a session: its position in the plan and the position of each stream.

    `held` counts the rows' frames of each stream; it equals `stored` unless data are stored twice
    or missing.
    """

    version: int
    step: int | None
    kind: str
    phase_id: int | None
    active_s: float
    stored: dict[Key, int]
    held: dict[Key, int]


def read_record(db: Session, session_id: str) -> OnDisk:
    """Read the stored record of one session."""
    session = session_by_id(db, session_id)
    state, plan = state_of(session), plan_of(db, session)
    phase = state.phase
    step_kind = None if state.current is None else plan[state.current].kind
    active_s = 0.0
    if phase is not None:
        active_s = max(phase.active_s, certain_active_s(db, session_id, phase.phase_id))
    stored = {(row.stream, row.epoch): row.next_seq for row in positions_of(db, session_id)}
    return OnDisk(
        version=session.version,
        step=state.current,
        kind=kind_of(state.current, step_kind, None if phase is None else str(phase.status)),
        phase_id=None if phase is None else phase.phase_id,
        active_s=active_s,
        stored=stored,
        held={key: _held(db, session_id, key) for key in stored},
    )


def _held(db: Session, session_id: str, key: Key) -> int:
    stream, epoch = key
    if stream == REPORT_STREAM:
        count = select(func.count()).where(
            ClientReport.session_id == session_id, ClientReport.epoch == epoch
        )
        return db.scalar(count) or 0
    total = 0
    for table in (TelemetryChunk, TelemetryBatch):
        counted = select(func.sum(table.frame_count)).where(
            table.session_id == session_id, table.stream == stream, table.epoch == epoch
        )
        total += db.scalar(counted) or 0
    return total
