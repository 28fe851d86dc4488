"""Forms: stored once, scored by their instrument, refused with every problem named."""

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from fastapi.testclient import TestClient
from httpx2 import Response
from sqlalchemy import func, select

from app.features.studies.service import instrument_of, newest_instruments
from app.models import Answer, ScoreValue, Submission
from app.science.instruments import item_order
from tests.features.lab import Json, Lab, error, key, ok

FORM = "block1.hand.karas2020"
# Karas 2020, Table 7.2: hand phase at 0 ms, as given on the 1-7 scale.
RAW = dict(zip([f"q{n}" for n in range(1, 13)], [2, 1, 1, 5, 1, 7, 7, 2, 1, 6, 1, 3], strict=True))
ANSWERS: Json = {**RAW, "q13": 4, "q14": 6, "problems": "Nothing at all."}


@pytest.fixture
def session_id(lab: Lab) -> str:
    """A session whose first embodiment questionnaire is due."""
    return str(lab.skip_to(lab.join(), FORM)["id"])


@pytest.fixture
def tablet(lab: Lab, session_id: str) -> TestClient:
    """Its tablet."""
    return lab.tablet(session_id)


def due(tablet: TestClient) -> Json:
    """The form that the tablet shows."""
    administration: Json = ok(tablet.get("/api/tablet/state"))["administration"]
    return administration


def filled(administration: Json, answers: Json = ANSWERS, **fields: Any) -> Json:
    """The form with answers, under a fresh key."""
    return {
        "idempotency_key": key(),
        "administration": administration["key"],
        "answers": answers,
        "shown_order": administration["item_order"],
        "seed": administration["seed"],
        "language": "en",
        **fields,
    }


def send(tablet: TestClient, body: Json) -> Response:
    """Submit from the tablet."""
    return tablet.post("/api/tablet/submissions", json=body)


def enter(lab: Lab, session_id: str, answers: Json) -> Response:
    """Submit as the operator."""
    administration = ok(lab.operator.get(f"/api/sessions/{session_id}/administration"))
    body = filled(administration, answers)
    return lab.operator.post(f"/api/sessions/{session_id}/submissions", json=body)


def stored(lab: Lab, session_id: str) -> list[Json]:
    """Every stored form."""
    forms: list[Json] = ok(lab.operator.get(f"/api/sessions/{session_id}/answers"))
    return forms


def rows(lab: Lab, session_id: str) -> tuple[int, int, int]:
    """How many submissions, answers and scores are stored."""
    with lab.database.reading() as db:
        ids = select(Submission.id).where(Submission.session_id == session_id)
        counts = [db.scalar(select(func.count()).select_from(ids.subquery()))]
        for table in (Answer, ScoreValue):
            query = select(func.count()).select_from(table).where(table.submission_id.in_(ids))
            counts.append(db.scalar(query))
    return counts[0] or 0, counts[1] or 0, counts[2] or 0


def test_scores_are_the_published_ones(lab: Lab, session_id: str, tablet: TestClient) -> None:
    """Table 7.2 of the thesis: 8, 7, 4 and 1.04 (unrounded 1.0407...)."""
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
    """Raw answers, the order shown, its seed and how they came in."""
    administration = due(tablet)
    ok(send(tablet, filled(administration)))
    (form,) = stored(lab, session_id)
    assert form["answers"] == ANSWERS
    assert form["shown_order"] == administration["item_order"]
    assert (form["mode"], form["administration"]) == ("tablet", f"{FORM}#1")


def test_a_form_moves_the_session_on(lab: Lab, session_id: str, tablet: TestClient) -> None:
    """After the receipt the next step is current."""
    receipt = ok(send(tablet, filled(due(tablet))))
    assert receipt["duplicate"] is False
    view = lab.view(session_id)
    assert view["steps"][view["current"]["index"]]["key"] == "block1.foot"


def test_items_are_shown_in_the_order_of_the_seed(lab: Lab, tablet: TestClient) -> None:
    """The order can be made again from the seed; the open prompt comes last."""
    administration = due(tablet)
    with lab.database.reading() as db:
        instrument = instrument_of(newest_instruments(db)["karas2020"])
    assert administration["item_order"] == list(item_order(instrument, administration["seed"]))
    assert administration["item_order"][-1] == "problems"
    assert due(tablet) == administration


def test_sending_twice_stores_once(lab: Lab, session_id: str, tablet: TestClient) -> None:
    """The second answer is the first receipt."""
    body = filled(due(tablet))
    first, second = (ok(send(tablet, body)) for _ in range(2))
    assert second == {**first, "duplicate": True}
    assert rows(lab, session_id)[0] == 1


def test_fifty_at_once_under_one_key_store_one_row(
    lab: Lab, session_id: str, tablet: TestClient
) -> None:
    """All get the same receipt, and exactly one is not a duplicate."""
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
    new_key: bool,  # noqa: FBT001
) -> None:
    """Under the same key or another one: 409, and the first answers stand."""
    body = filled(due(tablet))
    ok(send(tablet, body))
    other = {**body, "answers": {**ANSWERS, "q1": 7}}
    if new_key:
        other["idempotency_key"] = key()
    error(send(tablet, other), 409, "conflict")
    assert stored(lab, session_id)[0]["answers"]["q1"] == 2


@pytest.mark.parametrize(
    ("item", "value"),
    [
        ("q1", 8),
        ("q1", 0),
        ("q1", 3.5),
        ("q1", True),
        ("q1", "3"),
        pytest.param("q1", 10**400, id="huge"),
        ("q1", None),
        ("problems", "x" * 20_000),
        ("problems", "a\x00b"),
        ("q99", 3),
    ],
)
def test_an_impossible_answer_is_refused_by_item(
    lab: Lab, session_id: str, tablet: TestClient, item: str, value: object
) -> None:
    """The refusal names the item, and nothing is stored."""
    answer = send(tablet, filled(due(tablet), {**ANSWERS, item: value}))
    refusal = error(answer, 422, "invalid_input")
    named = [problem.get("item") or problem["path"] for problem in refusal["details"]]
    assert all(item in name for name in named)
    assert rows(lab, session_id) == (0, 0, 0)
    assert due(tablet)["key"] == f"{FORM}#1"


def test_an_answer_off_the_scale_is_told_the_range(tablet: TestClient) -> None:
    """8 on a scale of 1 to 7."""
    refusal = error(send(tablet, filled(due(tablet), {**ANSWERS, "q3": 8})), 422, "invalid_input")
    (problem,) = refusal["details"]
    assert (problem["item"], problem["value"]) == ("q3", 8)
    assert "1" in problem["valid"]
    assert "7" in problem["valid"]


@pytest.mark.parametrize("number", ["NaN", "Infinity", "1e999"])
def test_a_number_that_is_none_is_refused(
    lab: Lab, session_id: str, tablet: TestClient, number: str
) -> None:
    """Not even in JSON that only some programs write."""
    import json

    text = json.dumps(filled(due(tablet))).replace('"q1": 2', f'"q1": {number}')
    headers = {"content-type": "application/json"}
    answer = tablet.post("/api/tablet/submissions", content=text, headers=headers)
    assert answer.status_code == 422
    assert rows(lab, session_id) == (0, 0, 0)


@pytest.mark.parametrize(
    "fields",
    [
        {"seed": 2**70},
        {"seed": -1},
        {"started_at_utc": "2026-03-02T09:30:00"},
        {"timings": {"q1": float("nan")}},
        {"shown_order": ["q1"]},
        {"shown_order": ["q1"] * 15},
        {"language": "xx"},
        {"idempotency_key": "short"},
        {"administration": "block1.foot.karas2020#1"},
    ],
)
def test_what_surrounds_the_answers_is_checked_too(
    lab: Lab, session_id: str, tablet: TestClient, fields: Json
) -> None:
    """Seed, time, order and language must be usable and the form the one that is due."""
    import json

    text = json.dumps({**filled(due(tablet)), **fields})
    headers = {"content-type": "application/json"}
    answer = tablet.post("/api/tablet/submissions", content=text, headers=headers)
    assert answer.status_code == (409 if "administration" in fields else 422), answer.text
    assert rows(lab, session_id) == (0, 0, 0)


def test_the_operator_may_leave_answers_out(lab: Lab, session_id: str) -> None:
    """Without Q3 ownership and what builds on it are null; agency and location are not."""
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


def test_the_operators_entry_is_told_apart(lab: Lab, session_id: str) -> None:
    """Mode and account are stored with the answers."""
    ok(enter(lab, session_id, ANSWERS))
    assert stored(lab, session_id)[0]["mode"] == "operator"
    with lab.database.reading() as db:
        row = db.scalars(select(Submission).where(Submission.session_id == session_id)).one()
    assert row.entered_by == "account:admin"


def test_the_operator_cannot_enter_the_impossible(lab: Lab, session_id: str) -> None:
    """An 8 is refused from the console too."""
    error(enter(lab, session_id, {**ANSWERS, "q1": 8}), 422, "invalid_input")


def test_a_reopened_form_is_answered_anew(lab: Lab, session_id: str, tablet: TestClient) -> None:
    """Doing the step over makes a second administration with an order of its own."""
    first = due(tablet)
    ok(send(tablet, filled(first)))
    view = lab.view(session_id)
    step = next(step["index"] for step in view["steps"] if step["key"] == FORM)
    lab.command(view, "redo", reason="misread", step_index=step)
    second = due(tablet)
    assert (second["key"], second["seed"] != first["seed"]) == (f"{FORM}#2", True)
    ok(send(tablet, filled(second, {**ANSWERS, "q1": 5})))
    assert [form["answers"]["q1"] for form in stored(lab, session_id)] == [2, 5]


def test_a_late_copy_of_a_stored_form_still_gets_its_receipt(
    lab: Lab, session_id: str, tablet: TestClient
) -> None:
    """A tablet that was offline hears that its answers are safe, even after the end."""
    body = filled(due(tablet))
    first = ok(send(tablet, body))
    lab.command(lab.view(session_id), "abort", reason="fire alarm")
    assert ok(send(tablet, body)) == {**first, "duplicate": True}
