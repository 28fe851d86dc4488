"""Tests of the achieved latency of a rehearsed session, computed from its record."""

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.telemetry.latencies import phase_latency
from app.models import PhaseLatency
from tests.rehearsal.performed import PHASES, Performed

MS = 0.001


def _rows(performed: Performed, db: Session) -> list[PhaseLatency]:
    query = select(PhaseLatency).where(PhaseLatency.session_id == performed.session_id)
    return list(db.scalars(query.order_by(PhaseLatency.phase_id)))


def test_every_phase_achieved_its_set_latency(performed: Performed, db: Session) -> None:
    """Every phase with movement achieved its set latency within 0.1 ms; others give a reason."""
    rows = _rows(performed, db)
    assert len(rows) == PHASES
    for row in rows:
        assert not row.flagged
        if row.movement_s < 5.0:
            assert row.achieved_s is None
            assert "5 s are needed" in str(row.reason)
            continue
        assert row.achieved_s == pytest.approx(row.ordered_s, abs=0.1 * MS)
        assert row.low_s is not None
        assert row.high_s is not None
        assert row.low_s <= row.ordered_s <= row.high_s
    assert {row.ordered_s for row in rows if row.achieved_s is not None} == {0.0, 0.125, 0.350}


def test_measuring_again_gives_the_same(performed: Performed, db: Session) -> None:
    """Measuring the latency again gives the stored result, since it depends only on the frames."""
    row = _rows(performed, db)[-1]
    again = phase_latency(db, performed.session_id, row.phase_id)
    assert (again.latency_s, again.low_s, again.high_s) == (row.achieved_s, row.low_s, row.high_s)
    assert (again.movement_s, again.samples) == (row.movement_s, row.samples)
