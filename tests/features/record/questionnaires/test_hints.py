"""Tests of the hints for operators on how a form was filled in."""

import json
from typing import Any

import pytest
from fastapi.testclient import TestClient
from pandas import isna

from app.features.design.instruments import instrument_of, newest_instruments
from app.features.record.questionnaires.hints import hints_of
from app.features.results.analysis.tables import answers_table
from app.models import Submission
from app.science.instruments import Instrument
from tests.features.lab import STUDY, Json, Lab, ok
from tests.features.record.questionnaires.forms import ANSWERS, due, enter, filled, send

RATED = [f"q{number}" for number in range(1, 15)]
ALL_FOUR: Json = {**dict.fromkeys(RATED, 4), "problems": None}


def traces(*times_s: float) -> Json:
    """Return traces of the rated items in order, with these response times and no changes."""
    return {
        item: {"response_s": time_s, "changes": 0}
        for item, time_s in zip(RATED, times_s, strict=False)
    }


def hints(lab: Lab, session_id: str) -> list[Json]:
    """Return the hints that the cockpit shows below the scores of the first form."""
    view = lab.view(session_id)
    found: list[Json] = view["scores"][0]["hints"]
    return [{name: value for name, value in one.items() if value is not None} for one in found]


def test_an_ordinary_form_has_no_hint(lab: Lab, session_id: str, tablet: TestClient) -> None:
    """A form with ordinary answers and response times has no hint."""
    answers = {**ANSWERS, "problems": None}
    ok(send(tablet, filled(due(tablet), answers, item_traces=traces(*[3.0] * 14))))
    assert hints(lab, session_id) == []


@pytest.mark.one_engine
def test_identical_answers_give_a_hint_to_the_operator_only(
    lab: Lab, session_id: str, tablet: TestClient
) -> None:
    """Identical answers throughout give the operator a hint; the tablet shows nothing of it."""
    receipt = ok(send(tablet, filled(due(tablet), ALL_FOUR)))
    assert hints(lab, session_id) == [{"kind": "alike", "items": 14, "value": 4.0}]
    assert lab.view(session_id)["scores"][0]["scores"]["ownership"] is not None
    reply = json.dumps([receipt, ok(tablet.get("/api/tablet/state"))])
    assert "hint" not in reply
    assert "alike" not in reply


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("times_s", "kinds"),
    [
        ([0.9] * 14, ["fast"]),
        ([0.9] * 8 + [30.0] * 6, ["fast"]),
        ([1.0] * 14, []),
        ([0.2] * 4, []),
    ],
)
def test_half_of_the_ratings_below_a_second_are_implausibly_fast(
    lab: Lab, session_id: str, tablet: TestClient, times_s: list[float], kinds: list[str]
) -> None:
    """A form of five or more ratings with a median response time below 1 s gets the hint `fast`."""
    ok(send(tablet, filled(due(tablet), item_traces=traces(*times_s))))
    assert hints(lab, session_id) == [{"kind": kind, "items": 14, "seconds": 1.0} for kind in kinds]


@pytest.mark.one_engine
def test_an_operators_entry_is_never_fast_but_may_be_incomplete(lab: Lab, session_id: str) -> None:
    """A form entered by the operator is never called fast; ratings left out are counted."""
    ok(enter(lab, session_id, {**ANSWERS, "q3": None, "q9": None, "problems": None}))
    assert hints(lab, session_id) == [{"kind": "left_out", "items": 2}]


def hints_on(instrument: Instrument, value: float) -> list[str]:
    """Return the kinds of hints on a form with the same rating throughout."""
    submission = Submission(mode="tablet", item_traces=None)
    answers: dict[str, Any] = {
        item.key: value if item.type == "likert" else "" for item in instrument.items
    }
    return [hint.kind for hint in hints_of(instrument, submission, answers)]


@pytest.mark.one_engine
def test_no_symptoms_at_all_gives_no_hint(lab: Lab) -> None:
    """The lowest rating throughout gives a hint on Karas 2020, but not on a list of symptoms."""
    with lab.database.reading() as db:
        existing = {key: instrument_of(row) for key, row in newest_instruments(db).items()}
    assert hints_on(existing["ssq"], 0.0) == []
    assert hints_on(existing["ssq"], 3.0) == ["alike"]
    assert hints_on(existing["karas2020"], 1.0) == ["alike"]


def test_times_and_changes_are_exported_by_item(
    lab: Lab, session_id: str, tablet: TestClient
) -> None:
    """Response times and changes are exported per item, and empty where none were sent."""
    body = filled(
        due(tablet),
        timings={"q1": 4.5, "q2": 9.0},
        item_traces={"q1": {"response_s": 2.25, "changes": 3}},
    )
    ok(send(tablet, body))
    with lab.database.reading() as db:
        frame = answers_table(db, STUDY, "people")
    rows = frame[frame["session_id"] == session_id].to_dict("records")
    names = ("response_s", "changes", "answered_after_s")
    reported = {row["item"]: [row[name] for name in names] for row in rows}
    assert reported["q1"] == [2.25, 3, 4.5]
    assert [isna(value) for value in reported["q2"]] == [True, True, False]
