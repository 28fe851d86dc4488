"""Tests of the rows of one figure, which are found without drawing every other figure."""

import pytest

from app.database import Database
from app.errors import NotFound
from app.features.design.studies import add_version, create_study, study_by_key
from app.features.movement.avatar import add_shipped_avatar
from app.features.movement.humanoids import add_shipped_bodies
from app.features.results.analysis import worker_tasks
from app.features.results.analysis.dashboard import drawings_of
from app.features.results.analysis.figures import FIGURES, Rows
from app.features.results.analysis.material import Material, read_material
from app.features.results.analysis.schemas import NO_FILTER
from app.features.results.analysis.sheets import sheet_of
from app.resources import study_configs_dir
from tests.features.builders import NOW, STUDY, SessionSpec, build_session
from tests.protocol.test_condition_bodies import with_bodies

ROAD = "road-crossing"
PHYSICS = "physics\navatar_configuration: {key: standard, version: 2}"


def _everything_is_found(material: Material) -> set[str]:
    """Return the keys of all figures; each is drawn, the same, when it alone is asked for."""
    everything = {one.key: one for one in drawings_of(material)}
    for key, drawing in everything.items():
        alone = {one.key: one for one in drawings_of(material, figure=key)}
        assert sheet_of(alone[key], material) == sheet_of(drawing, material)
        assert len(alone) < len(everything) / 3
    return set(everything)


@pytest.mark.one_engine
def test_every_figure_is_found_by_its_key(database: Database) -> None:
    """In studies with boxes, with a road and with bodies, every figure is found by its key alone.

    And it is the entry that says so which draws it.
    """
    text = with_bodies("female", "male", physics=False).replace("latency_ms: 125", "latency_ms: 0")
    text = text.replace("latency_ms: 350", "latency_ms: 0")
    text = text.replace("avatar: delayed_copy", f"avatar: {PHYSICS}", 1)
    with database.writing() as db:
        build_session(db, SessionSpec("P-0001"))
        create_study(
            db, (study_configs_dir() / "templates" / f"{ROAD}.yaml").read_text("utf-8"), NOW
        )
        build_session(db, SessionSpec("P-0001", kind="test"), ROAD)
        boxes = _everything_is_found(read_material(db, STUDY, "people"))
        road = _everything_is_found(read_material(db, ROAD, "test"))
        add_shipped_bodies(db, NOW)
        add_shipped_avatar(db, NOW)
        add_version(db, study_by_key(db, STUDY), text, NOW)
        build_session(db, SessionSpec("P-0002"))
        build_session(db, SessionSpec("P-0003"))
        material = read_material(db, STUDY, "people")
        bodies = _everything_is_found(material)
        for entry in FIGURES:
            keys = [one.key for one in entry.draw(Rows(material, invalid=True))]
            assert all(map(entry.may_draw, keys)), (entry.keys, keys)
    assert "progress_time" in boxes
    assert any(key.startswith("crossing_") for key in road)
    assert "completions_bodies_0ms" in bodies
    assert "joint_error_bodies_0ms" in bodies


@pytest.mark.one_engine
def test_one_figure_needs_its_own_tables_only(database: Database, database_url: str) -> None:
    """The rows of a figure are made from its own tables; an unknown figure names all there are."""
    with database.writing() as db:
        build_session(db, SessionSpec("P-0001"))
    rows = worker_tasks.sheet(database_url, STUDY, "people", NO_FILTER, "progress_time")
    assert b"," in rows
    with worker_tasks._material(database_url, STUDY, "people") as material:
        assert set(material.tables) == {"sessions"}
    with pytest.raises(NotFound) as refused:
        worker_tasks.sheet(database_url, STUDY, "people", NO_FILTER, "nothing")
    assert isinstance(refused.value.valid, list)
    assert {"completions", "progress"} <= set(refused.value.valid)
