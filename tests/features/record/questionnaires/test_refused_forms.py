"""Tests that invalid forms are refused by item, and that nothing of them is stored."""

import pytest
from fastapi.testclient import TestClient

from tests.features.lab import Json, Lab, error
from tests.features.record.questionnaires.forms import ANSWERS, FORM, due, filled, rows, send

pytestmark = pytest.mark.one_engine


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
    """An invalid answer is refused with its item named, and nothing is stored."""
    answer = send(tablet, filled(due(tablet), {**ANSWERS, item: value}))
    refusal = error(answer, 422, "invalid_input")
    named = [problem.get("item") or problem["path"] for problem in refusal["details"]]
    assert all(item in name for name in named)
    assert rows(lab, session_id) == (0, 0, 0)
    assert due(tablet)["key"] == f"{FORM}#1"


def test_an_answer_off_the_scale_is_refused_with_the_range(tablet: TestClient) -> None:
    """An answer of 8 on a scale of 1 to 7 is refused with the range of the scale."""
    refusal = error(send(tablet, filled(due(tablet), {**ANSWERS, "q3": 8})), 422, "invalid_input")
    (problem,) = refusal["details"]
    assert (problem["item"], problem["value"]) == ("q3", 8)
    assert "1" in problem["valid"]
    assert "7" in problem["valid"]


@pytest.mark.parametrize("number", ["NaN", "Infinity", "1e999"])
def test_a_non_finite_answer_is_refused(
    lab: Lab, session_id: str, tablet: TestClient, number: str
) -> None:
    """An answer of NaN or infinity is refused, and nothing is stored."""
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
        {"timings": {"q1": -5.0}},
        {"started_at_utc": "0001-01-01T00:00:00+14:00"},
        {"started_at_utc": "9999-12-31T23:59:59-14:00"},
        {"shown_order": ["q1"]},
        {"shown_order": ["q1"] * 15},
        {"language": "xx"},
        {"idempotency_key": "short"},
        {"administration": "block1.foot.karas2020#1"},
    ],
)
def test_the_fields_around_the_answers_are_checked(
    lab: Lab, session_id: str, tablet: TestClient, fields: Json
) -> None:
    """A form with an invalid seed, time, order, language or key, or one not due, is refused."""
    import json

    text = json.dumps({**filled(due(tablet)), **fields})
    headers = {"content-type": "application/json"}
    answer = tablet.post("/api/tablet/submissions", content=text, headers=headers)
    assert answer.status_code == (409 if "administration" in fields else 422), answer.text
    assert rows(lab, session_id) == (0, 0, 0)
