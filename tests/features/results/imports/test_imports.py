"""Tests of imported answers: published and survey files, cells that do not fit, and undoing."""

import io
import json
import uuid
import zipfile
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import func, select

from app.models import AuditEntry, ImportedForm, SlotAttempt, StudySession
from tests.features.lab import STUDY, Json, Lab, error, ok

URL = f"/api/studies/{STUDY}/imports"


def look(lab: Lab, text: str, **fields: Any) -> Json:
    """Return the properties that the server recognises in a file."""
    view: Json = ok(lab.operator.post(f"{URL}/look", json={"text": text, **fields}))
    return view


def check(lab: Lab, text: str, mapping: Json) -> Json:
    """Return the effects that an import would have, without storing anything."""
    body = {"text": text, "mapping": mapping}
    view: Json = ok(lab.operator.post(f"{URL}/check", json=body))
    return view


def import_answers(lab: Lab, text: str, mapping: Json) -> Any:
    """Request the import of a file."""
    body = {"text": text, "mapping": mapping, "file_name": "answers.csv"}
    return lab.operator.post(URL, json=body)


def tidy(rows: list[str]) -> str:
    """Return a small tidy file of one-item forms with a unique content."""
    return "\n".join(["pid,condition,fms", *rows]) + f"\n{uuid.uuid4().hex[:8]},other,3\n"


def stored_forms(lab: Lab, import_id: str) -> int:
    """Return how many forms of an import are stored."""
    with lab.database.reading() as db:
        query = select(func.count()).where(ImportedForm.import_id == import_id)
        return db.scalar(query) or 0


def test_published_scores_are_reproduced(lab: Lab, shared_data: Path) -> None:
    """An imported table of TLX answers reproduces the published means and Friedman's test."""
    text = (shared_data / "questionnaires" / "tlxscores.csv").read_text(encoding="utf-8")
    text += f"{uuid.uuid4().hex[:6]},Office,1,,,,,,,\n"  # abandoned row; makes the file unique
    seen = look(lab, text)
    assert (seen["instrument"], seen["separator"], seen["rows"]) == ("raw_tlx", ",", 65)
    mapping = seen["proposal"]
    assert (mapping["participant"], mapping["condition"]) == ("PPID", "Response")
    assert len(mapping["sets"][0]["items"]) == 6
    dry = check(lab, text, mapping)
    assert dry["n_problems"] > 0
    assert (dry["shift"]["multiply"], dry["shift"]["add"]) == (5.0, -5.0)
    mapping |= {"multiply": 5.0, "add": -5.0}
    dry = check(lab, text, mapping)
    reported = (dry["n_problems"], dry["forms"], dry["participants"], dry["skipped_rows"])
    assert reported == (0, 64, 16, 1)
    made = ok(import_answers(lab, text, mapping))
    assert (made["forms"], made["participants"]) == (64, 16)
    (result,) = [
        one
        for one in ok(lab.operator.get(f"{URL}/{made['id']}"))["results"]
        if len(one["means"]) == 4
    ][-1:]
    means = {one["condition"]: one["mean"] for one in result["means"]}
    published = {"Object": 22.8125, "Cube": 25.15625, "Stick": 16.97917, "Laser": 18.48958}
    assert means == pytest.approx(published, abs=5e-6)
    assert result["test"].startswith("Friedman, asymptotic: χ²(3) = 12.06, p = .007")


@pytest.mark.one_engine
def test_a_wide_survey_file_is_imported(lab: Lab) -> None:
    """A survey file with three header rows, semicolons and columns per condition is imported."""
    names = [f"fms_{ms}" for ms in (0, 125)]
    head = ";".join(["ResponseId", "RecordedDate", *names])
    labels = ";".join(["Response ID", "Recorded Date", *["How sick?"] * len(names)])
    ids = ";".join(f'"{{""ImportId"":""{one}""}}"' for one in ["r", "d", *names])
    code = uuid.uuid4().hex[:8]
    text = f"{head}\n{labels}\n{ids}\n{code};2026-03-01 10:00:00;Not at all;7\n"
    seen = look(lab, text, instrument="fms")
    assert (seen["header_rows"], seen["separator"], seen["rows"]) == (3, ";", 1)
    mapping = seen["proposal"]
    assert [one["condition"] for one in mapping["sets"]] == ["0", "125"]
    assert set(mapping["conditions"]) == {"0", "125"}
    dry = check(lab, text, mapping)
    assert (dry["unknown_words"], dry["problems"][0]["line"]) == (["Not at all"], 4)
    mapping["words"] = {"not at all": 0}
    dry = check(lab, text, mapping)
    assert dry["n_problems"] == 0
    assert [one["in_study"] for one in dry["conditions"]] == [True, True]
    assert [next(iter(one["answers"].values())) for one in dry["first_forms"]] == [0.0, 7.0]
    assert dry["first_forms"][0]["answered_on"] == "2026-03-01"
    made = ok(import_answers(lab, text, mapping))
    table = lab.operator.get(f"{URL}/{made['id']}/table").text.splitlines()
    assert [line.split(",")[7] for line in table] == ["answered_on", "2026-03-01", "2026-03-01"]


@pytest.mark.one_engine
def test_a_code_that_turns_writing_around_is_a_problem(lab: Lab) -> None:
    """A participant's code with U+202E is reported with its position."""
    text = tidy(["P\u202e1,x,3", "P2,x,3"])
    dry = check(lab, text, look(lab, text, instrument="fms")["proposal"])
    (problem,) = dry["problems"]
    assert (problem["line"], problem["column"]) == (2, "pid")
    assert "Character 2 is U+202E" in problem["message"]


@pytest.mark.one_engine
def test_every_invalid_cell_is_reported_and_nothing_is_imported(lab: Lab) -> None:
    """Every invalid cell of a file is reported, and such a file is not imported at all."""
    text = tidy(["a@b.org,x,3", "P1,x,3", "P1,x,4", "P2,x,21", ",x,2", "P3,x,"])
    mapping = look(lab, text, instrument="fms")["proposal"]
    dry = check(lab, text, mapping)
    lines = sorted((one["line"], one["column"]) for one in dry["problems"])
    assert lines == [(2, "pid"), (4, "pid"), (5, "fms"), (6, "pid")]
    assert all(one["remedy"] for one in dry["problems"])
    with lab.database.reading() as db:
        before = db.scalar(select(func.count()).select_from(ImportedForm))
    refused = error(import_answers(lab, text, mapping), 422, "invalid_input")
    assert len(refused["details"]) == 4
    with lab.database.reading() as db:
        assert db.scalar(select(func.count()).select_from(ImportedForm)) == before


def test_the_same_file_is_refused_until_it_is_undone(lab: Lab) -> None:
    """A file cannot be imported a second time until its import is undone with a reason."""
    text = tidy(["P1,x,3", "P1,y,4"])
    mapping = look(lab, text, instrument="fms")["proposal"]
    first = ok(import_answers(lab, text, mapping))
    repeated = error(import_answers(lab, text, mapping), 409, "conflict")
    assert repeated["details"][0]["import_id"] == first["id"]
    assert look(lab, text, instrument="fms")["same_file"]["id"] == first["id"]
    undone = ok(lab.operator.post(f"{URL}/{first['id']}/undo", json={"reason": "wrong scale"}))
    assert (undone["forms"], undone["undone_reason"]) == (0, "wrong scale")
    assert stored_forms(lab, first["id"]) == 0
    error(lab.operator.post(f"{URL}/{first['id']}/undo", json={"reason": "again"}), 409, "conflict")
    assert look(lab, text, instrument="fms")["remembered"]
    assert ok(import_answers(lab, text, mapping))["forms"] == 3
    with lab.database.reading() as db:
        actions = db.scalars(
            select(AuditEntry.action).where(AuditEntry.subject == f"import:{first['id']}")
        ).all()
        trail = " ".join(db.scalars(select(AuditEntry.details)))
    assert actions == ["answer.imported", "answer.import_undone"]
    assert "P1" not in trail


@pytest.mark.one_engine
def test_imported_answers_are_never_sessions(lab: Lab) -> None:
    """Imported answers create no session and use no slot; they are in a separate, marked table."""
    with lab.database.reading() as db:
        before = [
            db.scalar(select(func.count()).select_from(one)) for one in (StudySession, SlotAttempt)
        ]
    text = tidy(["=P9,x,3"])
    mapping = look(lab, text, instrument="fms")["proposal"]
    made = ok(import_answers(lab, text, mapping))
    with lab.database.reading() as db:
        after = [
            db.scalar(select(func.count()).select_from(one)) for one in (StudySession, SlotAttempt)
        ]
    assert after == before
    table = lab.operator.get(f"{URL}/{made['id']}/table").text.splitlines()
    assert table[0].startswith("study_key,origin,import_id")
    assert all(line.split(",")[1] == "imported" for line in table[1:])
    assert ",'=P9," in table[1]


def test_one_participants_imported_answers_can_be_erased(lab: Lab) -> None:
    """A participant's imported answers can be erased, without their code in the audit trail."""
    code = f"gone{uuid.uuid4().hex[:6]}"
    text = tidy([f"{code},x,3", f"{code},y,3"])
    made = ok(import_answers(lab, text, look(lab, text, instrument="fms")["proposal"]))
    body = {"participant_code": code, "confirm": "somebody"}
    error(lab.operator.post(f"{URL}/erase", json=body), 422, "invalid_input")
    assert ok(lab.operator.post(f"{URL}/erase", json=body | {"confirm": code})) == {"forms": 2}
    assert stored_forms(lab, made["id"]) == 1
    with lab.database.reading() as db:
        trail = " ".join(db.scalars(select(AuditEntry.details)))
    assert code not in trail


def test_imported_answers_belong_to_the_participant_of_the_same_code(lab: Lab) -> None:
    """A participant's own copy and erasure include answers imported under the same code."""
    code = f"both{uuid.uuid4().hex[:6]}"
    lab.join(participant_code=code)
    text = tidy([f"{code},x,3"])
    made = ok(import_answers(lab, text, look(lab, text, instrument="fms")["proposal"]))
    people = ok(lab.operator.get(f"/api/studies/{STUDY}/participants"))
    person = next(one["id"] for one in people if one["code"] == code)
    of = f"/api/studies/{STUDY}/participants/{person}"
    with zipfile.ZipFile(io.BytesIO(lab.operator.get(f"{of}/access").content)) as copy:
        reply = json.loads(copy.read("imported.json"))
        assert not any(name.startswith("imported/") for name in copy.namelist())
    assert [one["answers"]["sickness"] for one in reply] == [3.0]
    body = {"confirm": code, "reason_code": "requested"}
    erased = ok(lab.operator.post(f"{of}/erasure", json=body))
    assert erased["removed"]["imported_forms"] == 1
    assert stored_forms(lab, made["id"]) == 1
    with zipfile.ZipFile(
        io.BytesIO(lab.operator.get(f"/api/studies/{STUDY}/export").content)
    ) as archive:
        (own,) = [name for name in archive.namelist() if made["id"] in name]
        assert own.split("/")[-2] == "imported"
        assert code.encode() not in archive.read(own)


@pytest.mark.one_engine
def test_labels_of_the_scale_are_recognised(lab: Lab) -> None:
    """Labels of the scale are recognised as answers, even the label "None"."""
    text = f"pid,n1,n2,n3\n{uuid.uuid4().hex[:6]},None,severe,NA\n"
    items = list(ok(lab.operator.get("/api/instruments/ssq"))["preview"]["instrument"]["items"])
    keys = [one["key"] for one in items[:3]]
    columns = dict(zip(keys, ("n1", "n2", "n3"), strict=True))
    mapping = {"instrument": "ssq", "participant": "pid", "sets": [{"items": columns}]}
    dry = check(lab, text, mapping)
    assert (dry["n_problems"], dry["missing_answers"]) == (0, 1)
    given = dry["first_forms"][0]["answers"]
    assert [given[key] for key in keys] == [0.0, 3.0, None]


@pytest.mark.one_engine
def test_items_reversed_in_the_file_are_detected(lab: Lab) -> None:
    """Items that a file already has reversed are detected and can be reversed back."""
    names = ["pid", *(f"sp{n}" for n in range(1, 6))]
    rows = [[f"T{n}-{uuid.uuid4().hex[:4]}", *[str(n % 7)] * 5] for n in range(10)]
    text = "\n".join(",".join(row) for row in [names, *rows]) + "\n"
    mapping = look(lab, text, instrument="ipq")["proposal"]
    dry = check(lab, text, mapping)
    assert dry["reversed_items"] == ["sp2"]
    assert any("sp2" in note and "reversed" in note for note in dry["notes"])
    dry = check(lab, text, mapping | {"turned": ["sp2"]})
    assert not any("sp2 is reversed" in note for note in dry["notes"])
    answers = [one["answers"]["sp2"] for one in dry["first_forms"]]
    assert answers == [6.0 - n % 7 for n in range(len(answers))]


QUALTRICS = (
    "StartDate,ResponseId,Participant,Cond,Q1_1,Q1_2,Q1_3,Q2,Comment\n"
    "Start Date,Response ID,Who?,Which?,I was calm,I was tense,I was bored,How old?,Anything?\n"
    '"{""ImportId"":""startDate""}","{""ImportId"":""_recordId""}","{""ImportId"":""QID1""}",'
    '"{""ImportId"":""QID2""}","{""ImportId"":""QID3_1""}","{""ImportId"":""QID3_2""}",'
    '"{""ImportId"":""QID3_3""}","{""ImportId"":""QID4""}","{""ImportId"":""QID5""}"\n'
    "2026-03-01,R_1,P1,low,1,5,2,31,nice\n"
    "2026-03-01,R_2,P1,high,2,4,2,31,\n"
    "2026-03-02,R_3,P2,low,1,6,2,28,\n"
    "2026-03-02,R_4,P2,high,3,5,2,28,too long\n"
)
"""A survey of three items that no known instrument asks, as Qualtrics writes it."""


@pytest.mark.one_engine
def test_a_foreign_questionnaire_is_offered_as_an_instrument_of_ones_own(fresh_lab: Lab) -> None:
    """Item columns of no known instrument become an instrument, and the file is imported by it."""
    seen = look(fresh_lab, QUALTRICS)
    offered = seen["offer"]
    assert [(one["key"], one["column"], one["text"]) for one in offered["items"]] == [
        ("q1_1", "Q1_1", "I was calm"),
        ("q1_2", "Q1_2", "I was tense"),
        ("q1_3", "Q1_3", "I was bored"),
    ]
    assert (offered["minimum"], offered["maximum"], offered["seen"]) == (1, 7, "1 to 6")
    left_out = {one["name"]: one["filled"] for one in seen["left_out"]}
    assert left_out["Q2"] == 4
    assert left_out["Comment"] == 2
    assert not {"Q1_1", "Q1_2", "Q1_3"} & set(left_out)
    offered |= {"key": "mood", "title": "Mood", "maximum": 6}
    made = ok(fresh_lab.operator.post(f"{URL}/instrument", json=offered))
    again = look(fresh_lab, QUALTRICS)
    assert (made["instrument"], again["instrument"]) == ("mood", "mood")
    assert again["offer"] is None
    mapping = again["proposal"]
    assert mapping["sets"][0]["items"] == {"q1_1": "Q1_1", "q1_2": "Q1_2", "q1_3": "Q1_3"}
    assert (mapping["participant"], mapping["condition"]) == ("Participant", "Cond")
    dry = check(fresh_lab, QUALTRICS, mapping)
    assert (dry["n_problems"], dry["forms"], dry["left_out"]) == (0, 4, [])
    assert dry["first_forms"][0]["scores"]["mean_of_items"] == pytest.approx(8 / 3)
    stored = ok(fresh_lab.operator.get("/api/instruments/mood"))
    assert stored["preview"]["instrument"]["scale"]["maximum"] == 6


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("edits", "words"),
    [
        ({}, "Scale 1 to 7, guessed from the answers seen (1 to 6)"),
        ({"maximum": 6}, "Scale 1 to 6: its minimum guessed from the answers seen"),
        ({"guessed_minimum": None, "guessed_maximum": None}, "Scale 1 to 7, set by a person."),
    ],
)
def test_a_scale_is_a_guess_until_a_person_sets_or_confirms_it(
    fresh_lab: Lab, edits: Json, words: str
) -> None:
    """The provenance of an offered instrument says which ends of its scale are still guesses."""
    offered = look(fresh_lab, QUALTRICS)["offer"] | {"key": "mood"} | edits
    ok(fresh_lab.operator.post(f"{URL}/instrument", json=offered))
    stored = ok(fresh_lab.operator.get("/api/instruments/mood"))
    assert words in stored["preview"]["instrument"]["provenance"]["verified"]


def test_columns_of_answers_that_are_not_imported_are_counted(lab: Lab) -> None:
    """A check with no problems still names the columns of answers that it leaves out."""
    text = "pid,condition,fms,mood1,mood2\nP1,a,3,1,5\nP1,b,4,2,5\nP2,a,2,1,\nP2,b,5,4,5\n"
    seen = look(lab, text)
    assert seen["instrument"] == "fms"
    assert [one["column"] for one in seen["offer"]["items"]] == ["mood1", "mood2"]
    dry = check(lab, text, seen["proposal"])
    assert dry["n_problems"] == 0
    assert dry["left_out"] == [{"name": "mood1", "filled": 4}, {"name": "mood2", "filled": 3}]
    assert (
        "2 columns that look like answers are not imported (7 answers): mood1, mood2."
        in (dry["notes"])
    )


@pytest.mark.parametrize(
    ("part", "words"),
    [
        ({"key": "fms"}, "not used before"),
        ({"key": "Own Scale"}, "lower-case letters"),
        ({"minimum": 7, "maximum": 1}, "minimum below the maximum"),
    ],
)
def test_an_instrument_that_cannot_be_is_not_made(lab: Lab, part: Json, words: str) -> None:
    """A key that is taken or invalid, or a scale without steps, is refused with what is valid."""
    offered = look(lab, QUALTRICS)["offer"] | part
    refused = error(lab.operator.post(f"{URL}/instrument", json=offered), 422, "invalid_input")
    assert words in str(refused)


def test_answers_in_words_are_offered_with_the_order_of_their_scale(lab: Lab) -> None:
    """Words of a known scale give its steps as labels, in order and for all columns."""
    text = "pid,v1,v2\nP1,Agree,Strongly disagree\nP2,Disagree,Somewhat agree\n"
    offered = look(lab, text)["offer"]
    assert (offered["minimum"], offered["maximum"]) == (1, 7)
    assert offered["labels"][0] == "strongly disagree"
    assert [one["column"] for one in offered["items"]] == ["v1", "v2"]


@pytest.mark.one_engine
def test_a_test_that_can_say_nothing_has_no_p_value(fresh_lab: Lab) -> None:
    """Two conditions that never differ have no W and no p, only the reason."""
    rows = [f"P{at},{name},{at + 1}" for at in range(5) for name in ("a", "b")]
    text = "\n".join(["pid,condition,fms", *rows]) + "\n"
    mapping = look(fresh_lab, text)["proposal"]
    made = ok(import_answers(fresh_lab, text, mapping))
    (result,) = ok(fresh_lab.operator.get(f"{URL}/{made['id']}"))["results"]
    (pair,) = result["pairs"]
    assert (pair["p"], pair["p_holm"], pair["w"], pair["rank_biserial"]) == (None,) * 4
    assert pair["degenerate"] == "all 5 differences are zero"
    assert result["why_not"].startswith("Nobody differs between conditions")


def test_the_columns_that_a_framework_adds_are_no_answers(lab: Lab) -> None:
    """Of a trial table of the Unity Experiment Framework, only the ratings are offered."""
    head = "experiment,session_num,trial_num,block_num,trial_num_in_block,start_time,end_time,ppid"
    rows = [
        f"vr,1,{trial},1,{trial},{trial}.5,{trial + 1}.5,P1,{delay},{trial % 5},{(trial + 2) % 5}"
        for trial, delay in enumerate((0, 125, 350), start=1)
    ]
    text = "\n".join([f"{head},latency,owned,steered", *rows]) + "\n"
    seen = look(lab, text)
    assert [one["column"] for one in seen["offer"]["items"]] == ["owned", "steered"]
    assert (seen["offer"]["minimum"], seen["offer"]["maximum"]) == (0, 4)
    assert {"trial_num", "start_time", "session_num"} <= {one["name"] for one in seen["left_out"]}
