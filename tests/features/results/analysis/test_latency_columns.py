"""Tests of the achieved latency in the table of phases."""

import pandas as pd
import pytest
from sqlalchemy import select

from app.database import Database
from app.features.results.analysis.tables import phases_table
from app.features.results.exports.writing.cells import csv_pieces
from app.models import Phase
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.features.latency_builders import measured


@pytest.fixture
def table(database: Database) -> pd.DataFrame:
    """Return phases whose latency is unmeasured, off or within tolerance, or without movement."""
    with database.writing() as db:
        session = build_session(db, SessionSpec("P-0001"))
        tasks = db.scalars(
            select(Phase)
            .where(Phase.session_id == session.id, Phase.kind == "task")
            .order_by(Phase.phase_id)
        ).all()
        still, off, *fine = tasks
        db.add(measured(still, None))
        db.add(measured(off, off.latency_ms / 1000.0 + 0.02, flagged=True))
        db.add_all([measured(phase, phase.latency_ms / 1000.0) for phase in fine])
    with database.reading() as db:
        return phases_table(db, STUDY, "people").set_index("phase_id")


def test_the_achieved_latency_is_in_milliseconds(table: pd.DataFrame) -> None:
    """The table of phases has the achieved latency and its interval in milliseconds."""
    fine = table.iloc[-1]
    assert fine["achieved_latency_ms"] == pytest.approx(fine["latency_ms"])
    assert fine["achieved_latency_low_ms"] == pytest.approx(fine["latency_ms"] - 0.4)
    assert fine["achieved_latency_high_ms"] == pytest.approx(fine["latency_ms"] + 0.4)
    assert (fine["movement_s"], fine["latency_samples"]) == (58.0, 5400)


def test_an_unknown_latency_is_missing_and_not_false(table: pd.DataFrame) -> None:
    """Without an achieved latency `latency_off` is missing, not false, and a reason is given."""
    roam, still, off = (table.iloc[row] for row in range(3))
    assert [bool(table.iloc[row]["latency_off"]) for row in (2, 3)] == [True, False]
    assert off["achieved_latency_ms"] == pytest.approx(off["latency_ms"] + 20.0)
    assert pd.isna(still["latency_off"])
    assert pd.isna(still["achieved_latency_ms"])
    assert (still["latency_reason"], still["movement_s"]) == ("3.2 s of movement.", 3.25)
    assert pd.isna(roam["latency_off"])
    assert pd.isna(roam["movement_s"])
    assert roam["latency_reason"] is None


@pytest.mark.one_engine
def test_a_missing_boolean_is_an_empty_cell(table: pd.DataFrame) -> None:
    """A missing boolean is an empty cell of the CSV."""
    header, *rows = b"".join(csv_pieces("phases", table.reset_index())).decode().splitlines()
    at = header.split(",").index("latency_off")
    assert [row.split(",")[at] for row in rows[:4]] == ["", "", "true", "false"]
