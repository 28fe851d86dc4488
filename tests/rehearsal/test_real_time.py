"""Test of a whole session at real speed."""

import pytest

from app.rehearsal.rehearse import RehearsalPlan
from tests.rehearsal.performed import STUDY, performed_once

FRAME_S = 1 / 90


@pytest.mark.long
@pytest.mark.timeout(1200)
def test_a_session_at_real_speed_loses_nothing() -> None:
    """A session at real speed loses no frame and keeps its active times, without a reconnect."""
    plan = RehearsalPlan(url="", study=STUDY, speed=1.0, seed=7)
    performed = performed_once("rehearsal-real-time", plan, None, {})
    report = performed.report
    active_s = [phase["active_s"] for phase in report["phases"]]
    assert active_s == pytest.approx([120.0] + [60.0] * 6, abs=FRAME_S)
    assert report["frames_sent"] == report["frames_stored"]
    assert (report["questionnaires"], report["reconnects"]) == (6, 0)
    assert report["duration_s"] > sum(active_s)
