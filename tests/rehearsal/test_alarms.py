"""Tests that a rehearsal at high speed raises no alarms and that its phases are checked."""

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.models import AlarmRow, PhaseQuality
from tests.rehearsal.performed import PHASES, Performed

TOLERATED = {"clock_uncertain", "jump"}
"""Round trips are long on a busy machine, and a simulated participant who steps too wide sits down
faster than a real one."""


def test_correct_movement_raises_no_alarm(performed: Performed, db: Session) -> None:
    """Correct movement at 20 to 40 times real speed raises no alarm."""
    rows = db.scalars(select(AlarmRow).where(AlarmRow.session_id == performed.session_id))
    assert {row.message for row in rows if row.code not in TOLERATED} == set()


def test_every_phase_is_checked_and_has_no_faults(performed: Performed, db: Session) -> None:
    """Every phase has 90 frames a second over its active time and no faults in either stream."""
    query = select(PhaseQuality).where(PhaseQuality.session_id == performed.session_id)
    rows = list(db.scalars(query))
    assert len(rows) == 2 * PHASES
    for row in rows:
        assert (row.gaps, row.non_unit, row.non_finite, row.backwards) == (0, 0, 0, 0)
        assert (row.frozen_joints, row.jumps <= 4) == ([], True)
        assert row.frame_rate_hz is not None
        assert abs(row.frame_rate_hz - 90.0) < 1e-3
