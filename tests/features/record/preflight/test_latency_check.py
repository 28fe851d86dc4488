"""Tests of the pre-flight check of the latency, which reveals no latency of a condition."""

import json

from app.models import Phase, PhaseLatency
from tests.features.lab import Json, Lab, ok

CALIBRATION = {
    "equipment": "Vive Pro 2, desk 3",
    "motion_to_photon_ms": 44.8,
    "sd_ms": 2.7,
    "samples": 40,
    "method": "High-speed camera at 240 Hz",
    "measured_on": "2026-03-01",
}


def measure(lab: Lab, session_id: str, *flagged: bool) -> None:
    """Store phases of a session with a measured latency, each in or out of tolerance."""
    now = lab.context.clock.utc_now()
    with lab.database.writing() as db:
        for phase_id, off in enumerate(flagged, start=1):
            db.add(
                Phase(
                    session_id=session_id,
                    phase_id=phase_id,
                    step_index=phase_id,
                    step_key=f"block{phase_id}.hand",
                    attempt=1,
                    kind="task",
                    latency_ms=137.25,
                    status="done",
                    prepared_at=now,
                    ended_at=now,
                )
            )
            db.flush()
            db.add(
                PhaseLatency(
                    session_id=session_id,
                    phase_id=phase_id,
                    ordered_s=0.13725,
                    achieved_s=0.13725,
                    low_s=0.1,
                    high_s=0.2,
                    movement_s=30.0,
                    frame_s=0.011,
                    samples=2700,
                    flagged=off,
                )
            )


def latency_of(lab: Lab, session_id: str) -> Json:
    """Return the latency check of a session's pre-flight."""
    reply = ok(lab.operator.get(f"/api/sessions/{session_id}/preflight"))
    (check,) = (one for one in reply["checks"] if one["key"] == "latency")
    assert isinstance(check, dict)
    return check


def test_the_newest_measured_session_decides(fresh_lab: Lab) -> None:
    """The latency check passes if all phases of the last measured session are within tolerance.

    Simulated sessions do not count. No latency is stated, so a blinded operator may read it.
    """
    today = fresh_lab.join(participant_code="P-1")["id"]
    assert latency_of(fresh_lab, today)["code"] == "latency.unmeasured"
    ok(fresh_lab.operator.post("/api/calibrations", json=CALIBRATION))
    check = latency_of(fresh_lab, today)
    assert (check["status"], check["code"]) == ("wait", "latency.calibrated")
    assert check["details"] == ["Vive Pro 2, desk 3: 44.8 ms, 2026-03-01"]
    measure(fresh_lab, fresh_lab.join(kind="simulated")["id"], True)
    assert latency_of(fresh_lab, today)["code"] == "latency.calibrated"
    measure(fresh_lab, fresh_lab.join(participant_code="P-2")["id"], False, False)
    check = latency_of(fresh_lab, today)
    assert (check["status"], check["value"], check["limit"]) == ("ok", 2, 2)
    measure(fresh_lab, fresh_lab.join(participant_code="P-3")["id"], False, True, False)
    check = latency_of(fresh_lab, today)
    assert (check["status"], check["code"], check["value"]) == ("fail", "latency.off", 2)
    assert "137" not in json.dumps(check)
