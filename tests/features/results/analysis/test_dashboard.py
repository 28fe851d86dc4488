"""Tests of the dashboard of a study."""

import io
import json
from datetime import timedelta
from typing import Any

import pandas as pd
import plotly.graph_objects as go
import pytest

from app.database import Database
from app.errors import NotFound
from app.features.design.studies import add_version, study_by_key, versions_of
from app.features.results.analysis.dashboard import build_dashboard, drawings_of
from app.features.results.analysis.material import read_material
from app.features.results.analysis.schemas import (
    NO_FILTER,
    DashboardFigures,
    DashboardKind,
    FigureFilter,
)
from app.features.results.analysis.sheets import sheet_of
from tests.features.builders import NOW, STUDY, SessionSpec, build_session

KEYS = [
    "embodiment_ownership",
    "embodiment_agency",
    "embodiment_location",
    "embodiment_soe_thesis",
    "likert_karas2020",
    "completions",
    "learning",
    "contacts",
    "contacts_map",
    "joint_error_body",
    "joint_error_parts",
    "achieved_latency",
    "joint_error_blocks",
    "joint_error_course",
    "joint_error_joints",
    "demographics_ownership",
    "demographics_agency",
    "demographics_location",
    "demographics_soe_thesis",
    "quality",
    "exclusions",
    "alarms",
    "progress_time",
    "progress",
]
NEEDS_MOVEMENT = ("achieved_latency", "quality", "alarms")
"""Figures of what is computed from recorded movement, which built sessions have none of."""
COUNTING = KEYS[:20]
"""Figures of rows that count; the others show what does not, too."""


def _dashboard(
    database: Database, kind: DashboardKind = "people", chosen: FigureFilter = NO_FILTER
) -> DashboardFigures:
    with database.reading() as db:
        return build_dashboard(db, STUDY, kind, chosen)


def _build(database: Database, *specs: SessionSpec) -> None:
    with database.writing() as db:
        for spec in specs:
            build_session(db, spec)


def _figures(view: DashboardFigures) -> dict[str, dict[str, Any]]:
    return {figure.key: figure.figure for figure in view.figures if figure.figure is not None}


def _axes(figure: dict[str, Any]) -> list[dict[str, Any]]:
    layout = figure["layout"]
    return [value for name, value in layout.items() if name[:5] in ("xaxis", "yaxis")]


@pytest.fixture(scope="module")
def two_people(lasting_database: Database) -> DashboardFigures:
    """Return the dashboard of two complete sessions, for tests that only read it."""
    _build(lasting_database, SessionSpec("P-0001"), SessionSpec("P-0002"))
    return _dashboard(lasting_database)


@pytest.mark.one_engine
def test_every_figure_is_valid_plain_json(two_people: DashboardFigures) -> None:
    """Every figure passes plotly's validation and is JSON without packed arrays or NaN."""
    view = two_people
    assert [figure.key for figure in view.figures] == KEYS
    text = json.dumps(view.model_dump(mode="json"), allow_nan=False)
    assert "bdata" not in text
    for figure in _figures(view).values():
        go.Figure(figure)
    assert list(_figures(view)) == [key for key in KEYS if key not in NEEDS_MOVEMENT]


@pytest.mark.one_engine
def test_every_figure_says_what_it_shows(two_people: DashboardFigures) -> None:
    """Every figure has a title, a caption with n, units on its axes, and hover texts."""
    for entry in two_people.figures:
        if entry.figure is None:
            assert entry.key in NEEDS_MOVEMENT
            continue
        assert entry.figure["layout"]["title"]["text"] == entry.title
        assert f"n = {entry.n}" in entry.caption
        template = entry.figure["layout"]["template"]["layout"]
        assert template["paper_bgcolor"] == "rgba(0, 0, 0, 0)"
        reported = [trace for trace in entry.figure["data"] if trace.get("hoverinfo") != "skip"]
        assert all("hovertemplate" in trace for trace in reported)
        titles = [axis["title"]["text"] for axis in _axes(entry.figure) if "title" in axis]
        bars = entry.figure["layout"].get("coloraxis", {}).get("colorbar", {})
        titles += [bars["title"]["text"]] if bars else []
        assert any("(" in title for title in titles)


@pytest.mark.one_engine
def test_simulated_data_are_marked_and_separate(database: Database) -> None:
    """Figures of simulated sessions are marked as such and contain no other sessions."""
    _build(
        database,
        SessionSpec("P-0001"),
        SessionSpec("SIM-0001", kind="simulated"),
        SessionSpec("SIM-0002", kind="simulated"),
    )
    simulated, people = _dashboard(database, "simulated"), _dashboard(database)
    assert simulated.simulated
    assert not people.simulated
    assert (simulated.n_sessions, people.n_sessions) == (2, 1)
    assert all(figure.title.startswith("Simulated: ") for figure in simulated.figures)
    assert not any("Simulated" in figure.title for figure in people.figures)
    assert "P-0001" not in simulated.model_dump_json()
    assert "SIM-" not in people.model_dump_json()


@pytest.mark.one_engine
def test_figures_without_data_have_a_sentence(database: Database) -> None:
    """Without participants every figure is replaced by a sentence that says what is missing."""
    _build(database)
    for entry in _dashboard(database).figures:
        assert entry.figure is None
        assert entry.empty is not None
        assert entry.empty.startswith("No ")


@pytest.mark.one_engine
def test_one_participant_is_drawn_without_an_interval(database: Database) -> None:
    """A single participant is drawn without an interval, and the caption says so."""
    _build(database, SessionSpec("P-1"))
    figures = {entry.key: entry for entry in _dashboard(database).figures}
    agency = figures["embodiment_agency"]
    assert agency.figure is not None
    assert "no confidence interval yet" in agency.caption


@pytest.mark.one_engine
def test_only_valid_data_are_drawn(database: Database) -> None:
    """A withdrawn session changes no figure of measures."""
    _build(database, SessionSpec("P-0001"), SessionSpec("P-0002"))
    before = _figures(_dashboard(database))
    _build(database, SessionSpec("P-0003", status="withdrawn", completions=lambda _: 50))
    after = _figures(_dashboard(database))
    assert {key: after.get(key) for key in COUNTING} == {key: before.get(key) for key in COUNTING}
    assert after["progress"] != before["progress"]


def test_the_counts_are_those_of_the_study(database: Database) -> None:
    """The dashboard states the study's sessions, completed sessions and avatars."""
    _build(database, SessionSpec("P-1"), SessionSpec("P-2", status="active"))
    view = _dashboard(database)
    assert (view.n_sessions, view.n_completed, view.avatar) == (2, 1, ["delayed_copy"])
    assert view.n_running == 1


@pytest.mark.one_engine
def test_a_blinded_dashboard_leaves_out_open_sessions(database: Database) -> None:
    """In a blinded study the dashboard shows no measure and no order of open sessions."""
    with database.writing() as db:
        study = study_by_key(db, STUDY)
        yaml = versions_of(db, study)[-1].source_yaml
        add_version(db, study, yaml.replace("operator: false", "operator: true"), NOW)
    _build(
        database,
        SessionSpec("P-0001"),
        SessionSpec("P-0002"),
        SessionSpec("P-0003", status="active"),
    )
    view = _dashboard(database)
    figures = {entry.key: entry for entry in view.figures}
    assert view.n_running == 0
    assert not any("P-0003" in json.dumps(entry.figure) for entry in view.figures)
    assert all(figures[key].n == 2 for key in COUNTING if key not in NEEDS_MOVEMENT)
    assert all("blinded" in entry.caption for entry in view.figures)
    # Nor can an open session's order be found by filtering for one order after the other.
    with database.reading() as db:
        material = read_material(db, STUDY, "people")
    for order in view.choices.orders:
        left = material.chosen(FigureFilter(order=order)).sessions
        assert "P-0003" not in set(left["participant_code"])
    assert {tuple(trace["x"]) for trace in _figures(view)["progress"]["data"]} == {("all orders",)}


@pytest.mark.one_engine
def test_a_filter_limits_the_figures_and_is_stated(database: Database) -> None:
    """A filter by participant, limb or day limits every figure and is stated in its caption."""
    _build(database, SessionSpec("P-0001"), SessionSpec("P-0002"))
    chosen = FigureFilter(participant=("P-0002",), limb="foot")
    view = _dashboard(database, chosen=chosen)
    assert (view.n_sessions, view.choices.participants) == (1, ["P-0001", "P-0002"])
    assert all("participants P-0002, the foot task" in one.caption for one in view.figures)
    agency = _figures(view)["embodiment_agency"]
    assert {trace["name"] for trace in agency["data"]} == {"participants", "mean, foot"}
    assert "P-0001" not in json.dumps(agency)
    day = view.choices.first_day
    assert day is not None
    none = _dashboard(database, chosen=FigureFilter(until=day - timedelta(days=1)))
    assert none.n_sessions == 0
    assert all((one.empty or "").startswith("For this selection: ") for one in none.figures)


@pytest.mark.one_engine
def test_invalid_rows_are_drawn_only_on_request(database: Database) -> None:
    """Invalid rows are drawn only on request, and the captions say so."""
    _build(database, SessionSpec("P-0001"), SessionSpec("P-0002", status="withdrawn"))
    figures = {
        rows: {one.key: one for one in _dashboard(database, chosen=chosen).figures}
        for rows, chosen in (("valid", NO_FILTER), ("all", FigureFilter(rows="all")))
    }
    assert [figures[rows]["completions"].n for rows in ("valid", "all")] == [1, 2]
    assert "Invalid rows are included, too" in figures["all"]["completions"].caption


@pytest.mark.one_engine
def test_the_rows_of_a_figure_are_those_drawn(database: Database) -> None:
    """A figure's rows as CSV contain the means and intervals that are drawn."""
    _build(database, *(SessionSpec(f"SIM-{at}", kind="simulated") for at in range(3)))
    with database.reading() as db:
        material = read_material(db, STUDY, "simulated")
    drawing = next(one for one in drawings_of(material) if one.key == "embodiment_agency")
    text = sheet_of(drawing, material).decode()
    assert text.startswith("# Reembody, study reembodiment-latency. SIMULATED DATA")
    frame = pd.read_csv(io.StringIO(text), comment="#")
    assert frame["simulated"].all()
    means = frame[(frame["row"] == "mean") & (frame["limb"] == "hand")]
    trace = next(
        one for one in (drawing.as_json() or {})["data"] if one.get("name") == "mean, hand"
    )
    assert means["value"].tolist() == pytest.approx(trace["y"])
    half = (means["ci95_high"] - means["value"]).tolist()
    assert half == pytest.approx(trace["error_y"]["array"])
    assert frame["participant_code"].nunique() == 3


@pytest.mark.one_engine
def test_an_unknown_study_has_no_dashboard(database: Database) -> None:
    """The dashboard of an unknown study is not found."""
    with database.reading() as db, pytest.raises(NotFound):
        build_dashboard(db, "nothing", "people")
