"""Tests of the tables of the lab's trackers: alignments, and what was sent as it came."""

from datetime import timedelta

import pytest

from app.adapters.live import Pose
from app.features.movement.live import Sample
from app.features.record.lab_trackers.recording import store_samples
from app.features.results.analysis import tables
from app.features.results.exports.writing.contents import Contents
from app.models import TrackerAlignment
from tests.features.builders import NOW, SessionSpec, build_session
from tests.features.lab import STUDY, Lab

ALIGNMENT = {
    "rotation": [0.5, 0.5, 0.5, 0.5],
    "position_m": [1.0, 2.0, 3.0],
    "drift_m_s": [0.0, 0.0, 1e-4],
    "reference_s": 9.0,
    "start_s": 4.0,
    "end_s": 14.0,
    "mount": {"delay_s": 0.03, "delay_uncertainty_s": 1e-4},
    "quality": {
        "residual_m": 0.0015,
        "residual_p95_m": 0.003,
        "residual_rad": 0.004,
        "uncertainty_m": 0.0004,
        "outliers": 0.01,
    },
}
JUMP = {"time_s": 20.0, "side": "headset", "offset_m": 0.4, "offset_rad": 0.6}


@pytest.mark.one_engine
def test_alignments_and_samples_are_exported_as_they_were_stored(fresh_lab: Lab) -> None:
    """An alignment and a jump are rows; every pose is a row with its three times."""
    foot = Pose("foot", "tracker", (0.1, 0.2, 0.3), (1.0, 0.0, 0.0, 0.0))
    half = Pose("hat", "tracker", None, (1.0, 0.0, 0.0, 0.0), tracked=False)
    samples = [
        Sample("osc", "=lab", "127.0.0.1:5", (foot, half), 3.5, 100.25, 100.2, 0.001),
        Sample("osc", "=lab", "127.0.0.1:5", (foot,), None, 100.5, 100.5, None),
    ]
    with fresh_lab.database.writing() as db:
        session_id = build_session(db, SessionSpec("one", kind="people"), STUDY).id
        for number, (change, figures) in enumerate(
            (
                ("first", {"alignment": ALIGNMENT, "jump": None}),
                ("lost", {"alignment": None, "jump": JUMP}),
            )
        ):
            db.add(
                TrackerAlignment(
                    session_id=session_id,
                    at=NOW + timedelta(seconds=number),
                    change=change,
                    client_t_s=14.0 + number,
                    door="osc",
                    source="=lab",
                    tracker="hat",
                    figures=figures,
                )
            )
        assert store_samples(db, session_id, samples, now=NOW, now_s=101.0) == 3
    with fresh_lab.database.reading() as db:
        table = tables.tracker_alignments_table(db, STUDY, "people")
        members = {
            member.path: b"".join(member.pieces).decode()
            for member in Contents(db, STUDY, "people", NOW).members()
        }
    first, lost = table.to_dict("records")
    assert (first["change"], first["delay_s"], first["world_z_m"]) == ("first", 0.03, 3.0)
    assert (first["drift_z_m_per_min"], first["foot_uncertainty_m"]) == (6e-3, 0.0004)
    assert (lost["jump_side"], lost["jump_m"], lost["jump_rad"]) == ("headset", 0.4, 0.6)
    assert (table["residual_m"].isna().tolist(), len(table)) == ([False, True], 2)
    (path,) = (one for one in members if one.startswith("trackers/"))
    head, *rows = members[path].splitlines()
    cells = [dict(zip(head.split(","), row.split(","), strict=True)) for row in rows]
    assert [one["tracker"] for one in cells] == ["foot", "hat", "foot"]
    assert [one["tracked"] for one in cells] == ["true", "false", "true"]
    assert (cells[0]["source_s"], cells[0]["mapped_s"]) == ("3.5", "100.2")
    assert (cells[2]["source_s"], cells[2]["mapped_uncertainty_s"]) == ("", "")
    assert (cells[1]["x_m"], cells[1]["qw"]) == ("", "1.0")
    # A name that a spreadsheet would run as a formula is made a text.
    assert cells[0]["source"] == "'=lab"
    arrived = NOW - timedelta(seconds=0.75)
    assert cells[0]["arrived_at_utc"] == arrived.isoformat(timespec="microseconds").replace(
        "+00:00", "Z"
    )
