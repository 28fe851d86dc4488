"""Helpers that fill in and submit the embodiment questionnaire."""

from typing import Any

from fastapi.testclient import TestClient
from httpx2 import Response
from sqlalchemy import func, select

from app.models import Answer, ScoreValue, Submission
from tests.features.lab import Json, Lab, key, ok

FORM = "block1.hand.karas2020"
# Karas 2020, Table 7.2: hand phase at 0 ms, as given on the 1-7 scale.
RAW = dict(zip([f"q{n}" for n in range(1, 13)], [2, 1, 1, 5, 1, 7, 7, 2, 1, 6, 1, 3], strict=True))
ANSWERS: Json = {**RAW, "q13": 4, "q14": 6, "problems": "Nothing at all."}


def due(tablet: TestClient) -> Json:
    """Return the form that the tablet shows."""
    administration: Json = ok(tablet.get("/api/tablet/state"))["administration"]
    return administration


def filled(administration: Json, answers: Json = ANSWERS, **fields: Any) -> Json:
    """Return a submission of the form with these answers, under a new idempotency key."""
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
    """Submit a form from the tablet."""
    return tablet.post("/api/tablet/submissions", json=body)


def enter(lab: Lab, session_id: str, answers: Json) -> Response:
    """Submit the form that is due as the operator."""
    administration = ok(lab.operator.get(f"/api/sessions/{session_id}/administration"))
    body = filled(administration, answers)
    return lab.operator.post(f"/api/sessions/{session_id}/submissions", json=body)


def stored(lab: Lab, session_id: str) -> list[Json]:
    """Return every stored form of a session."""
    forms: list[Json] = ok(lab.operator.get(f"/api/sessions/{session_id}/answers"))
    return forms


def rows(lab: Lab, session_id: str) -> tuple[int, int, int]:
    """Return how many submissions, answers and scores of a session are stored."""
    with lab.database.reading() as db:
        ids = select(Submission.id).where(Submission.session_id == session_id)
        counts = [db.scalar(select(func.count()).select_from(ids.subquery()))]
        for table in (Answer, ScoreValue):
            query = select(func.count()).select_from(table).where(table.submission_id.in_(ids))
            counts.append(db.scalar(query))
    return counts[0] or 0, counts[1] or 0, counts[2] or 0
