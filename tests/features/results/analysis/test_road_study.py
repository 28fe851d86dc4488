"""Tests of the dashboard of a study whose participants only cross a road, without boxes."""

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.database import Database
from app.features.design.studies import create_study
from app.features.record.ledger import Shortfall, settle_attempt
from app.features.results.analysis.dashboard import NONE_COUNTS, build_dashboard
from app.features.results.analysis.schemas import DashboardFigures
from app.features.results.analysis.state import state_of_data
from app.models import Phase, RoadCrossing, RoadRun, StudySession
from app.protocol import ROAD_KINDS
from app.resources import study_configs_dir
from tests.features.builders import NOW, STUDY, SessionSpec, build_session, build_study

TEMPLATE = study_configs_dir() / "templates" / "road-crossing.yaml"
ROAD = "road-crossing"
OF_BOXES = {
    *("completions", "learning", "contacts", "contacts_map"),
    *("joint_error_blocks", "joint_error_course"),
}
SKIPPED = Shortfall(code="phase_skipped", step="block2.road_crossing", block=2)


def _build(db: Session) -> StudySession:
    build_study(db)
    create_study(db, TEMPLATE.read_text(encoding="utf-8"), NOW)
    return build_session(db, SessionSpec("P-0001"), ROAD)


def _cross(db: Session, session: StudySession) -> None:
    """Store one crossing with no car coming in each phase on the road."""
    own = (Phase.session_id == session.id, Phase.kind.in_(ROAD_KINDS))
    for phase_id in db.scalars(select(Phase.phase_id).where(*own)).all():
        key = f"run{phase_id}"
        db.add(
            RoadRun(
                id=key,
                session_id=session.id,
                phase_id=phase_id,
                part=1,
                seed=1,
                begins_at_s=0.0,
                header={},
                began_at=NOW,
                ended="complete",
            )
        )
        db.flush()
        db.add(
            RoadCrossing(
                run_id=key,
                number=1,
                session_id=session.id,
                phase_id=phase_id,
                steps_on_s=3.0,
                steps_off_s=6.0,
                is_across=True,
                waited_s=2.0,
                gaps_refused_s=[],
            )
        )
    db.flush()


def _empty(view: DashboardFigures) -> dict[str, str | None]:
    return {one.key: one.empty for one in view.figures}


@pytest.mark.one_engine
def test_crossings_are_drawn_and_said_not_to_count_if_their_session_does_not(
    database: Database,
) -> None:
    """Once crossings are stored the figures know it, and say so where none of them is valid."""
    none_yet = "No participant has a crossing of the road in a finished phase yet."
    with database.writing() as db:
        session = _build(db)
        before, state = build_dashboard(db, ROAD, "people"), state_of_data(db, ROAD, "people")
        _cross(db, session)
        drawn, newer = build_dashboard(db, ROAD, "people"), state_of_data(db, ROAD, "people")
        session.shortfalls = [SKIPPED.model_dump()]
        settle_attempt(db, session, counts=False)
        left_out = build_dashboard(db, ROAD, "people")
    assert _empty(before)["crossing_waited_s"] == none_yet
    # A scene ends after its phase has: the tables that were read meanwhile are read again.
    assert state != newer
    assert _empty(drawn)["crossing_waited_s"] is None
    assert _empty(left_out)["crossing_waited_s"] == f"{none_yet} {NONE_COUNTS}"
    gap = "No participant has a crossing with a car coming in a finished phase yet."
    assert _empty(drawn)["crossing_gap_accepted_s"] == gap


@pytest.mark.one_engine
def test_figures_that_can_never_have_data_are_left_out(database: Database) -> None:
    """A study without boxes has no empty figures of boxes, one without a road none of crossings."""
    with database.writing() as db:
        _build(db)
        road = {one.key for one in build_dashboard(db, ROAD, "people").figures}
        boxes = {one.key for one in build_dashboard(db, STUDY, "people").figures}
    assert not road & OF_BOXES
    assert any(key.startswith("crossing_") for key in road)
    assert boxes > OF_BOXES
    assert not any(key.startswith("crossing_") for key in boxes)
