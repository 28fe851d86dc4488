"""Tests of erasure: the data it removes, the data that remain, and when it is refused."""

import hashlib
import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.people.audit import verify_trail
from app.features.record.erasure import clear_erasure_mark, is_overwritten, mark_erasure
from app.features.record.sessions import canonical, events_of, verify_chain
from app.models import (
    AuditEntry,
    Erasure,
    Participant,
    SessionContent,
    SessionEvent,
    SlotAttempt,
    StudySession,
    Submission,
)
from app.settings import Settings
from tests.features.care.rights.visit import (
    CANARY,
    SHEET,
    Visit,
    erase,
    in_tables,
    make_visit,
    participant_of,
    submit,
)
from tests.features.lab import STUDY, Json, error, ok
from tests.features.record.headset.site import Site


def mine(code: str) -> str:
    """Return a participant code that contains the canary text."""
    return f"{CANARY}-{code}"


def withdrawn(site: Site, code: str) -> Visit:
    """Return a visit whose participant withdrew."""
    visit = make_visit(site, mine(code))
    site.command(visit.session_id, "withdraw", reason=f"{visit.code} hurts")
    return visit


def test_nothing_of_the_person_is_left_in_any_table(site: Site) -> None:
    """After an erasure no text, JSON or byte column of any table contains the participant's data.

    The session with its status, its event chain and the audit trail remain.
    """
    visit = withdrawn(site, "tables")
    assert len(in_tables(visit, site.database.engine)) >= 5
    erased = erase(site, visit, "withdrawn")
    assert in_tables(visit, site.database.engine) == {}
    assert {"answers", "scores", "submissions", "session_contents"} <= erased["removed"].keys()
    assert erased["overwritten"]
    with site.database.reading() as db:
        session = db.get_one(StudySession, visit.session_id)
        attempt = db.scalars(select(SlotAttempt).where(SlotAttempt.session_id == session.id)).one()
        assert (session.status, attempt.outcome) == ("withdrawn", "withdrawn")
        code = db.get_one(Participant, visit.participant_id).code
        assert code.startswith("erased-")
        check = verify_chain(events_of(db, session.id), version=session.version)
        assert check.ok
        assert verify_trail(db).ok
        acts = db.scalars(select(AuditEntry.action).order_by(AuditEntry.seq)).all()
    assert acts[-1] == "participant.erased"
    events = ok(site.operator.get(f"/api/sessions/{visit.session_id}/events"))
    assert events[-1]["type"] == "data_erased"
    assert events[-1]["data"]["reason_code"] == "withdrawn"


@pytest.mark.one_engine
def test_erased_answers_cannot_be_guessed_from_their_hash(site: Site) -> None:
    """After an erasure the salts are gone, so answers cannot be guessed from the hashes."""
    visit = make_visit(site, mine("salt"))
    with site.database.reading() as db:
        forms = db.scalars(
            select(Submission).where(Submission.session_id == visit.session_id)
        ).all()
        secrets = [form.salt for form in forms] + [form.request_hash for form in forms]
        secrets += [row.salt for row in _contents(db, visit.session_id)]
        answers = ok(site.operator.get(f"/api/sessions/{visit.session_id}/answers"))
        karas = next(form for form in answers if form["instrument"] == "karas2020")
        stored = next(form for form in forms if form.id == karas["submission_id"])
        event = _event_of(site, visit, stored.id)
        # With the salt the answers can be guessed from the hash: this is why salts must be erased.
        guesses = list(_guesses(karas["answers"]))
        assert event["content_hash"] in {_hash(stored.salt or "", one) for one in guesses}
    site.command(visit.session_id, "withdraw", reason="enough")
    erase(site, visit)
    with site.database.reading() as db:
        kept = json.dumps(
            [
                [dict(row) for row in db.execute(select(table)).mappings()]
                for table in (
                    Submission.__table__,
                    SessionContent.__table__,
                    SessionEvent.__table__,
                    Erasure.__table__,
                    AuditEntry.__table__,
                )
            ],
            default=str,
        )
        salts = [row.salt for row in _contents(db, visit.session_id)]
        forms = db.scalars(
            select(Submission).where(Submission.session_id == visit.session_id)
        ).all()
    assert len(secrets) > 6
    assert [one for one in secrets if one is None or one in kept] == []
    assert {*salts, *(form.salt for form in forms)} == {None}
    assert event["content_hash"] not in {_hash("", one) for one in guesses}


def _contents(db: Session, session_id: str) -> list[SessionContent]:
    own = select(SessionContent).where(SessionContent.session_id == session_id)
    return list(db.scalars(own))


def _event_of(site: Site, visit: Visit, submission_id: str) -> Json:
    events = ok(site.operator.get(f"/api/sessions/{visit.session_id}/events"))
    data: Json = next(
        event["data"]
        for event in events
        if event["type"] == "form_submitted" and event["data"]["submission_id"] == submission_id
    )
    return data


def _guesses(answers: Json) -> Iterator[Json]:
    """Yield every possible form, with the first answer varied and all others as submitted."""
    first = next(item for item, value in answers.items() if isinstance(value, float))
    whole = {
        item: int(value) if isinstance(value, float) else value for item, value in answers.items()
    }
    for value in range(1, 8):
        yield {**whole, first: value}


def _hash(salt: str, answers: Json) -> str:
    return hashlib.sha256(f"{salt}{canonical(answers)}".encode()).hexdigest()


@pytest.mark.one_engine
def test_an_erasure_is_refused_while_a_session_runs(site: Site) -> None:
    """An erasure is refused during a session, for a wrong code or reason, and a second time."""
    visit = make_visit(site, mine("rules"))
    path = f"/api/studies/{STUDY}/participants/{visit.participant_id}/erasure"
    body = {"confirm": visit.code, "reason_code": "requested"}
    refusal = error(site.operator.post(path, json=body), 409, "not_now")
    assert refusal["value"] == [visit.session_id]
    site.command(visit.session_id, "withdraw", reason="enough")
    other = {**body, "confirm": "P-0001"}
    error(site.operator.post(path, json=other), 422, "invalid_input")
    error(site.operator.post(path, json={**body, "reason_code": "bored"}), 422, "invalid_input")
    assert participant_of(site, visit.session_id)["erasure"] is None
    erase(site, visit)
    repeated = {**body, "confirm": participant_of(site, visit.session_id)["code"]}
    error(site.operator.post(path, json=repeated), 409, "conflict")


def test_no_data_can_be_added_after_an_erasure(site: Site) -> None:
    """After an erasure, notes, corrections, headset data and new sessions are refused."""
    visit = withdrawn(site, "after")
    forms = ok(site.operator.get(f"/api/sessions/{visit.session_id}/answers"))
    erase(site, visit)
    view = site.view(visit.session_id)
    assert view["allowed"] == []
    note = {
        "command_id": "5" * 32,
        "expected_version": view["version"],
        "type": "note",
        "text": "it was",
    }
    path = f"/api/sessions/{visit.session_id}"
    error(site.operator.post(f"{path}/commands", json=note), 409, "not_now")
    body = {"item": "age", "value": 30, "reason": "typed wrongly"}
    path = f"{path}/submissions/{forms[0]['submission_id']}/corrections"
    assert site.operator.post(path, json=body).status_code in (404, 409, 422)
    join = {"kind": "people", "participant_code": view["participant_code"]}
    error(site.operator.post(f"/api/studies/{STUDY}/sessions", json=join), 409, "conflict")
    # The device is told why, so that it deletes what it still has.
    with site.socket(visit.headset_token) as socket:
        refusal = json.loads(socket.recv(timeout=10.0))
    assert (refusal["code"], "erased" in refusal["message"]) == ("withdrawn", True)
    with site.server.client() as headset:
        bearer = {"authorization": f"Bearer {visit.headset_token}"}
        error(headset.get("/api/vr/form", headers=bearer), 410, "withdrawn")
    assert in_tables(visit, site.database.engine) == {}


@pytest.mark.one_engine
def test_an_erasure_ends_a_planned_session(site: Site) -> None:
    """Erasing the participant of a planned session ends that session as withdrawn."""
    session_id = site.join(kind="people", participant_code=mine("planned"))
    visit = Visit(session_id, participant_of(site, session_id)["id"], mine("planned"))
    erase(site, visit, "mistake")
    view = site.view(session_id)
    assert view["status"] == "withdrawn"
    types = [one["type"] for one in ok(site.operator.get(f"/api/sessions/{session_id}/events"))]
    assert types == ["session_ended", "data_erased"]


def test_a_completed_session_accepts_no_data_after_an_erasure(site: Site) -> None:
    """After an erasure a completed session refuses the data that its headset still has to send."""
    session_id = site.join(kind="people", participant_code=mine("done"))
    view = site.command(session_id, "start")
    site.command(session_id, "complete_step", paper_consent=SHEET)
    submit(site, session_id, occupation=mine("done"))
    token = site.token(session_id)
    while view["status"] == "active":
        view = site.command(session_id, "skip", reason="not in this test")
    assert view["status"] == "completed"
    visit = Visit(session_id, participant_of(site, session_id)["id"], mine("done"), token)
    with site.headset(token) as headset:
        erase(site, visit, "retention")
        assert headset.hear("error")["code"] == "withdrawn"
    assert site.view(session_id)["status"] == "completed"
    assert in_tables(visit, site.database.engine) == {}


def test_an_erasure_mark_that_cannot_be_removed_is_tolerated(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An erasure mark that cannot be deleted raises no error and is removed by a later attempt."""
    settings = Settings(data_dir=tmp_path)
    mark_erasure(settings)

    def refuse(path: Path, **_: object) -> None:
        raise PermissionError(13, "Permission denied", str(path))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "unlink", refuse)
        clear_erasure_mark(settings)
    assert not is_overwritten(settings)
    clear_erasure_mark(settings)
    assert is_overwritten(settings)
