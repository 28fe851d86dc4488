"""Tests of the hash chain of the event log, which reveals every change to it."""

import json
from collections.abc import Callable
from datetime import timedelta
from typing import Any

import pytest
from sqlalchemy import delete, select, text, update
from sqlalchemy.orm import Session

from app.features.record.sessions.engine import evolve, initial_state
from app.features.record.sessions.journal import ChainCheck, event_of, events_of, verify_chain
from app.features.record.sessions.service import plan_of, state_of
from app.models import Phase, SessionEvent, StudySession, TelemetryStream
from tests.features.builders import NOW
from tests.features.lab import Lab

CANARY = "canary-7f3a"


@pytest.fixture
def logged(lab: Lab) -> str:
    """Return the id of a session with eight events, including a note and reasons."""
    view = lab.skip_to(lab.join(), "materialise")
    lab.context.hub.headset_joined(view["id"])
    view = lab.command(view, "materialise")
    view = lab.command(view, "skip", reason="short of time")
    lab.command(view, "note", text=f"{CANARY} note")
    assert lab.view(view["id"])["version"] == 8
    return str(view["id"])


def check(lab: Lab, session_id: str) -> ChainCheck:
    """Verify the event log as it is stored now."""
    with lab.database.reading() as db:
        session = db.get_one(StudySession, session_id)
        return verify_chain(events_of(db, session_id), version=session.version)


def test_an_untouched_log_verifies(lab: Lab, logged: str) -> None:
    """An unchanged event log verifies."""
    assert check(lab, logged) == ChainCheck(ok=True, events=lab.view(logged)["version"])


def test_folding_the_stored_events_gives_the_stored_snapshot(lab: Lab, logged: str) -> None:
    """Replaying the stored events gives the stored snapshot."""
    with lab.database.reading() as db:
        session = db.get_one(StudySession, logged)
        state = initial_state(len(plan_of(db, session)))
        for row in events_of(db, logged):
            state = evolve(state, event_of(row))
        assert state == state_of(session)
        assert (state.version, str(state.status)) == (session.version, session.status)


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("column", "changed"),
    [
        ("type", lambda _: "note_added"),
        ("payload", lambda row: row.payload.replace("}", " }")),
        ("actor", lambda _: "account:somebody"),
        ("command_id", lambda _: None),
        ("recorded_at", lambda row: row.recorded_at + timedelta(microseconds=1)),
        ("monotonic_ns", lambda row: row.monotonic_ns + 1),
        ("previous_hash", lambda _: "f" * 64),
        ("hash", lambda _: "f" * 64),
    ],
)
def test_an_edited_column_breaks_the_chain(
    lab: Lab, logged: str, column: str, changed: Callable[[SessionEvent], Any]
) -> None:
    """Changing any column of an event breaks the chain at that event."""
    with lab.database.writing() as db:
        row = db.get_one(SessionEvent, (logged, 4))
        setattr(row, column, changed(row))
    assert check(lab, logged).broken_at == 4


@pytest.mark.one_engine
def test_an_event_moved_to_another_session_is_detected(lab: Lab, logged: str) -> None:
    """An event moved to another session breaks that session's chain."""
    other = str(lab.join()["id"])
    with lab.database.writing() as db:
        here = (SessionEvent.session_id == logged) & (SessionEvent.seq == 1)
        db.execute(update(SessionEvent).where(here).values(session_id=other))
    with lab.database.reading() as db:
        assert verify_chain(events_of(db, other)).broken_at == 1


@pytest.mark.one_engine
@pytest.mark.parametrize("seq", [1, 4])
def test_a_removed_event_is_detected(lab: Lab, logged: str, seq: int) -> None:
    """A removed event breaks the chain at its seq."""
    with lab.database.writing() as db:
        _delete(db, logged, seq)
    assert check(lab, logged).broken_at == seq


def test_a_removed_last_event_is_detected(lab: Lab, logged: str) -> None:
    """A removed last event is detected by the session's version."""
    last = lab.view(logged)["version"]
    with lab.database.writing() as db:
        _delete(db, logged, last)
    assert check(lab, logged).broken_at == last


@pytest.mark.one_engine
def test_a_removed_event_is_detected_after_renumbering(lab: Lab, logged: str) -> None:
    """A removed event is detected even if the later events are renumbered."""
    with lab.database.writing() as db:
        _delete(db, logged, 4)
        for seq in range(5, lab_version(db, logged) + 1):
            _move(db, logged, seq, seq - 1)
    assert check(lab, logged).broken_at == 4


@pytest.mark.one_engine
def test_an_inserted_event_is_detected(lab: Lab, logged: str) -> None:
    """An inserted event breaks the chain at its seq."""
    with lab.database.writing() as db:
        for seq in range(lab_version(db, logged), 3, -1):
            _move(db, logged, seq, seq + 1)
        row = db.get_one(SessionEvent, (logged, 3))
        columns = {
            name: getattr(row, name)
            for name in SessionEvent.__table__.columns.keys()  # noqa: SIM118 - not a dict: it iterates over columns
        }
        db.add(SessionEvent(**{**columns, "seq": 4, "previous_hash": row.hash}))
    assert check(lab, logged).broken_at == 4


@pytest.mark.one_engine
def test_swapped_events_are_detected(lab: Lab, logged: str) -> None:
    """Two swapped events break the chain at the first of them."""
    with lab.database.writing() as db:
        _move(db, logged, 4, 1000)
        _move(db, logged, 5, 4)
        _move(db, logged, 1000, 5)
    assert check(lab, logged).broken_at == 4


@pytest.mark.one_engine
def test_a_changed_previous_hash_is_detected(lab: Lab, logged: str) -> None:
    """An event whose previous hash was changed breaks the chain."""
    with lab.database.writing() as db:
        third, fourth = (db.get_one(SessionEvent, (logged, seq)) for seq in (3, 4))
        fourth.previous_hash = third.hash[::-1]
    assert check(lab, logged).broken_at == 4


def test_the_event_log_has_no_personal_content(lab: Lab) -> None:
    """Notes, reasons, heights and answers are not in the event log, only their ids and hashes."""
    view = lab.command(lab.join(), "start")
    session_id = view["id"]
    view = lab.command(view, "note", text=f"{CANARY} note")
    view = lab.command(view, "skip", reason=f"{CANARY} reason")
    lab.operator.post(
        f"/api/sessions/{session_id}/submissions", json=_demographics(lab, session_id)
    ).raise_for_status()
    view = lab.skip_to(lab.view(session_id), "height")
    view = lab.command(view, "complete_step", height_m={"stated": 1.7777, "matched": 1.6666})
    lab.command(view, "withdraw", reason=f"{CANARY} withdrawn")
    with lab.database.reading() as db:
        rows = db.execute(
            text("SELECT * FROM session_events WHERE session_id = :id"), {"id": session_id}
        ).all()
    log = repr(rows)
    assert len(rows) >= 7
    assert CANARY not in log
    assert "1.7777" not in repr([row.payload for row in rows])
    assert CANARY in repr(lab.view(session_id))


def test_phase_rows_follow_the_events(lab: Lab) -> None:
    """The row of a phase is voided together with the phase."""
    view = lab.skip_to(lab.join(), "free_roam")
    lab.context.hub.headset_joined(view["id"])
    view = lab.command(view, "begin_phase")
    lab.command(view, "skip", reason="headset fell off")
    with lab.database.reading() as db:
        (phase,) = db.scalars(select(Phase).where(Phase.session_id == view["id"]))
    assert (phase.phase_id, phase.status, phase.active_s) == (1, "voided", 0.0)
    assert phase.ended_at is not None


def test_an_interrupted_phase_keeps_the_active_time_that_it_had(lab: Lab) -> None:
    """Its row, its event and the folded state say how far the stored frames were."""
    view = lab.skip_to(lab.join(), "free_roam")
    lab.context.hub.headset_joined(view["id"])
    view = lab.command(view, "begin_phase")
    with lab.database.writing() as db:
        db.add(_stream(view["id"], phase_id=1, active_s=12.5))
    lab.command(view, "skip", reason="headset fell off")
    with lab.database.reading() as db:
        (phase,) = db.scalars(select(Phase).where(Phase.session_id == view["id"]))
        (voided,) = (row for row in events_of(db, view["id"]) if row.type == "phase_voided")
        (past,) = state_of(db.get_one(StudySession, view["id"])).ended_phases
    assert phase.active_s == json.loads(voided.payload)["active_s"] == past.active_s == 12.5


def test_an_older_record_does_not_say_how_far_an_interrupted_phase_was(lab: Lab) -> None:
    """Where the event has no active time, the page gets none, instead of the last one known."""
    view = lab.skip_to(lab.join(), "free_roam")
    lab.context.hub.headset_joined(view["id"])
    view = lab.command(view, "begin_phase")
    view = lab.command(view, "skip", reason="headset fell off")
    assert view["phases"][0]["active_s"] == 0.0
    with lab.database.writing() as db:
        (phase,) = db.scalars(select(Phase).where(Phase.session_id == view["id"]))
        phase.started_at = phase.prepared_at
    assert lab.view(view["id"])["phases"][0]["active_s"] is None


def _stream(session_id: str, *, phase_id: int, active_s: float) -> TelemetryStream:
    """Return the position of a stream whose newest frame is of a phase at an active time."""
    return TelemetryStream(
        session_id=session_id,
        stream="actual",
        epoch=1,
        phase_id=phase_id,
        active_s=active_s,
        first_at=NOW,
        last_at=NOW,
    )


def _demographics(lab: Lab, session_id: str) -> dict[str, Any]:
    due = lab.operator.get(f"/api/sessions/{session_id}/administration").json()
    return {
        "idempotency_key": f"key-{session_id}",
        "administration": due["key"],
        "answers": {"occupation": f"{CANARY} occupation", "age": 33},
        "shown_order": due["item_order"],
        "seed": due["seed"],
        "language": "en",
    }


def lab_version(db: Session, session_id: str) -> int:
    """Return how many events the session has."""
    return db.get_one(StudySession, session_id).version


def _delete(db: Session, session_id: str, seq: int) -> None:
    db.execute(
        delete(SessionEvent).where(SessionEvent.session_id == session_id, SessionEvent.seq == seq)
    )


def _move(db: Session, session_id: str, seq: int, to: int) -> None:
    db.execute(
        update(SessionEvent)
        .where(SessionEvent.session_id == session_id, SessionEvent.seq == seq)
        .values(seq=to)
    )
