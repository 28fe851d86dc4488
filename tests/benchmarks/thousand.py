"""Build a study of a thousand participants: a few sessions are built, the others are copied.

Copies have ids of their own. Every row of a completed session exists a thousand times, except for
movement, which no page reads.
"""

from collections.abc import Sequence
from datetime import timedelta
from pathlib import Path
from typing import Any

from sqlalchemy import Column, ColumnElement, Connection, Table, func, insert, literal, select
from sqlalchemy.orm import Session

from app.clock import Clock
from app.database import Base, Database, open_database
from app.features.care.opening import bring_up_to_date
from app.features.design.studies import add_shipped, newest_version, protocol_of, study_by_key
from app.features.movement.avatar import add_shipped_avatar
from app.features.movement.humanoids import add_shipped_bodies
from app.features.record.ledger import open_attempt, take_slot
from app.models import (
    Answer,
    ClockProbe,
    Completion,
    Contact,
    JointErrorCourseRow,
    JointErrorRow,
    Participant,
    Phase,
    PhaseLatency,
    PhaseQuality,
    ScoreValue,
    SessionContent,
    SessionEvent,
    StudySession,
    Submission,
)
from app.settings import Settings
from tests.features.builders import NOW, STUDY, SessionSpec, build_session
from tests.features.session_filler import stable_id

Fresh = dict[str, ColumnElement[Any]]
ORDERS = 6
COUNTS = (
    *("gaps", "gap_s", "longest_gap_s", "jumps", "frozen_s", "non_unit", "non_finite"),
    "backwards",
)
OWN = (
    *(Phase, PhaseLatency, PhaseQuality, Contact, Completion, ClockProbe),
    *(JointErrorRow, JointErrorCourseRow, SessionContent, SessionEvent, Submission),
)
OF_A_SUBMISSION = (Answer, ScoreValue)


def shipped_database(data_dir: Path) -> Database:
    """Open a new SQLite database in `data_dir` with the shipped bodies, avatar and studies."""
    settings = Settings(data_dir=data_dir)
    data_dir.mkdir(parents=True, exist_ok=True)
    bring_up_to_date(settings, Clock())
    database = open_database(settings.resolved_database_url)
    with database.writing() as db:
        now = Clock().utc_now()
        add_shipped_bodies(db, now)
        add_shipped_avatar(db, now)
        add_shipped(db, now)
    return database


def fill_thousand(database: Database, participants: int = 1000) -> list[str]:
    """Store a thousand completed sessions of kind people and return their ids."""
    with database.writing() as db:
        built = [build_session(db, SessionSpec(f"P-{at:04d}")) for at in range(ORDERS)]
        for session in built:
            db.add_all(summaries_of(db, session))
    sessions = [session.id for session in built]
    for first in range(ORDERS, participants, 50):
        with database.writing() as db:
            last = min(first + 50, participants)
            sessions += [_copy(db, built, at) for at in range(first, last)]
    return sessions


def summaries_of(db: Session, session: StudySession) -> list[PhaseQuality]:
    """Return summaries of a built session's phases, as a finished session has them.

    A server that starts would compute any that are missing, and then judge the session again by its
    log of phases, which a built session lacks: it would no longer count.
    """
    phases = db.scalars(select(Phase).where(Phase.session_id == session.id)).all()
    return [
        PhaseQuality(
            session_id=session.id,
            phase_id=phase.phase_id,
            stream=stream,
            frames=5400,
            span_s=60.0,
            frame_rate_hz=90.0,
            frozen_joints=[],
            **dict.fromkeys(COUNTS, 0),
        )
        for phase in phases
        for stream in ("target", "actual")
    ]


def _copy(db: Session, built: Sequence[StudySession], at: int) -> str:
    """Copy the rows of the built session with the same order of conditions to one more session."""
    version = newest_version(db, study_by_key(db, STUDY))
    slot = take_slot(db, version, protocol_of(version), "people", NOW)
    model = built[at % len(built)]
    person = Participant(
        study_id=version.study_id, kind="people", code=f"P-{at:04d}", created_at=NOW
    )
    db.add(person)
    db.flush()
    values = {column.name: getattr(model, column.name) for column in StudySession.__table__.columns}
    began = NOW + timedelta(hours=at)
    own = {"id": stable_id("copy", at), "participant_id": person.id, "created_at": began}
    session = StudySession(**(values | own))
    db.add(session)
    db.flush()
    open_attempt(db, slot, session, NOW)
    connection = db.connection()
    for table in OWN:
        _copy_rows(connection, _table(table), model.id, session.id)
    return session.id


def _copy_rows(connection: Connection, table: Table, old: str, new: str) -> None:
    fresh: Fresh = {"session_id": literal(new)}
    if "id" in table.c:
        fresh["id"] = _own_id(table.c["id"], new)
    _insert(connection, table, fresh, table.c["session_id"] == old)
    if table.name == Submission.__tablename__:
        for inner in map(_table, OF_A_SUBMISSION):
            mine = select(table.c["id"]).where(table.c["session_id"] == old)
            given = inner.c["submission_id"]
            _insert(connection, inner, {"submission_id": _own_id(given, new)}, given.in_(mine))


def _own_id(column: Column[Any], new: str) -> ColumnElement[Any]:
    """Return an id for the copy: half from the original row, half from its session."""
    return func.substr(column, 1, 16).concat(new[:16])


def _insert(connection: Connection, table: Table, fresh: Fresh, where: ColumnElement[bool]) -> None:
    chosen = [fresh.get(column.name, column) for column in table.columns]
    rows = select(*chosen).where(where)
    connection.execute(insert(table).from_select([column.name for column in table.columns], rows))


def _table(model: type[Base]) -> Table:
    return Base.metadata.tables[model.__tablename__]
