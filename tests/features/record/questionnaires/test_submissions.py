"""Tests that forms are stored once and scored by their instrument."""

import json
from concurrent.futures import ThreadPoolExecutor

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select

from app.features.design.instruments import instrument_of, newest_instruments
from app.features.record.sessions.contents import content_body, contents_of
from app.features.record.sessions.journal import events_of, verify_chain
from app.models import StudySession, Submission
from app.science.instruments import item_order
from tests.features.lab import Lab, error, key, ok
from tests.features.record.questionnaires.forms import (
    ANSWERS,
    FORM,
    due,
    enter,
    filled,
    rows,
    send,
    stored,
)


def test_scores_equal_the_published_ones(lab: Lab, session_id: str, tablet: TestClient) -> None:
    """The answers of table 7.2 of the thesis give its scores 8, 7, 4 and 1.04 (1.0407...)."""
    ok(send(tablet, filled(due(tablet))))
    (form,) = stored(lab, session_id)
    assert {name: form["scores"][name] for name in ("ownership", "agency", "location")} == {
        "ownership": 8.0,
        "agency": 7.0,
        "location": 4.0,
    }
    assert form["scores"]["soe_thesis"] == pytest.approx(1.0407407407407407, abs=1e-15)
    assert lab.view(session_id)["scores"][0]["scores"] == form["scores"]


def test_answers_are_stored_as_given(lab: Lab, session_id: str, tablet: TestClient) -> None:
    """A form is stored with its raw answers, the order shown, its seed and its mode."""
    administration = due(tablet)
    ok(send(tablet, filled(administration)))
    (form,) = stored(lab, session_id)
    assert form["answers"] == ANSWERS
    assert form["shown_order"] == administration["item_order"]
    assert (form["mode"], form["administration"]) == ("tablet", f"{FORM}#1")


@pytest.mark.one_engine
def test_submitting_a_form_advances_the_session(
    lab: Lab, session_id: str, tablet: TestClient
) -> None:
    """After a form is submitted the session's next step is current."""
    receipt = ok(send(tablet, filled(due(tablet))))
    assert receipt["duplicate"] is False
    view = lab.view(session_id)
    assert view["steps"][view["current"]["index"]]["key"] == "block1.foot"


@pytest.mark.one_engine
def test_items_are_shown_in_the_order_of_the_seed(lab: Lab, tablet: TestClient) -> None:
    """The order of items follows from the seed of the form, with the open question last."""
    administration = due(tablet)
    with lab.database.reading() as db:
        instrument = instrument_of(newest_instruments(db)["karas2020"])
    assert administration["item_order"] == list(item_order(instrument, administration["seed"]))
    assert administration["item_order"][-1] == "problems"
    assert due(tablet) == administration


def test_sending_twice_stores_once(lab: Lab, session_id: str, tablet: TestClient) -> None:
    """A form that is sent twice is stored once and gets the same receipt."""
    body = filled(due(tablet))
    first, second = (ok(send(tablet, body)) for _ in range(2))
    assert second == {**first, "duplicate": True}
    assert rows(lab, session_id)[0] == 1


def test_fifty_simultaneous_submissions_under_one_key_store_one_row(
    lab: Lab, session_id: str, tablet: TestClient
) -> None:
    """Fifty simultaneous submissions under one key store one form and get the same receipt."""
    body = filled(due(tablet))
    with ThreadPoolExecutor(50) as pool:
        receipts = [ok(answer) for answer in pool.map(lambda _: send(tablet, body), range(50))]
    assert len({receipt["receipt_id"] for receipt in receipts}) == 1
    assert [receipt["duplicate"] for receipt in receipts].count(False) == 1
    assert rows(lab, session_id) == (1, 15, 5)


@pytest.mark.parametrize("new_key", [False, True])
def test_other_answers_to_a_stored_form_are_refused(
    lab: Lab,
    session_id: str,
    tablet: TestClient,
    new_key: bool,  # noqa: FBT001 - pytest passes it by name
) -> None:
    """Other answers to a stored form are refused; the first are kept and both are recorded."""
    body = filled(due(tablet))
    ok(send(tablet, body))
    other = {**body, "answers": {**ANSWERS, "q1": 7}}
    if new_key:
        other["idempotency_key"] = key()
    for _ in range(3):
        error(send(tablet, other), 409, "conflict")
    assert stored(lab, session_id)[0]["answers"]["q1"] == 2
    (event,) = [one for one in lab.events(session_id) if one["type"] == "form_refused"]
    with lab.database.reading() as db:
        (kept,) = contents_of(db, session_id, "refused_form")
        refused = content_body(kept)
        session = db.get_one(StudySession, session_id)
        assert verify_chain(events_of(db, session_id), version=session.version).ok
    assert isinstance(refused, dict)
    assert refused["answers"]["q1"] == 7
    assert kept.id == event["data"]["content_id"]


@pytest.mark.one_engine
def test_the_operator_may_leave_answers_out(lab: Lab, session_id: str) -> None:
    """The operator may leave answers out; only the scores that need them are null."""
    spoken = {item: value for item, value in ANSWERS.items() if item != "q3"}
    ok(enter(lab, session_id, spoken))
    (form,) = stored(lab, session_id)
    assert form["answers"]["q3"] is None
    assert form["scores"] == {
        "ownership": None,
        "agency": 7.0,
        "location": 4.0,
        "soe_thesis": None,
        "soe_rescaled": None,
    }


@pytest.mark.one_engine
def test_the_operators_entry_is_marked(lab: Lab, session_id: str) -> None:
    """A form entered by the operator is stored with its mode and the account."""
    ok(enter(lab, session_id, ANSWERS))
    assert stored(lab, session_id)[0]["mode"] == "operator"
    with lab.database.reading() as db:
        row = db.scalars(select(Submission).where(Submission.session_id == session_id)).one()
    assert row.entered_by == "account:admin"


@pytest.mark.one_engine
def test_the_operator_cannot_enter_an_invalid_answer(lab: Lab, session_id: str) -> None:
    """An answer off the scale is refused from the operator as well."""
    error(enter(lab, session_id, {**ANSWERS, "q1": 8}), 422, "invalid_input")


def test_a_repeated_form_step_stores_a_second_form(
    lab: Lab, session_id: str, tablet: TestClient
) -> None:
    """Repeating a form's step stores a second form, with its own order of items."""
    first = due(tablet)
    ok(send(tablet, filled(first)))
    view = lab.view(session_id)
    step = next(step["index"] for step in view["steps"] if step["key"] == FORM)
    lab.command(view, "redo", reason="misread", step_index=step)
    second = due(tablet)
    assert (second["key"], second["seed"] != first["seed"]) == (f"{FORM}#2", True)
    ok(send(tablet, filled(second, {**ANSWERS, "q1": 5})))
    assert [form["answers"]["q1"] for form in stored(lab, session_id)] == [2, 5]


@pytest.mark.one_engine
def test_a_late_copy_of_a_stored_form_still_gets_its_receipt(
    lab: Lab, session_id: str, tablet: TestClient
) -> None:
    """A form resent after the session's end gets its first receipt, with the present screen."""
    body = filled(due(tablet))
    first = ok(send(tablet, body))
    lab.command(lab.view(session_id), "abort", reason="fire alarm")
    screen = ok(tablet.get("/api/tablet/state"))
    assert screen["screen"] == "finished"
    assert ok(send(tablet, body)) == {**first, "duplicate": True, "state": screen}


def test_the_answer_to_a_form_has_the_next_screen(session_id: str, tablet: TestClient) -> None:
    """The answer to a stored form has the screen that the tablet would get by asking."""
    stored_form = ok(send(tablet, filled(due(tablet))))
    assert stored_form["state"] == ok(tablet.get("/api/tablet/state"))


@pytest.mark.one_engine
def test_a_form_that_is_sent_in_another_way_is_stored_alike(
    session_id: str, tablet: TestClient
) -> None:
    """A content type in an unusual spelling, which the direct route leaves alone, is accepted."""
    headers = {"content-type": "application/json; charset=UTF-8"}
    text = json.dumps(filled(due(tablet)))
    first = ok(tablet.post("/api/tablet/submissions", content=text, headers=headers))
    again = ok(tablet.post("/api/tablet/submissions", json=json.loads(text)))
    assert again == {**first, "duplicate": True}
