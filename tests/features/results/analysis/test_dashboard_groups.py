"""Tests of groups of figures, the cached tables, and joint error over a session."""

from typing import get_args

import pytest
from pydantic import BaseModel

from app.database import Database
from app.features.results.analysis.dashboard import dashboard_of, drawings_of
from app.features.results.analysis.drawing import GROUPS, join_figures
from app.features.results.analysis.material import MaterialStore, read_material
from app.features.results.analysis.schemas import FigureGroup
from app.features.results.analysis.state import state_of_data
from tests.features.builders import STUDY, SessionSpec, build_session


def _build(database: Database, *specs: SessionSpec) -> None:
    with database.writing() as db:
        for spec in specs:
            build_session(db, spec)


def json_of(view: BaseModel) -> bytes:
    """Return a view as the JSON that a worker process makes of it."""
    return view.model_dump_json().encode()


@pytest.mark.one_engine
def test_a_group_has_its_figures_and_reads_only_its_tables(
    database: Database,
) -> None:
    """A group has the same figures as on the whole dashboard and reads only the tables it needs.

    Joined, the groups are the whole dashboard, byte for byte.
    """
    _build(database, SessionSpec("P-0001"), SessionSpec("P-0002"))
    with database.reading() as db:
        material = MaterialStore().get(db, STUDY, "people", "first")
        progress = dashboard_of(material, group="progress")
        assert set(material.tables) == {"sessions", "limbs"}
        groups = [dashboard_of(material, group=group).figures for group in get_args(FigureGroup)]
        bodies = [json_of(dashboard_of(material, group=group)) for group in GROUPS]
        assert join_figures(bodies) == json_of(dashboard_of(material))
    assert [one.key for one in progress.figures] == ["progress_time", "progress"]
    whole = {one.key: one for one in dashboard_of(material).figures}
    assert {one.key: one for figures in groups for one in figures} == whole
    assert sum(map(len, groups)) == len(whole)


@pytest.mark.one_engine
def test_cached_tables_are_reread_when_the_data_change(database: Database) -> None:
    """Cached tables are reread only when the state of the data or the kind changes."""
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
def test_joint_error_by_block_is_the_mean_of_its_participants(
    database: Database,
) -> None:
    """Joint error by limb, latency and block is the mean over the participants in that cell."""
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
    # With four participants and six orders some cells have one participant and no interval.
    assert (found["ci95_low_deg"].isna() == (found["n"] == 1)).all()
    assert set(found["n"]) == {1, 2}
