"""Tests that figures and tests leave phases on the road out."""

import pytest
from sqlalchemy import update

from app.database import Database
from app.features.results.analysis.dashboard import build_dashboard
from app.features.results.analysis.material import read_material
from app.features.results.analysis.questions.answers import answers_of
from app.models import Phase
from app.protocol import ROAD_KINDS
from tests.features.builders import STUDY, SessionSpec, build_session


@pytest.mark.one_engine
def test_figures_and_tests_of_boxes_leave_the_road_out(database: Database) -> None:
    """With crossings instead of foot tasks every figure is drawn, and tests are of the hand."""
    with database.writing() as db:
        for code in ("P-0001", "P-0002", "P-0003"):
            build_session(db, SessionSpec(code))
        feet = update(Phase).where(Phase.limb == "foot")
        db.execute(feet.values(kind=ROAD_KINDS[0], limb=None))
    with database.reading() as db:
        figures = {one.key: one.figure for one in build_dashboard(db, STUDY, "people").figures}
        found = {one.key: one for one in answers_of(read_material(db, STUDY, "people")).measures}
    assert None not in (figures["completions"], figures["contacts"], figures["joint_error_body"])
    for measure in ("completions", "contact_time", "joint_error"):
        assert {one.limb for one in found[measure].glance} == {"hand"}
