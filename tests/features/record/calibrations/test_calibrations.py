"""Tests of calibrations of the equipment's own latency: appended, never edited, always exported."""

from pathlib import Path

import pytest

from app.features.results.analysis.tables import calibrations_table
from app.features.results.exports.writing import export_study
from app.models import Calibration
from tests.features.lab import STUDY, Json, Lab, error, ok

MEASURED: Json = {
    "equipment": "Vive Pro 2, desk 3",
    "motion_to_photon_ms": 41.3,
    "sd_ms": 2.7,
    "samples": 40,
    "method": "high-speed camera at 240 Hz",
    "measured_on": "2026-03-02",
    "note": "",
}


def add(lab: Lab, **changes: object) -> Json:
    """Store a measurement of the equipment's latency."""
    stored: Json = ok(lab.operator.post("/api/calibrations", json={**MEASURED, **changes}))
    return stored


def listed(lab: Lab) -> list[Json]:
    """Return every measurement, as listed by the interface."""
    reply: list[Json] = ok(lab.operator.get("/api/calibrations"))
    return reply


def test_a_calibration_is_stored_in_seconds(fresh_lab: Lab) -> None:
    """A calibration is given in milliseconds, stored in seconds and returned in milliseconds."""
    stored = add(fresh_lab)
    assert {key: stored[key] for key in MEASURED} == MEASURED
    assert (stored["current"], stored["by"]) == (True, "account:admin")
    with fresh_lab.database.reading() as db:
        row = db.get_one(Calibration, stored["id"])
        assert row.motion_to_photon_s == pytest.approx(0.0413, abs=1e-12)
        assert row.sd_s == pytest.approx(0.0027, abs=1e-12)


def test_the_latest_measurement_of_each_equipment_is_current(fresh_lab: Lab) -> None:
    """The current calibration of each piece of equipment is the one that was measured last."""
    newest = add(fresh_lab, measured_on="2026-04-01")
    older = add(fresh_lab, measured_on="2026-01-01")
    other = add(fresh_lab, equipment="Another headset")
    current = {one["id"]: one["current"] for one in listed(fresh_lab)}
    assert current == {newest["id"]: True, older["id"]: False, other["id"]: True}
    assert [one["equipment"] for one in listed(fresh_lab)] == [
        "Another headset",
        *["Vive Pro 2, desk 3"] * 2,
    ]


@pytest.mark.one_engine
def test_a_retired_calibration_stays_listed(fresh_lab: Lab) -> None:
    """A calibration can be retired once; it stays listed and the previous one becomes current."""
    before = add(fresh_lab, measured_on="2026-01-01")
    wrong = add(fresh_lab)
    path = f"/api/calibrations/{wrong['id']}/retire"
    retired = ok(fresh_lab.operator.post(path, json={"reason": "Wrong frame rate"}))
    assert (retired["current"], retired["retired_reason"]) == (False, "Wrong frame rate")
    assert {one["id"]: one["current"] for one in listed(fresh_lab)} == {
        wrong["id"]: False,
        before["id"]: True,
    }
    error(fresh_lab.operator.post(path, json={"reason": "Again"}), 409, "conflict")
    missing = fresh_lab.operator.post("/api/calibrations/nothing/retire", json={"reason": "x"})
    error(missing, 404, "not_found")


@pytest.mark.one_engine
@pytest.mark.parametrize(
    "change",
    [
        {"motion_to_photon_ms": 0},
        {"motion_to_photon_ms": -3},
        {"motion_to_photon_ms": 10_001},
        {"sd_ms": -1},
        {"samples": 0},
        {"equipment": "  "},
        {"method": ""},
        {"measured_on": "last week"},
        {"measured_on": "2999-01-01"},
        {"surprise": 1},
    ],
)
def test_an_invalid_calibration_is_refused(lab: Lab, change: Json) -> None:
    """A calibration with impossible numbers, a future date or without a method is refused."""
    answer = lab.operator.post("/api/calibrations", json={**MEASURED, **change})
    assert answer.status_code == 422


@pytest.mark.one_engine
def test_every_export_contains_the_calibrations(fresh_lab: Lab, tmp_path: Path) -> None:
    """Every export contains the calibrations, whatever the study."""
    add(fresh_lab, note="after the driver's update")
    with fresh_lab.database.reading() as db:
        table = calibrations_table(db)
        export_study(db, STUDY, "people", tmp_path / "out", now=fresh_lab.context.clock.utc_now())
    assert table["motion_to_photon_ms"].tolist() == [41.3]
    lines = (tmp_path / "out" / "calibrations.csv").read_text("utf-8").splitlines()
    assert lines[0].startswith("equipment,motion_to_photon_ms,sd_ms,samples,method,measured_on")
    assert lines[1].startswith('"Vive Pro 2, desk 3",41.3,2.7,40,')
    assert "calibrations.csv" in (tmp_path / "out" / "README.txt").read_text("utf-8")
