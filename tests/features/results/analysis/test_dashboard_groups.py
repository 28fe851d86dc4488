"""Groups of a dashboard's figures, the tables kept for them, and joint error over a session."""

from typing import get_args

import pytest

from app.database import Database
from app.features.results.analysis.dashboard import dashboard_of, drawings_of
from app.features.results.analysis.material import MaterialStore, read_material
from app.features.results.analysis.schemas import FigureGroup
from app.features.results.analysis.state import state_of_data
from tests.features.builders import STUDY, SessionSpec, build_session


def _build(database: Database, *specs: SessionSpec) -> None:
    with database.writing() as db:
        for spec in specs:
            build_session(db, spec)


@pytest.mark.one_engine
def test_a_group_has_the_figures_that_all_have_and_reads_no_other_table(
    database: Database,
) -> None:
    """The groups together are the whole page; progress is drawn from sessions and limbs alone."""
    _build(database, SessionSpec("P-0001"), SessionSpec("P-0002"))
    with database.reading() as db:
        material = MaterialStore().get(db, STUDY, "people", "first")
        progress = dashboard_of(material, group="progress")
        assert set(material.tables) == {"sessions", "limbs"}
        groups = [dashboard_of(material, group=group).figures for group in get_args(FigureGroup)]
    assert [one.key for one in progress.figures] == ["progress_time", "progress"]
    whole = {one.key: one for one in dashboard_of(material).figures}
    assert {one.key: one for figures in groups for one in figures} == whole
    assert sum(map(len, groups)) == len(whole)


@pytest.mark.one_engine
def test_kept_tables_are_read_anew_in_another_state_and_by_database(database: Database) -> None:
    """The same state reads nothing twice; another one, and another study's kind, begins anew."""
    _build(database, SessionSpec("P-0001"))
    store = MaterialStore()
    with database.reading() as db:
        state = state_of_data(db, STUDY, "people")
        sessions = store.get(db, STUDY, "people", state).sessions
    _build(database, SessionSpec("P-0002"))
    with database.reading() as db:
        assert store.get(db, STUDY, "people", state).sessions is sessions
        newer = state_of_data(db, STUDY, "people")
        assert newer != state
        assert len(store.get(db, STUDY, "people", newer).phases["session_id"].unique()) == 2
        assert store.get(db, STUDY, "simulated", newer).sessions.empty


@pytest.mark.one_engine
def test_joint_error_over_a_session_is_the_mean_over_those_who_had_the_latency_then(
    database: Database,
) -> None:
    """Of every limb, latency and block: mean and n are those of the table of joint errors."""
    _build(database, *(SessionSpec(f"P-{at}") for at in range(4)))
    with database.reading() as db:
        material = read_material(db, STUDY, "people")
    drawing = next(one for one in drawings_of(material) if one.key == "joint_error_blocks")
    rows = material.errors[material.errors["phase_kind"] == "task"]
    each = rows.groupby(["limb", "latency_ms", "block", "participant_code"])["mean_deg"].mean()
    cells = each.groupby(level=["limb", "latency_ms", "block"]).agg(["mean", "count"])
    found = drawing.data.set_index(["limb", "latency_ms", "block"])
    assert found["mean_deg"].to_dict() == pytest.approx(cells["mean"].to_dict())
    assert found["n"].to_dict() == cells["count"].to_dict()
    # Four participants, six orders: somebody is alone in a cell, and has no interval.
    assert (found["ci95_low_deg"].isna() == (found["n"] == 1)).all()
    assert set(found["n"]) == {1, 2}
