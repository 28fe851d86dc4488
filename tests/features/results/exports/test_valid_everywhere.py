"""Tests that ledger, dashboard, statistics and export agree on a session that is not valid."""

from pathlib import Path

import pytest

from app.database import Database
from app.features.design.studies import add_version, study_by_key
from app.features.record.ledger import Shortfall, settle_attempt
from app.features.results.analysis.dashboard import NONE_COUNTS, build_dashboard
from app.features.results.analysis.material import read_material
from app.features.results.analysis.questions.answers import answers_of
from app.features.results.preregistration.exclusions import exclude, read_tables
from app.models import SlotAttempt, StudySession
from tests.features.builders import NOW, STUDY, SessionSpec, build_session
from tests.features.results.exports.whole import export, rows_of, tree_of
from tests.protocol.helpers import BEFORE_RULES

SKIPPED = Shortfall(code="phase_skipped", step="block2.hand", block=2, phase="hand")
WHY = "block 2, hand task: skipped"


def lacking(database: Database, code: str) -> StudySession:
    """Store a completed session that lacks a task."""
    with database.writing() as db:
        session = build_session(db, SessionSpec(code, skipped=("block2.hand",)))
        session.shortfalls = [SKIPPED.model_dump()]
        settle_attempt(db, session, counts=False)
        return session


@pytest.mark.one_engine
def test_a_session_that_is_not_valid_is_left_out_everywhere(
    database: Database, tmp_path: Path
) -> None:
    """A session that is not valid is left out of every result and named with its reason."""
    with database.writing() as db:
        for code in ("P-0001", "P-0002"):
            build_session(db, SessionSpec(code))
    lacking(database, "P-0003")
    with database.reading() as db:
        outcomes = db.query(SlotAttempt.outcome).order_by(SlotAttempt.outcome).all()
        view = build_dashboard(db, STUDY, "people")
        found = answers_of(read_material(db, STUDY, "people"))
        excluded = exclude(read_tables(db, STUDY, "people"), ()).found
    assert [one for (one,) in outcomes] == ["completed", "completed", "invalid"]
    assert (view.n_sessions, view.n_completed, view.n_not_valid) == (3, 3, 1)
    assert {one.n for one in view.figures if one.group in ("embodiment", "tasks")} == {2}
    assert (found.n_completed, found.n_not_valid) == (3, 1)
    for measure in found.measures:
        assert f"P-0003: not valid ({WHY})" in measure.left_out
    assert [(one.participant_code, one.rule, one.reason) for one in excluded] == [
        ("P-0003", "valid_when", WHY)
    ]
    export(database, tmp_path / "out", kind="people")
    tree = tree_of(tmp_path / "out")
    sessions = {row["participant_code"]: row for row in rows_of(tree["sessions.csv"])}
    assert {code: row["valid"] for code, row in sessions.items()} == {
        "P-0001": "true",
        "P-0002": "true",
        "P-0003": "false",
    }
    assert [row["reasons_not_valid"] for row in sessions.values()] == ["", "", WHY]
    for name in ("phases", "answers", "scores", "contacts", "completions", "joint_errors"):
        counting = {row["participant_code"] for row in rows_of(tree[f"{name}.csv"]) if valid(row)}
        assert counting == {"P-0001", "P-0002"}, name
    assert b"reasons_not_valid" in tree["README.txt"]
    assert b"Not valid         1 completed" in tree["README.txt"]
    assert [row["participant_code"] for row in rows_of(tree["wide.csv"])] == ["P-0001", "P-0002"]


def valid(row: dict[str, str]) -> bool:
    """Return whether a row is marked as valid."""
    return row["valid"] == "true"


@pytest.mark.one_engine
def test_a_figure_without_valid_data_says_that_there_are_data(database: Database) -> None:
    """A figure without valid data states that there are sessions which are not valid."""
    lacking(database, "P-0001")
    with database.reading() as db:
        view = build_dashboard(db, STUDY, "people")
    agency = next(one for one in view.figures if one.key == "embodiment_agency")
    assert agency.empty == f"No participant has a complete questionnaire yet. {NONE_COUNTS}"


@pytest.mark.one_engine
def test_an_export_of_a_study_without_validity_rules_is_unchanged(
    database: Database, tmp_path: Path
) -> None:
    """An export of a study without validity rules has no columns or text about them."""
    with database.writing() as db:
        add_version(db, study_by_key(db, STUDY), BEFORE_RULES, NOW)
        build_session(db, SessionSpec("P-0001", skipped=("block2.hand",)))
        # A newer version with rules but without sessions changes nothing.
        add_version(db, study_by_key(db, STUDY), BEFORE_RULES + RULES, NOW)
    export(database, tmp_path / "out", kind="people")
    tree = tree_of(tmp_path / "out")
    [session] = rows_of(tree["sessions.csv"])
    assert session["valid"] == "true"
    assert "reasons_not_valid" not in session
    meanings = {
        (row["table"], row["column"]): row["meaning"] for row in rows_of(tree["codebook.csv"])
    }
    assert meanings["sessions", "valid"].startswith(
        "False if the session was aborted or withdrawn, if its data were erased, or if its"
    )
    assert ("sessions", "reasons_not_valid") not in meanings
    assert "neither aborted nor withdrawn" in meanings["phases", "valid"]
    assert b"valid_when" not in b"".join(tree.values())


RULES = "\nvalid_when:\n  forms: [karas2020]\n"
