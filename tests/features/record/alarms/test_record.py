"""Alarms on the record: added, never changed, and read as one story."""

from collections.abc import Iterator
from datetime import timedelta

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.alarms.alarm import Change, Condition
from app.features.record.alarms.service import (
    alarm_history,
    clear_all,
    open_alarms,
    sessions_with_open_alarms,
    store_change,
)
from app.models import AlarmRow, StudySession
from tests.features.builders import SessionSpec, build_session
from tests.features.lab import Lab, ok, running_lab
from tests.features.record.alarms.watched import BEGAN, at
from tests.features.session_filler import stable_id

GAP = Condition("gap", "a gap of 0.5 s", "target", 0.5, "s", 12.25)
SILENT = Condition("silent", "silent for 3 s", None, 3.0, "s")


@pytest.fixture
def session(lab: Lab, request: pytest.FixtureRequest) -> StudySession:
    """A session without alarms."""
    with lab.database.writing() as db:
        return build_session(db, SessionSpec(stable_id(request.node.name)[:12]))


@pytest.fixture
def db(lab: Lab, session: StudySession) -> Iterator[Session]:
    """A transaction, after the one that made the session."""
    with lab.database.writing() as db:
        yield db


def raised(condition: Condition, second: float) -> Change:
    """An alarm begins."""
    return Change("raised", condition, at(second).utc)


def cleared(condition: Condition, second: float) -> Change:
    """An alarm ends."""
    return Change("cleared", condition, at(second).utc)


def test_an_alarm_is_open_from_its_raising_to_its_clearing(
    db: Session, session: StudySession
) -> None:
    """Two rows, one story."""
    assert store_change(db, session.id, raised(GAP, 1.0))
    (alarm,) = open_alarms(db, session.id)
    assert (alarm.code, alarm.severity, alarm.stream) == ("gap", "warning", "target")
    assert (alarm.value, alarm.unit, alarm.client_t_s) == (0.5, "s", 12.25)
    assert (alarm.since, alarm.cleared_at) == (at(1.0).utc, None)
    assert store_change(db, session.id, cleared(GAP, 5.0))
    assert open_alarms(db, session.id) == []
    (told,) = alarm_history(db, session)
    assert (told.since, told.cleared_at, told.outcome) == (at(1.0).utc, at(5.0).utc, None)


def test_the_same_change_twice_is_stored_once(db: Session, session: StudySession) -> None:
    """Two sockets of one session may raise the same alarm; what is not open cannot be cleared."""
    assert not store_change(db, session.id, cleared(GAP, 0.0))
    changes = [raised(GAP, 1.0), raised(GAP, 2.0), cleared(GAP, 3.0), cleared(GAP, 4.0)]
    assert [store_change(db, session.id, one) for one in changes] == [True, False, True, False]
    assert len(alarm_history(db, session)) == 1


def test_the_newest_story_comes_first(db: Session, session: StudySession) -> None:
    """And each clearing belongs to the raising before it."""
    for change in (
        raised(GAP, 1.0),
        raised(SILENT, 2.0),
        cleared(GAP, 5.0),
        raised(GAP, 6.0),
        cleared(SILENT, 9.0),
    ):
        store_change(db, session.id, change)
    told = alarm_history(db, session)
    assert [one.code for one in told] == ["gap", "silent", "gap"]
    ends = [None, at(9.0).utc, at(5.0).utc]
    assert [one.cleared_at for one in told] == ends
    assert [one.code for one in open_alarms(db, session.id)] == ["gap"]


def test_a_wall_clock_that_is_set_back_does_not_turn_the_story_round(
    db: Session, session: StudySession
) -> None:
    """What is cleared stays cleared, and may be raised again."""
    store_change(db, session.id, raised(GAP, 3600.0))
    store_change(db, session.id, cleared(GAP, 2.0))
    assert open_alarms(db, session.id) == []
    store_change(db, session.id, raised(GAP, 3.0))
    assert len(open_alarms(db, session.id)) == 1
    rows = db.scalars(
        select(AlarmRow).where(AlarmRow.session_id == session.id).order_by(AlarmRow.at)
    )
    assert [row.state for row in rows] == ["raised", "cleared", "raised"]


def test_clearing_all_says_why(db: Session, session: StudySession) -> None:
    """Of those that were open, and of nothing else."""
    store_change(db, session.id, raised(GAP, 1.0))
    store_change(db, session.id, raised(SILENT, 1.0))
    store_change(db, session.id, cleared(SILENT, 2.0))
    assert session.id in sessions_with_open_alarms(db)
    now = BEGAN + timedelta(seconds=9)
    assert clear_all(db, [session.id], "it is over", now) == 1
    assert clear_all(db, [session.id], "it is over", now) == 0
    assert session.id not in sessions_with_open_alarms(db)
    assert {one.code: one.outcome for one in alarm_history(db, session)} == {
        "gap": "it is over",
        "silent": None,
    }


@pytest.mark.parametrize("value", [float("nan"), float("inf"), None])
def test_what_is_no_number_is_stored_as_nothing(
    db: Session, session: StudySession, value: float | None
) -> None:
    """JSON has no word for it; a long message is cut."""
    store_change(db, session.id, raised(Condition("jump", "x" * 999, "actual", value), 1.0))
    (alarm,) = open_alarms(db, session.id)
    assert (alarm.value, len(alarm.message)) == (None, 400)


@pytest.mark.one_engine
def test_the_history_is_told_over_http(lab: Lab, session: StudySession) -> None:
    """To whoever is signed in."""
    with lab.database.writing() as db:
        store_change(db, session.id, raised(GAP, 1.0))
    path = f"/api/sessions/{session.id}/alarms"
    (alarm,) = ok(lab.operator.get(path))
    assert (alarm["code"], alarm["since"]) == ("gap", "2026-03-02T09:30:01Z")
    assert lab.stranger().get(path).status_code == 401
    assert lab.operator.get("/api/sessions/none/alarms").status_code == 404


def test_a_server_that_starts_again_clears_what_was_open(database_url: str) -> None:
    """It cannot know whether the cause is still there, and says so."""
    with running_lab(database_url) as before:
        session_id = before.join()["id"]
        with before.database.writing() as db:
            store_change(db, session_id, raised(SILENT, 1.0))
            store_change(db, session_id, raised(GAP, 1.0))
            store_change(db, session_id, cleared(GAP, 4.0))
        assert [one["code"] for one in before.view(session_id)["alarms"]] == ["silent"]
    with running_lab(database_url) as after:
        assert after.view(session_id)["alarms"] == []
        history = ok(after.operator.get(f"/api/sessions/{session_id}/alarms"))
    outcomes = {one["code"]: one["outcome"] for one in history}
    assert outcomes == {"silent": "the server had stopped in between", "gap": None}
