"""Tests of the figure of joint error within a phase."""

import io
from typing import Any

import numpy as np
import pandas as pd
import pytest

from app.database import Database
from app.features.results.analysis.dashboard import drawings_of
from app.features.results.analysis.figures import Drawing, joint_error_course_drawing
from app.features.results.analysis.material import read_material
from app.features.results.analysis.schemas import NO_FILTER, FigureFilter
from app.features.results.analysis.sheets import sheet_of
from app.features.results.analysis.state import state_of_data
from app.models import JointErrorCourseRow
from tests.features.builders import STUDY, SessionSpec, build_session

BINS = 12
MEANS = ("0 ms", "125 ms")


def _courses(growth_deg: float, code: str, latency: float, **changes: Any) -> list[dict[str, Any]]:
    """Return rows of a phase whose error grows by a fixed amount per bin."""
    row = {
        "participant_code": code,
        "phase_kind": "task",
        "limb": "hand",
        "avatar": "delayed_copy",
        "reference": "present",
        "latency_ms": latency,
    }
    return [
        {
            **row,
            "begin_active_s": 5.0 * at,
            "end_active_s": 5.0 * (at + 1),
            "mean_deg": 10.0 + growth_deg * at,
            **changes,
        }
        for at in range(BINS)
    ]


def _traces(drawing: Drawing, name: str) -> list[dict[str, Any]]:
    figure = drawing.as_json()
    assert figure is not None, drawing.empty
    return [trace for trace in figure["data"] if trace["name"] == name]


def test_a_line_is_the_mean_over_participants_at_the_middle_of_each_bin() -> None:
    """A line is the mean over participants, at the middle of each bin."""
    rows = [*_courses(1.0, "P-1", 125.0), *_courses(3.0, "P-2", 125.0)]
    rows += _courses(3.0, "P-2", 125.0)
    drawing = joint_error_course_drawing(pd.DataFrame(rows))
    (line,) = _traces(drawing, "125 ms")
    assert line["x"] == [2.5 + 5.0 * at for at in range(BINS)]
    assert line["y"] == [10.0 + 2.0 * at for at in range(BINS)]
    assert (line["mode"], drawing.n) == ("lines+markers", 2)
    assert "A step is 5 s long" in drawing.caption
    # The interval of two values: t(.975, 1) = 12.706, so it is 12.706 times half their distance.
    second = drawing.data.iloc[1]
    assert second["ci95_high_deg"] - second["mean_deg"] == pytest.approx(12.7062, abs=1e-4)


def test_a_band_is_interrupted_where_no_interval_is_known() -> None:
    """The band of an interval is interrupted by gaps and by bins with one participant."""
    both = [*_courses(1.0, "P-1", 125.0), *_courses(1.0, "P-2", 125.0)]
    rows = [row for row in both if row["begin_active_s"] != 20.0]
    rows = [row for row in rows if row["participant_code"] == "P-1" or row["begin_active_s"] < 50.0]
    (band,) = _traces(joint_error_course_drawing(pd.DataFrame(rows)), "95 % interval, 125 ms")
    assert (band["fill"], band["hoverinfo"]) == ("toself", "skip")
    gaps = [at for at, x in enumerate(band["x"]) if x is None]
    parts = [band["x"][: gaps[0]], band["x"][gaps[0] + 1 : gaps[1]]]
    assert [(min(part), max(part)) for part in parts] == [(0.0, 20.0), (25.0, 50.0)]
    assert len(gaps) == 2


def test_latencies_and_limbs_differ_without_colour() -> None:
    """Latencies differ in dash and symbol, and limbs in panel; the axes have units."""
    rows = [
        row
        for code in ("P-1", "P-2")
        for limb in ("hand", "foot")
        for latency in (0.0, 125.0)
        for row in _courses(1.0, code, latency, limb=limb)
    ]
    drawing = joint_error_course_drawing(pd.DataFrame(rows))
    lines = [_traces(drawing, name) for name in MEANS]
    assert {len(own) for own in lines} == {2}
    assert len({own[0]["line"]["dash"] for own in lines}) == 2
    assert len({own[0]["marker"]["symbol"] for own in lines}) == 2
    for own in lines:
        assert own[0].get("xaxis") != own[1].get("xaxis")
        assert [trace["showlegend"] for trace in own] == [True, False]
    figure = drawing.as_json()
    assert figure is not None
    layout = figure["layout"]
    assert layout["xaxis"]["title"]["text"] == "active time (s)"
    assert layout["yaxis"]["title"]["text"] == "mean joint error (deg)"
    assert (layout["xaxis"]["range"], layout["yaxis"]["rangemode"]) == ([0.0, 60.0], "tozero")
    # No band is drawn over a line.
    first = next(at for at, one in enumerate(figure["data"]) if one["name"] == "0 ms")
    assert [one["name"].startswith("95 %") for one in figure["data"][:first]] == [True] * first


def test_only_tasks_against_the_present_pose_are_drawn() -> None:
    """Only tasks against the present target pose are drawn."""
    rows = [
        *_courses(0.0, "P-1", 125.0),
        *_courses(9.0, "P-2", 125.0, reference="command"),
        *_courses(9.0, "P-3", 125.0, phase_kind="free_roam", limb=None),
        *_courses(9.0, "P-4", 125.0, mean_deg=None),
    ]
    drawing = joint_error_course_drawing(pd.DataFrame(rows))
    assert drawing.n == 1
    assert set(drawing.data["mean_deg"]) == {10.0}
    assert drawing.data["ci95_low_deg"].isna().all()
    assert "no confidence interval yet" in drawing.caption
    nothing = joint_error_course_drawing(pd.DataFrame(rows).iloc[BINS:])
    assert (nothing.figure, nothing.empty) == (None, "No participant has joint errors yet.")


def test_the_caption_mentions_limits_for_physics_avatars_only() -> None:
    """The caption mentions joint limits for physics avatars only."""
    physics = joint_error_course_drawing(pd.DataFrame(_courses(1.0, "P-1", 0.0, avatar="physics")))
    plain = joint_error_course_drawing(pd.DataFrame(_courses(1.0, "P-1", 0.0)))
    assert "before their limits" in physics.caption
    assert "hinges" not in plain.caption


def _drawing(database: Database, chosen: FigureFilter = NO_FILTER) -> tuple[Drawing, str]:
    """Return the figure of the simulated sessions, and its rows as CSV."""
    with database.reading() as db:
        material = read_material(db, STUDY, "simulated")
        found = drawings_of(material, chosen, "movement")
        drawing = next(one for one in found if one.key == "joint_error_course")
        return drawing, sheet_of(drawing, material).decode()


@pytest.mark.one_engine
def test_the_figure_of_a_study_is_filtered_and_its_rows_are_those_drawn(
    database: Database,
) -> None:
    """The figure can be filtered, and its CSV contains the rows that are drawn."""
    with database.writing() as db:
        for at in range(3):
            build_session(db, SessionSpec(f"SIM-{at}", kind="simulated"))
        build_session(db, SessionSpec("P-1", joint_error_rad=lambda _, __: 3.0))
    drawing, text = _drawing(database)
    assert drawing.title.startswith("Simulated: ")
    assert text.startswith("# Reembody, study reembodiment-latency. SIMULATED DATA")
    frame = pd.read_csv(io.StringIO(text), comment="#")
    assert len(frame) == 2 * 3 * BINS
    assert (set(frame["limb"]), set(frame["n"])) == ({"hand", "foot"}, {3})
    hand = frame[(frame["limb"] == "hand") & (frame["latency_ms"] == 125.0)]
    assert hand["begin_active_s"].tolist() == [5.0 * at for at in range(BINS)]
    assert hand["mean_deg"].tolist() == pytest.approx([np.degrees(0.125)] * BINS)
    (line, _) = _traces(drawing, "125 ms")
    assert line["y"] == pytest.approx(hand["mean_deg"].tolist())
    chosen, _ = _drawing(database, FigureFilter(limb="foot", participant=("SIM-1",)))
    assert (chosen.n, set(chosen.data["limb"])) == (1, {"foot"})
    assert "participants SIM-1, the foot task" in chosen.caption


@pytest.mark.one_engine
def test_a_new_course_changes_the_state_of_the_data(database: Database) -> None:
    """Adding or removing a phase's course changes the state of the data, so figures are redrawn."""
    with database.writing() as db:
        session_id = build_session(db, SessionSpec("P-1")).id
    with database.writing() as db:
        before = state_of_data(db, STUDY, "people")
        db.delete(db.get_one(JointErrorCourseRow, (session_id, 1, "command")))
        db.flush()
        assert state_of_data(db, STUDY, "people") != before
