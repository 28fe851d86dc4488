"""Tests of the tables that represent the record."""

import math
from collections.abc import Callable

import pandas as pd
import pytest
from sqlalchemy import update
from sqlalchemy.orm import Session

from app.database import Database
from app.errors import NotFound
from app.features.results.analysis import tables
from app.features.results.analysis.codebook import columns_of
from app.features.results.analysis.questions import wide_table
from app.features.results.analysis.schemas import Kind
from app.models import JointErrorCourseRow, JointErrorRow
from tests.features.builders import STUDY, SessionSpec, build_session

Table = Callable[[Session, str, Kind], pd.DataFrame]
TABLES: dict[str, Table] = {
    "sessions": tables.sessions_table,
    "phases": tables.phases_table,
    "answers": tables.answers_table,
    "scores": tables.scores_table,
    "contacts": tables.contacts_table,
    "completions": tables.completions_table,
    "joint_errors": tables.joint_errors_table,
    "joint_error_course": tables.joint_error_course_table,
    "clock_probes": tables.clock_probes_table,
    "clock_mapping": tables.clock_mapping_table,
    "events": tables.events_table,
}


def _build(database: Database, *specs: SessionSpec) -> None:
    with database.writing() as db:
        for spec in specs:
            build_session(db, spec)


def _read(database: Database, table: str, kind: Kind = "people") -> pd.DataFrame:
    with database.reading() as db:
        return TABLES[table](db, STUDY, kind)


@pytest.mark.one_engine
@pytest.mark.parametrize("table", TABLES)
def test_an_empty_table_has_the_columns_of_the_codebook(database: Database, table: str) -> None:
    """A table without rows has the codebook's columns in order."""
    assert list(_read(database, table).columns) == [one.name for one in columns_of(table)]


@pytest.mark.parametrize("table", TABLES)
def test_a_table_has_the_columns_of_the_codebook(three_kinds: Database, table: str) -> None:
    """A table with rows has the codebook's columns in order."""
    filled = _read(three_kinds, table)
    assert list(filled.columns) == [one.name for one in columns_of(table)]
    assert len(filled) > 0


@pytest.mark.parametrize("table", TABLES)
def test_kinds_never_mix(three_kinds: Database, table: str) -> None:
    """A table of one kind of session has rows of that kind only; the kind `all` has all rows."""
    kinds: tuple[Kind, ...] = ("people", "simulated", "test")
    sizes = []
    for kind in kinds:
        rows = _read(three_kinds, table, kind)
        assert set(rows["kind"]) == {kind}
        assert set(rows["simulated"]) == {kind == "simulated"}
        assert set(rows["avatar"]) == {"delayed_copy"}
        sizes.append(len(rows))
    assert len(_read(three_kinds, table, "all")) == sum(sizes)


@pytest.mark.one_engine
@pytest.mark.parametrize(
    "table", ["phases", "contacts", "completions", "joint_errors", "joint_error_course"]
)
def test_a_repeated_phases_first_attempt_is_not_valid(database: Database, table: str) -> None:
    """Both attempts of a repeated phase are in the tables; only the second is valid."""
    _build(database, SessionSpec("P-0001", redone=("block1.hand",)))
    rows = _read(database, table)
    of_step = rows[(rows["block"] == 1) & (rows["limb"] == "hand")]
    assert set(zip(of_step["attempt"], of_step["valid"], strict=True)) == {(1, False), (2, True)}


@pytest.mark.one_engine
def test_only_the_last_attempt_of_a_repeated_form_is_valid(database: Database) -> None:
    """Answers and scores of a repeated form's first attempt are kept but marked as not valid."""
    _build(database, SessionSpec("P-0001", redone=("block2.foot.karas2020",)))
    for table in ("answers", "scores"):
        rows = _read(database, table)
        of_step = rows[(rows["block"] == 2) & (rows["limb"] == "foot")]
        found = set(zip(of_step["attempt"], of_step["valid"], strict=True))
        assert found == {(1, False), (2, True)}


@pytest.mark.one_engine
def test_a_form_about_a_skipped_phase_is_not_valid(database: Database) -> None:
    """The scores of a form about a skipped phase are not valid."""
    _build(database, SessionSpec("P-0001", skipped=("block3.foot",)))
    rows = _read(database, "scores")
    invalid = rows[~rows["valid"]]
    assert set(zip(invalid["block"], invalid["limb"], strict=True)) == {(3, "foot")}


@pytest.mark.parametrize("status", ["aborted", "withdrawn"])
def test_no_row_of_an_aborted_or_withdrawn_session_is_valid(
    database: Database, status: str
) -> None:
    """All rows of an aborted or withdrawn session are kept but marked as not valid."""
    _build(database, SessionSpec("P-0001", status=status))
    for table in TABLES:
        rows = _read(database, table)
        assert len(rows) > 0
        if "valid" in rows:
            assert not rows["valid"].any()


@pytest.mark.one_engine
def test_phases_have_their_block_position_and_limb(database: Database) -> None:
    """Every phase has its block, position, limb and latency of the session's order."""
    _build(database, SessionSpec("P-0001"))
    order = _read(database, "sessions")["order"].item()
    phases = _read(database, "phases").dropna(subset=["block"])
    assert phases["block"].tolist() == [1, 1, 2, 2, 3, 3]
    assert phases["position"].tolist() == [1, 2, 1, 2, 1, 2]
    assert phases["limb"].tolist() == ["hand", "foot"] * 3
    assert phases["latency_ms"].tolist()[::2] == [float(part) for part in order.split()]


@pytest.mark.one_engine
def test_red_time_is_the_union_over_body_parts(database: Database) -> None:
    """A side touched by two parts from 1 to 3 s and 2 to 4 s is red once, for 3 s."""
    _build(database, SessionSpec("P-0001"))
    phase = _read(database, "phases").dropna(subset=["block"]).iloc[0]
    assert (phase["side_red_s"], phase["side_contacts"]) == (3.0, 1)
    sides = _read(database, "contacts")
    sides = sides[(sides["surface_kind"] == "side") & (sides["phase_id"] == phase["phase_id"])]
    assert sides["duration_s"].tolist() == [2.0, 2.0]


@pytest.mark.one_engine
def test_joint_errors_are_in_degrees(database: Database) -> None:
    """A joint error of pi / 2 rad in the database is 90 degrees in the table."""
    _build(database, SessionSpec("P-0001", joint_error_rad=lambda _, __: math.pi / 2))
    rows = _read(database, "joint_errors")
    present = rows[rows["reference"] == "present"]
    assert present["mean_deg"].tolist() == pytest.approx([90.0] * len(present))


def test_a_course_has_a_row_for_every_bin_in_order_of_time(database: Database) -> None:
    """A course has a row for every 5 s bin in order of time; one without samples is empty."""
    _build(database, SessionSpec("P-0001"))
    own = JointErrorCourseRow.phase_id == 2
    with database.writing() as db:
        course = {"mean_rad": [math.pi / 2, None, math.pi], "samples": [42, 0, 21]}
        db.execute(update(JointErrorCourseRow).where(own).values(**course))
    rows = _read(database, "joint_error_course")
    rows = rows[rows["phase_id"] == 2]
    assert rows["reference"].tolist() == ["present"] * 3 + ["command"] * 3
    assert rows["begin_active_s"].tolist() == [0.0, 5.0, 10.0] * 2
    assert rows["end_active_s"].tolist() == [5.0, 10.0, 15.0] * 2
    assert rows["mean_deg"].fillna(-1.0).tolist() == pytest.approx([90.0, -1.0, 180.0] * 2)
    assert rows["samples"].tolist() == [42, 0, 21] * 2
    assert set(rows["participant_code"]) == {"P-0001"}


@pytest.mark.one_engine
def test_joint_errors_have_their_clipped_share(database: Database) -> None:
    """Joint errors have their stored clipped share, or an empty cell if none is stored."""
    _build(database, SessionSpec("P-0001"))
    assert _read(database, "joint_errors")["clipped_share"].isna().all()
    head = (JointErrorRow.joint == "Head") & (JointErrorRow.axis == "x")
    with database.writing() as db:
        db.execute(update(JointErrorRow).where(head).values(clipped_share=0.25))
    rows = _read(database, "joint_errors")
    existing = rows["clipped_share"].notna()
    assert existing.equals(rows["joint"].eq("Head") & rows["axis"].eq("x"))
    assert set(rows["clipped_share"][existing]) == {0.25}


def test_answers_are_as_given_and_scores_follow_from_them(database: Database) -> None:
    """The raw answers of Karas 2020, table 7.2 (hand, 0 ms), give the scores 8, 7, 4 and 1.04."""
    raw = [2, 1, 1, 5, 1, 7, 7, 2, 1, 6, 1, 3, 4, 4]
    existing = {f"q{number}": answer for number, answer in enumerate(raw, start=1)}
    _build(database, SessionSpec("P-0001", likert=lambda _, item: existing.get(item, 3)))
    answers = _read(database, "answers")
    first = answers[(answers["block"] == 1) & (answers["limb"] == "hand")]
    assert dict(zip(first["item"], first["value_number"], strict=True))["q4"] == 5.0
    assert sorted(first["shown_position"]) == list(range(1, 16))
    scores = _read(database, "scores")
    scores = scores[(scores["block"] == 1) & (scores["limb"] == "hand")]
    values = dict(zip(scores["score"], scores["value"], strict=True))
    assert (values["ownership"], values["agency"], values["location"]) == (8.0, 7.0, 4.0)
    assert values["soe_thesis"] == pytest.approx(1.0407, abs=5e-5)


@pytest.mark.one_engine
def test_heights_are_those_stated_and_matched(database: Database) -> None:
    """The table of sessions has the stated and the matched height."""
    _build(database, SessionSpec("P-0001"))
    row = _read(database, "sessions").iloc[0]
    assert (row["height_stated_m"], row["height_matched_m"]) == (1.75, 1.73)


@pytest.mark.one_engine
def test_an_unknown_study_and_an_unknown_kind_are_refused(database: Database) -> None:
    """An unknown study or kind is refused with an error that lists the valid ones."""
    with database.reading() as db:
        with pytest.raises(NotFound) as unknown:
            tables.phases_table(db, "nothing", "people")
        assert unknown.value.valid == [STUDY]
        with pytest.raises(ValueError, match="valid are people, simulated, test, all"):
            tables.phases_table(db, STUDY, "robots")  # type: ignore[arg-type]  # the fact


@pytest.mark.one_engine
def test_what_is_shared_is_read_once_for_everything_within(database: Database) -> None:
    """Tables and the wide table of one export are joined with the same contexts, read once."""
    shared: tables.Contexts = {}
    with database.writing() as db:
        build_session(db, SessionSpec("P-0001"))
    with database.reading() as db, tables.shared_contexts(shared):
        wide_table(db, STUDY, "people")
        read = dict(shared)
        tables.sessions_table(db, STUDY, "people")
    assert ("sessions_context", STUDY, "people") in read
    assert all(shared[name] is frame for name, frame in read.items())
