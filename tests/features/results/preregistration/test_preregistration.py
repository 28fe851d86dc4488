"""Tests of the preregistration page: declared tests, actual tests and all deviations."""

import re
from collections.abc import Iterator
from datetime import timedelta

import pytest
from sqlalchemy import delete, select

from app.database import Database, open_database
from app.features.design.studies import add_version, freeze, newest_version, study_by_key
from app.features.results.analysis.material import read_material
from app.features.results.analysis.questions.answers import answers_of
from app.features.results.analysis.tables import phases_table
from app.features.results.preregistration.markdown import as_markdown, without_codes
from app.features.results.preregistration.schemas import PreregistrationView
from app.features.results.preregistration.service import preregistration_of
from app.models import (
    Answer,
    Completion,
    Contact,
    Erasure,
    Participant,
    ScoreValue,
    StudySession,
    Submission,
)
from tests.features.builders import NOW, STUDY, SessionSpec, build_session, build_study
from tests.features.lab import Lab, error
from tests.protocol.helpers import STUDY as FILE
from tests.protocol.test_preregistration import SECTION

LABELS = ["no added latency", "125 ms added", "350 ms added"]
LATER = NOW + timedelta(days=30)


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """Yield a database with the shipped studies."""
    database = open_database(database_url)
    with database.writing() as db:
        build_study(db)
    yield database
    database.close()


def declare(database: Database, section: str, days: int = -1) -> None:
    """Store a version of the study with this preregistration."""
    with database.writing() as db:
        add_version(db, study_by_key(db, STUDY), FILE + section, NOW + timedelta(days=days))


def visit(database: Database, code: str, status: str = "completed") -> None:
    """Store a session of the newest version."""
    with database.writing() as db:
        session: StudySession = build_session(db, SessionSpec(code=code, status=status))
        freeze(newest_version(db, study_by_key(db, STUDY)), session.created_at)


def forget(database: Database, code: str) -> None:
    """Erase what a participant did, as an erasure leaves it: the session and its phases remain."""
    with database.writing() as db:
        person = db.scalars(select(Participant).where(Participant.code == code)).one()
        session = db.scalars(
            select(StudySession).where(StudySession.participant_id == person.id)
        ).one()
        submissions = select(Submission.id).where(Submission.session_id == session.id)
        for rows in (Answer, ScoreValue):
            db.execute(delete(rows).where(rows.submission_id.in_(submissions)))
        for table in (Completion, Contact, Submission):
            db.execute(delete(table).where(table.session_id == session.id))
        tombstone = {"sessions": [session.id], "removed": {}, "remaining": []}
        db.add(
            Erasure(
                study_id=session.study_id, participant_id=person.id, by="account:admin", at=NOW,
                **tombstone,
            )
        )  # fmt: skip


def view_of(database: Database) -> PreregistrationView:
    """Return the current preregistration page."""
    with database.reading() as db:
        return preregistration_of(db, STUDY, "people", LATER)


def codes_of(view: PreregistrationView) -> list[str]:
    """Return the codes of all deviations and notes."""
    return [one.code for one in view.deviations]


@pytest.mark.one_engine
def test_a_study_without_preregistration_says_so(database: Database) -> None:
    """The page of a study without a preregistration says so and shows no result."""
    visit(database, "P1")
    view = view_of(database)
    assert (view.declaration, view.result, view.deviations) == (None, None, [])
    assert "Not preregistered." in as_markdown(view)


@pytest.mark.one_engine
def test_a_declaration_is_shown_before_the_first_session(database: Database) -> None:
    """A preregistration is shown before the first session, without a result."""
    declare(database, SECTION)
    view = view_of(database)
    assert view.declaration is not None
    assert view.declaration.frozen_at is None
    assert (view.sessions, view.included, view.excluded, view.result) == (0, 0, [], None)
    assert "n_short" in codes_of(view)
    assert "0 of 12 declared participants" in as_markdown(view)


def test_the_declared_test_is_run_and_deviations_are_listed(database: Database) -> None:
    """The declared exclusions and test are applied, and every deviation is listed."""
    declare(database, SECTION)
    for n in range(1, 5):
        visit(database, f"P{n}")
    visit(database, "P5", "withdrawn")
    view = view_of(database)
    assert view.declaration is not None
    with database.reading() as db:
        version = newest_version(db, study_by_key(db, STUDY))
        assert view.declaration.content_hash == version.content_hash
    assert (view.declaration.version, view.declaration.planned_n) == (2, 12)
    assert view.declaration.frozen_at is not None
    assert [(one.participant_code, one.rule) for one in view.excluded] == [
        ("P5", "complete_session")
    ]
    assert (view.sessions, view.included) == (5, 4)
    assert view.result is not None
    assert view.result.n == 4
    assert view.result.sentence.startswith("L = ")
    assert [row[0] for row in view.result.rows] == LABELS
    assert view.declaration.names.score == {"en": "Agency", "de": "Handlungsurheberschaft"}
    reported = codes_of(view)
    assert "n_short" in reported
    assert "left_out_by_hand" not in reported
    assert "declared_late" not in reported
    assert reported[-1] == "exploratory"


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("declared", "reason"),
    [
        ("test: page_trend", "Each of 4 subjects has the same value at all 3 levels"),
        (
            "correction: holm, reference: latency_0, test: against_reference",
            "There is nothing to test. 125 ms added – no added latency was not tested",
        ),
    ],
)
def test_a_declared_test_of_equal_answers_has_no_result(
    database: Database, declared: str, reason: str
) -> None:
    """If everybody answers the same in every condition, the reason stands in place of a result."""
    declare(database, SECTION.replace("test: page_trend", declared))
    with database.writing() as db:
        for at in range(4):
            build_session(db, SessionSpec(f"P{at}", likert=lambda _step, _item: 4))
    view = view_of(database)
    assert view.result is None
    assert view.why_no_result is not None
    assert view.why_no_result.startswith(reason)
    assert "p = " not in as_markdown(view).partition("## Done")[2]


@pytest.mark.one_engine
def test_changes_after_the_first_session_are_listed(database: Database) -> None:
    """A late or changed declaration and exclusions without a rule are listed as deviations."""
    visit(database, "P1")
    visit(database, "P2", "aborted")
    declare(database, SECTION.replace("    - {rule: complete_session}\n", ""), days=1)
    visit(database, "P3")
    reported = codes_of(view_of(database))
    assert {"declared_late", "declaration_changed", "left_out_by_hand", "n_short"} <= set(reported)


@pytest.mark.one_engine
def test_the_registrys_copy_names_no_participant(database: Database) -> None:
    """The copy for a registry contains no participant codes."""
    declare(database, SECTION)
    for code, status in (("canary-1", "withdrawn"), ("canary-2", "completed")):
        visit(database, code, status)
    text = as_markdown(without_codes(view_of(database)))
    assert "canary" not in text
    assert "excluded 1: complete_session" in text
    for word in ("## Declared", "## Done", "## Deviations", "SHA-256"):
        assert word in text


def test_an_erased_person_is_in_no_test_and_no_mean(database: Database) -> None:
    """What is left of an erased session is not valid, and its counts are missing, not zero."""
    measure = SECTION.replace(
        "{measure: score, instrument: karas2020, score: agency, limb: hand,",
        "{measure: completions, limb: hand,",
    )
    declare(database, measure)
    for n in range(1, 5):
        visit(database, f"P{n}")
    forget(database, "P4")
    view = view_of(database)
    assert (view.sessions, view.included) == (4, 3)
    # Everybody has as many in every condition.
    assert view.result is None
    assert [(one.participant_code, one.reason) for one in view.excluded] == [
        ("P4", "the participant’s data were erased")
    ]
    with database.reading() as db:
        phases = phases_table(db, STUDY, "people")
        found = answers_of(read_material(db, STUDY, "people"))
    left = phases[phases["participant_code"] == "P4"]
    assert not left["valid"].any()
    counts = left[["completions", "side_contacts", "side_red_s"]]
    assert counts.isna().to_numpy().all()
    assert phases[phases["participant_code"] == "P3"]["completions"].notna().all()
    assert {one.n for one in found.measures} == {3}
    assert (found.n_completed, found.n_not_valid) == (4, 1)


@pytest.mark.one_engine
def test_the_statistics_page_has_the_same_l_as_the_declared_test(database: Database) -> None:
    """Page's L is that of ascending latencies on both pages, whatever direction was declared."""
    declare(database, SECTION)
    for n in range(1, 7):
        visit(database, f"P{n}")
    result = view_of(database).result
    assert result is not None
    with database.reading() as db:
        found = answers_of(read_material(db, STUDY, "people"))
    (agency,) = (one for one in found.measures if one.key == "karas2020_agency")
    (trend,) = (one for one in agency.results if one.key == "trend_hand")
    declared_l, page_l = (
        float(re.findall(r"L = ([0-9.]+)", text)[0]) for text in (result.sentence, trend.apa)
    )
    assert declared_l == page_l


@pytest.mark.one_engine
def test_a_limb_that_nobody_used_is_not_left_out_silently(database: Database) -> None:
    """Where the mean of hand and foot was declared, nobody without a foot task is tested."""
    declare(database, SECTION.replace("limb: hand", "limb: both"))
    skipped = tuple(
        f"block{block}.{step}" for block in (1, 2, 3) for step in ("foot", "foot.karas2020")
    )
    for n in range(1, 5):
        with database.writing() as db:
            build_session(db, SessionSpec(code=f"P{n}", skipped=skipped))
    view = view_of(database)
    assert view.result is None
    assert view.why_no_result


@pytest.mark.one_engine
@pytest.mark.parametrize("path", ["preregistration", "preregistration/report"])
def test_an_unknown_parameter_is_refused(lab: Lab, path: str) -> None:
    """A parameter that does not exist is refused, as on the dashboard, and not passed over."""
    address = f"/api/studies/{STUDY}/{path}"
    assert lab.operator.get(address, params={"kind": "test"}).status_code == 200
    refusal = error(lab.operator.get(address, params={"format": "zz"}), 422, "invalid_input")
    assert [one["message"] for one in refusal["details"]] == ["Extra inputs are not permitted"]
