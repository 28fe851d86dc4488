"""Tests of the tables of what headsets reported: goal states, calibrations, added latency."""

from typing import Any

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.database import Database
from app.features.results.analysis import tables
from app.features.results.exports.writing.blinding import without_conditions
from app.models import ClientReport, Phase
from tests.features.builders import NOW, SessionSpec, build_session
from tests.features.lab import STUDY, Lab
from tests.wire.message_vectors import ADDED_LATENCY, CALIBRATION, GOALS


def report(db: Session, session_id: str, seq: int, body: dict[str, Any]) -> None:
    """Store an accepted report."""
    db.add(
        ClientReport(
            session_id=session_id,
            epoch=7,
            seq=seq,
            type=body["kind"],
            payload=body,
            accepted=True,
            received_at=NOW,
        )
    )


def test_reports_become_rows(fresh_lab: Lab) -> None:
    """Goal states and calibrated goals are rows; added latency is in its phase, the largest one.

    For a blinded reader, what was compensated is empty: at 0 ms nothing can be.
    """
    database: Database = fresh_lab.database
    with database.writing() as db:
        session_id = build_session(db, SessionSpec("one", kind="people"), STUDY).id
        phase = db.scalars(select(Phase).order_by(Phase.phase_id)).first()
        assert phase is not None
        phase_id = phase.phase_id
        report(db, session_id, 900, GOALS)
        report(db, session_id, 901, CALIBRATION | {"segments_m": {"upper_arm": 0.31}})
        report(db, session_id, 902, {**ADDED_LATENCY, "phase_id": phase_id, "added_s": 0.005})
        report(db, session_id, 903, {**ADDED_LATENCY, "phase_id": phase_id})
    with database.reading() as db:
        goals = tables.goal_states_table(db, STUDY, "people")
        bodies = tables.body_calibrations_table(db, STUDY, "people")
        phases = tables.phases_table(db, STUDY, "people")
    (row,) = goals.to_dict("records")
    assert (row["state_right_hand"], row["state_left_shin"]) == ("lost", "inferred")
    assert (row["frame_seq"], row["source"]) == (0, "controllers")
    assert list(bodies["goal"]) == ["Head", "LeftHand", "RightHand"]
    assert bodies["residual_m"].dropna().tolist() == [0.012, 0.008]
    assert bodies["offset_y_m"].dropna().tolist() == [-0.09]
    assert set(bodies["notices"]) == {"bent_knees"}
    assert set(bodies["upper_arm_m"]) == {0.31}
    assert bodies["forearm_m"].isna().all()
    assert bodies["revision"].isna().all()
    own = phases[phases["phase_id"] == phase_id].iloc[0]
    assert own["headset_added_ms"] == pytest.approx(11.1)
    assert own["headset_compensated_ms"] == 0.0
    assert phases["headset_added_ms"].notna().sum() == 1
    masked = without_conditions("phases", phases, {session_id})
    assert masked["headset_compensated_ms"].isna().all()
