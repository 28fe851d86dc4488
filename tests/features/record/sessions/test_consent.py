"""Tests of consent: what it needs, what is stored and shown, and what is never exported."""

from pathlib import Path

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select

from app.features.record.sessions.contents import salted_hash
from app.features.results.exports.writing import export_study
from app.models import SessionContent
from tests.features.lab import Json, Lab, error, ok
from tests.features.record.sessions.options_lab import joined
from tests.protocol.options import KEY

PATH = "M10.5 20L100 30.5L200 25M300 100L320 140"
GIVEN: Json = {"step_index": 0, "ticked": [0, 1], "signature": PATH}


@pytest.fixture
def view(lab: Lab) -> Json:
    """Return a session whose current step is the consent."""
    return lab.command(joined(lab), "start")


@pytest.fixture
def tablet(lab: Lab, view: Json) -> TestClient:
    """Return the client of the session's tablet."""
    return lab.tablet(view["id"])


def record(lab: Lab, view: Json) -> Json:
    """Return the consent record as the printable page reads it."""
    reply: Json = ok(lab.operator.get(f"/api/sessions/{view['id']}/consent"))
    return reply


@pytest.mark.one_engine
def test_the_tablet_receives_the_consents_statements(tablet: TestClient) -> None:
    """The tablet receives the consent's statements in its language and the kind of signature."""
    state = ok(tablet.get("/api/tablet/state"))
    assert state["screen"] == "consent"
    assert state["consent"]["signature"] == "drawn"
    assert [one["optional"] for one in state["consent"]["statements"]] == [False, False, True]
    german = ok(tablet.put("/api/tablet/language", json={"language": "de"}))
    assert german["consent"]["statements"][0]["text"] == "Ich habe die Seite oben gelesen."


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"ticked": [0]}, "not ticked"),
        ({"ticked": []}, "not ticked"),
        ({"ticked": [0, 1, 7]}, "no such statement"),
        ({"signature": None}, "signature is missing"),
        ({"signature": None, "name": "  "}, None),
        ({"signature": "M0 0L10 10<script>"}, None),
        ({"signature": "M0 0L" + "1" * 60_000}, None),
        ({"surprise": 1}, None),
    ],
)
def test_an_incomplete_consent_is_refused(
    lab: Lab, view: Json, tablet: TestClient, change: Json, expected: str | None
) -> None:
    """An incomplete or invalid consent is refused, and nothing is stored."""
    answer = tablet.post("/api/tablet/consent", json={**GIVEN, **change})
    assert answer.status_code == 422
    if expected is not None:
        assert expected in error(answer, 422, "invalid_input")["message"]
    assert record(lab, view) is None
    assert lab.view(view["id"])["version"] == view["version"]


def test_a_consent_is_stored_once_with_its_text_and_version(
    lab: Lab, view: Json, tablet: TestClient
) -> None:
    """A consent is stored once, with study version, text, statements and signature."""
    for _ in range(2):
        assert ok(tablet.post("/api/tablet/consent", json=GIVEN))["screen"] == "form"
    reported = record(lab, view)
    study = ok(lab.operator.get(f"/api/studies/{KEY}"))
    assert (reported["study_version"], reported["content_hash"]) == (1, study["content_hash"])
    assert reported["text"].startswith("Thank you for coming.")
    assert reported["text_matches"] is True
    assert [one["ticked"] for one in reported["statements"]] == [True, True, False]
    assert (reported["signature"], reported["name"], reported["mode"]) == (PATH, None, "tablet")
    assert (reported["records"], reported["erased"], reported["simulated"]) == (1, False, False)
    assert reported["by"].startswith("tablet:")


def test_the_event_log_has_only_the_hash_of_a_consent(
    lab: Lab, view: Json, tablet: TestClient
) -> None:
    """The event log has only the salted hash of a consent, not the name."""
    ok(tablet.post("/api/tablet/consent", json={**GIVEN, "signature": None, "name": "Ada L."}))
    (event,) = [one for one in lab.events(view["id"]) if one["type"] == "step_completed"]
    with lab.database.reading() as db:
        row = db.scalars(
            select(SessionContent).where(
                SessionContent.session_id == view["id"], SessionContent.kind == "consent"
            )
        ).one()
        assert row.salt is not None
        assert row.body is not None
        assert "Ada L." in row.body
        assert event["data"]["content_id"] == row.id
        assert event["data"]["content_hash"] == salted_hash(row.salt, row.body)
    assert "Ada" not in str(lab.events(view["id"]))


@pytest.mark.one_engine
def test_a_typed_name_replaces_a_drawn_signature(lab: Lab, view: Json, tablet: TestClient) -> None:
    """A typed name is accepted instead of a drawn signature, and stored with the language."""
    ok(tablet.put("/api/tablet/language", json={"language": "de"}))
    ok(tablet.post("/api/tablet/consent", json={**GIVEN, "signature": None, "name": " Ada L. "}))
    reported = record(lab, view)
    assert (reported["name"], reported["signature"], reported["language"]) == ("Ada L.", None, "de")
    assert reported["text"].startswith("Danke, dass Sie")


@pytest.mark.one_engine
def test_a_required_signature_cannot_be_bypassed(lab: Lab, view: Json, tablet: TestClient) -> None:
    """Neither the tablet's acknowledgement nor the operator can bypass a required signature."""
    answer = tablet.post("/api/tablet/acknowledge", json={"step_index": 0})
    assert "not ticked" in error(answer, 422, "invalid_input")["message"]
    refusal = error(lab.try_command(view, "complete_step", step_index=0), 422, "invalid_input")
    assert "sign on paper" in refusal["remedy"]


@pytest.mark.one_engine
def test_a_consent_on_paper_is_recorded_with_its_place(lab: Lab, view: Json) -> None:
    """A consent on paper is recorded by the operator with the place of the sheet and a reason."""
    sheet = {"place": "Folder A, sheet 12", "reason": "The tablet was empty"}
    error(
        lab.try_command(view, "complete_step", paper_consent={"place": "A"}), 422, "invalid_input"
    )
    after = lab.command(view, "complete_step", step_index=0, paper_consent=sheet)
    assert after["current"]["index"] == 1
    reported = record(lab, after)
    assert (reported["mode"], reported["paper"], reported["by"]) == (
        "paper",
        sheet,
        "account:admin",
    )
    assert {one["ticked"] for one in reported["statements"]} == {None}


@pytest.mark.one_engine
def test_a_consent_without_signature_has_a_record(lab: Lab) -> None:
    """A consent that needs no signature also has a record."""
    pressed = lab.command(lab.join(), "start")
    ok(lab.tablet(pressed["id"]).post("/api/tablet/acknowledge", json={"step_index": 0}))
    assert record(lab, pressed)["mode"] == "tablet"


@pytest.mark.one_engine
@pytest.mark.parametrize(
    "sheet", [None, {"place": "  ", "reason": "no tablet"}, {"place": "Folder A", "reason": " "}]
)
def test_an_operator_cannot_consent_for_the_participant(lab: Lab, sheet: Json | None) -> None:
    """An operator cannot complete a consent without a sheet of paper, its place and a reason."""
    view = lab.command(lab.join(), "start")
    refusal = error(
        lab.try_command(view, "complete_step", step_index=0, paper_consent=sheet),
        422,
        "invalid_input",
    )
    assert sheet is not None or "sign on paper" in refusal["remedy"]
    assert record(lab, view) is None
    assert lab.view(view["id"])["version"] == view["version"]


def test_an_erased_consent_has_no_signature(lab: Lab, view: Json, tablet: TestClient) -> None:
    """The record of an erased consent has neither name nor signature."""
    ok(tablet.post("/api/tablet/consent", json=GIVEN))
    with lab.database.writing() as db:
        query = select(SessionContent).where(SessionContent.session_id == view["id"])
        for row in db.scalars(query):
            row.body = row.salt = None
    reported = record(lab, view)
    assert (reported["erased"], reported["signature"], reported["name"]) == (True, None, None)


@pytest.mark.one_engine
def test_an_export_has_no_name_and_no_signature(
    lab: Lab, view: Json, tablet: TestClient, tmp_path: Path
) -> None:
    """An export states that and when consent was given, without name or signature."""
    given = {**GIVEN, "signature": None, "name": "Ada Unmistakable"}
    ok(tablet.post("/api/tablet/consent", json=given))
    with lab.database.reading() as db:
        export_study(db, KEY, "people", tmp_path / "out", now=lab.context.clock.utc_now())
    files = [path for path in (tmp_path / "out").rglob("*") if path.is_file()]
    assert files
    assert [path.name for path in files if "Unmistakable" in path.read_text("utf-8")] == []
    lines = (tmp_path / "out" / "sessions.csv").read_text("utf-8").splitlines()
    column = lines[0].split(",").index("consent_given")
    own = next(line for line in lines if view["id"] in line).split(",")
    assert own[column] == "true"
    assert own[column + 1].startswith("20")
