"""Tests of the tables of data quality, alarms and doubts."""

from datetime import timedelta

import pandas as pd
import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.database import Database
from app.features.record.alarms import Change, Condition, store_change
from app.features.results.analysis.codebook import columns_of
from app.features.results.analysis.tables import (
    alarms_table,
    doubts_table,
    phases_table,
    quality_table,
    sessions_table,
)
from app.models import Phase, PhaseQuality, StudySession
from tests.features.builders import NOW, STUDY, SessionSpec, build_session

TABLES = {
    "quality": quality_table,
    "alarms": alarms_table,
    "doubts": doubts_table,
    "phases": phases_table,
    "sessions": sessions_table,
}
OWN = ("quality", "alarms")


def build(database: Database, *specs: SessionSpec, backwards: int = 0) -> None:
    """Store sessions with quality rows for their phases and one alarm each."""
    with database.writing() as db:
        for spec in specs:
            session = build_session(db, spec)
            add_quality(db, session, backwards)
            gap = Condition("gap", "a gap of 0.5 s", "target", 0.5, "s", 12.25)
            store_change(db, session.id, Change("raised", gap, NOW))
            store_change(db, session.id, Change("cleared", gap, NOW + timedelta(seconds=4)))


def add_quality(db: Session, session: StudySession, backwards: int) -> None:
    """Add quality rows of both streams for every phase, with a frozen head in the actual one."""
    for phase in db.scalars(select(Phase).where(Phase.session_id == session.id)):
        for stream, joints in (("actual", ["Head", "LeftHand"]), ("target", [])):
            db.add(
                PhaseQuality(
                    session_id=session.id,
                    phase_id=phase.phase_id,
                    stream=stream,
                    frames=5400,
                    span_s=phase.active_s,
                    frame_rate_hz=90.0,
                    gaps=2,
                    gap_s=0.75,
                    longest_gap_s=0.5,
                    jumps=1,
                    frozen_s=2.5 if joints else 0.0,
                    frozen_joints=joints,
                    non_unit=3,
                    non_finite=4,
                    backwards=backwards,
                )
            )
    db.flush()


def table(database: Database, name: str, kind: str = "people") -> pd.DataFrame:
    """Return a table as it is exported."""
    with database.reading() as db:
        return TABLES[name](db, STUDY, kind)  # type: ignore[arg-type]  # the fact


@pytest.mark.one_engine
@pytest.mark.parametrize("name", OWN)
def test_a_table_has_the_columns_of_the_codebook_also_when_empty(
    database: Database, name: str
) -> None:
    """A table has the codebook's columns in order, with and without rows."""
    expected = [column.name for column in columns_of(name)]
    assert list(table(database, name).columns) == expected
    build(database, SessionSpec("P-0001"))
    assert list(table(database, name).columns) == expected
    assert len(table(database, name)) > 0


@pytest.mark.parametrize("name", OWN)
def test_kinds_never_mix(database: Database, name: str) -> None:
    """A table of one kind of session has rows of that kind only."""
    build(database, SessionSpec("P-0001"), SessionSpec("SIM-0001", kind="simulated"))
    for kind in ("people", "simulated"):
        rows = table(database, name, kind)
        assert set(rows["kind"]) == {kind}
        assert set(rows["simulated"]) == {kind == "simulated"}
    assert len(table(database, name, "test")) == 0
    assert set(table(database, name, "all")["kind"]) == {"people", "simulated"}


def test_every_phase_has_a_row_for_each_stream(database: Database) -> None:
    """Every phase has a quality row for each stream, target first."""
    build(database, SessionSpec("P-0001"), backwards=5)
    rows = table(database, "quality")
    assert rows["stream"].tolist() == ["target", "actual"] * (len(rows) // 2)
    assert rows["frozen_joints"].tolist()[:2] == [None, "Head LeftHand"]
    first = rows.iloc[0]
    assert (first["gaps"], first["gap_s"], first["longest_gap_s"]) == (2, 0.75, 0.5)
    assert (first["non_unit"], first["non_finite"], first["backwards"]) == (3, 4, 5)


@pytest.mark.one_engine
def test_a_repeated_phases_first_attempt_is_not_valid(database: Database) -> None:
    """The quality rows of a repeated phase's first attempt are kept but marked as not valid."""
    build(database, SessionSpec("P-0001", redone=("block2.hand",)))
    rows = table(database, "quality")
    assert rows[~rows["valid"]]["attempt"].tolist() == [1, 1]


def test_a_doubted_phase_is_not_valid(database: Database) -> None:
    """A phase whose frames run backwards is not valid, and the table of doubts has the reason."""
    build(database, SessionSpec("P-0001"), backwards=5)
    doubts, phases = table(database, "doubts"), table(database, "phases")
    assert set(doubts["doubt"]) == {"time_backwards"}
    assert set(doubts["claimed"]) == {10.0}
    assert set(doubts["phase_id"]) == set(phases["phase_id"])
    assert not phases["valid"].any()
    assert table(database, "sessions")["valid"].all()


def test_an_alarm_is_two_rows(database: Database) -> None:
    """A cleared alarm has two rows: one when it was raised, one when it was cleared."""
    build(database, SessionSpec("P-0001"))
    rows = table(database, "alarms")
    assert rows["state"].tolist() == ["raised", "cleared"]
    assert rows["at_utc"].diff().iloc[1] == pd.Timedelta(seconds=4)
    first = rows.iloc[0]
    assert (first["code"], first["severity"], first["stream"]) == ("gap", "warning", "target")
    assert (first["value"], first["value_unit"], first["client_t_s"]) == (0.5, "s", 12.25)
