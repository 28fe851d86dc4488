"""The dashboard of a study."""

import json
from typing import Any

import plotly.graph_objects as go
import pytest

from app.database import Database
from app.errors import NotFound
from app.features.analysis.dashboard import build_dashboard
from app.features.analysis.schemas import DashboardFigures, DashboardKind
from app.features.studies.service import add_version, study_by_key, versions_of
from tests.features.builders import NOW, STUDY, SessionSpec, build_session

KEYS = [
    "embodiment_ownership",
    "embodiment_agency",
    "embodiment_location",
    "embodiment_soe_thesis",
    "joint_error_parts",
    "joint_error_joints",
    "contacts",
    "completions",
    "progress",
]


def _dashboard(database: Database, kind: DashboardKind = "people") -> DashboardFigures:
    with database.reading() as db:
        return build_dashboard(db, STUDY, kind)


def _build(database: Database, *specs: SessionSpec) -> None:
    with database.writing() as db:
        for spec in specs:
            build_session(db, spec)


def _figures(view: DashboardFigures) -> dict[str, dict[str, Any]]:
    return {figure.key: figure.figure for figure in view.figures if figure.figure is not None}


def _axes(figure: dict[str, Any]) -> list[dict[str, Any]]:
    layout = figure["layout"]
    return [value for name, value in layout.items() if name[:5] in ("xaxis", "yaxis")]


def test_every_figure_is_valid_and_travels_as_plain_json(database: Database) -> None:
    """plotly's own validation takes each; no packed arrays, no NaN."""
    _build(database, SessionSpec("P-0001"), SessionSpec("P-0002"))
    view = _dashboard(database)
    assert [figure.key for figure in view.figures] == KEYS
    text = json.dumps(view.model_dump(mode="json"), allow_nan=False)
    assert "bdata" not in text
    for figure in _figures(view).values():
        go.Figure(figure)
    assert list(_figures(view)) == KEYS


def test_every_figure_says_what_it_shows(database: Database) -> None:
    """Title, caption, units on the axes, hover texts, a clear background, and how many people."""
    _build(database, SessionSpec("P-0001"), SessionSpec("P-0002"))
    view = _dashboard(database)
    for entry in view.figures:
        assert entry.figure is not None
        assert entry.figure["layout"]["title"]["text"] == entry.title
        assert f"n = {entry.n} participants" in entry.caption
        template = entry.figure["layout"]["template"]["layout"]
        assert template["paper_bgcolor"] == "rgba(0, 0, 0, 0)"
        assert all("hovertemplate" in trace for trace in entry.figure["data"])
        titles = [axis["title"]["text"] for axis in _axes(entry.figure) if "title" in axis]
        assert any("(" in title for title in titles)


def test_simulated_data_are_marked_and_alone(database: Database) -> None:
    """Every title begins with Simulated; people's sessions are not in it, nor the reverse."""
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


def test_nobody_gives_a_sentence_instead_of_a_plot(database: Database) -> None:
    """Without participants every entry says in words what is missing."""
    _build(database)
    for entry in _dashboard(database).figures:
        assert entry.figure is None
        assert entry.empty is not None
        assert entry.empty.startswith("No ")


def test_one_participant_is_drawn_without_an_interval(database: Database) -> None:
    """The first participant is shown, and the caption says that an interval is missing."""
    _build(database, SessionSpec("P-1"))
    figures = {entry.key: entry for entry in _dashboard(database).figures}
    agency = figures["embodiment_agency"]
    assert agency.figure is not None
    assert "no interval yet" in agency.caption


def test_only_valid_data_are_drawn(database: Database) -> None:
    """A withdrawn session and a first attempt change no measure."""
    _build(database, SessionSpec("P-0001"), SessionSpec("P-0002"))
    before = _figures(_dashboard(database))
    _build(database, SessionSpec("P-0003", status="withdrawn", completions=lambda _: 50))
    after = _figures(_dashboard(database))
    assert {key: after[key] for key in KEYS[:-1]} == {key: before[key] for key in KEYS[:-1]}
    assert after["progress"] != before["progress"]


def test_the_counts_are_those_of_the_study(database: Database) -> None:
    """Sessions, completed ones, and the avatars there were."""
    _build(database, SessionSpec("P-1"), SessionSpec("P-2", status="active"))
    view = _dashboard(database)
    assert (view.n_sessions, view.n_completed, view.avatar) == (2, 1, ["delayed_copy"])


def test_a_blinded_dashboard_tells_nothing_about_open_sessions(database: Database) -> None:
    """Their measures are left out, and orders are not told apart."""
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
    assert "P-0003" not in view.model_dump_json()
    assert all(figure.n == 2 for figure in view.figures[:-1])
    assert all("blinded" in figure.caption for figure in view.figures)
    assert {tuple(trace["x"]) for trace in _figures(view)["progress"]["data"]} == {("all orders",)}


def test_an_unknown_study_has_no_dashboard(database: Database) -> None:
    """The error names the studies there are."""
    with database.reading() as db, pytest.raises(NotFound):
        build_dashboard(db, "nothing", "people")
