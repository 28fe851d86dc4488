"""Tests that alarms are appended to the record and read back as one history."""

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
    """Return a session without alarms."""
    with lab.database.writing() as db:
        return build_session(db, SessionSpec(stable_id(request.node.name)[:12]))


@pytest.fixture
def db(lab: Lab, session: StudySession) -> Iterator[Session]:
    """Yield a write transaction that begins after the session was stored."""
    with lab.database.writing() as db:
        yield db


def raised(condition: Condition, second: float) -> Change:
    """Return the change that raises an alarm."""
    return Change("raised", condition, at(second).utc)


def cleared(condition: Condition, second: float) -> Change:
    """Return the change that clears an alarm."""
    return Change("cleared", condition, at(second).utc)


def test_an_alarm_is_open_from_its_raising_to_its_clearing(
    db: Session, session: StudySession
) -> None:
    """An alarm is open from the time it is raised until the time it is cleared."""
    assert store_change(db, session.id, raised(GAP, 1.0))
    (alarm,) = open_alarms(db, session.id)
    assert (alarm.code, alarm.severity, alarm.stream) == ("gap", "warning", "target")
    assert (alarm.value, alarm.unit, alarm.client_t_s) == (0.5, "s", 12.25)
    assert (alarm.since, alarm.cleared_at) == (at(1.0).utc, None)
    assert store_change(db, session.id, cleared(GAP, 5.0))
    assert open_alarms(db, session.id) == []
    (stored,) = alarm_history(db, session)
    assert (stored.since, stored.cleared_at, stored.outcome) == (at(1.0).utc, at(5.0).utc, None)


def test_a_repeated_change_is_stored_once(db: Session, session: StudySession) -> None:
    """Raising an open alarm or clearing one that is not open stores nothing."""
    assert not store_change(db, session.id, cleared(GAP, 0.0))
    changes = [raised(GAP, 1.0), raised(GAP, 2.0), cleared(GAP, 3.0), cleared(GAP, 4.0)]
    assert [store_change(db, session.id, one) for one in changes] == [True, False, True, False]
    assert len(alarm_history(db, session)) == 1


def test_the_alarm_history_lists_the_newest_first(db: Session, session: StudySession) -> None:
    """The alarm history lists the newest first, each with the time it was cleared."""
    for change in (
        raised(GAP, 1.0),
        raised(SILENT, 2.0),
        cleared(GAP, 5.0),
        raised(GAP, 6.0),
        cleared(SILENT, 9.0),
    ):
        store_change(db, session.id, change)
    history = alarm_history(db, session)
    assert [one.code for one in history] == ["gap", "silent", "gap"]
    ends = [None, at(9.0).utc, at(5.0).utc]
    assert [one.cleared_at for one in history] == ends
    assert [one.code for one in open_alarms(db, session.id)] == ["gap"]


def test_a_wall_clock_set_back_keeps_the_order_of_alarms(
    db: Session, session: StudySession
) -> None:
    """An alarm cleared at an earlier wall-clock time than it was raised at is still cleared."""
    store_change(db, session.id, raised(GAP, 3600.0))
    store_change(db, session.id, cleared(GAP, 2.0))
    assert open_alarms(db, session.id) == []
    store_change(db, session.id, raised(GAP, 3.0))
    assert len(open_alarms(db, session.id)) == 1
    rows = db.scalars(
        select(AlarmRow).where(AlarmRow.session_id == session.id).order_by(AlarmRow.at)
    )
    assert [row.state for row in rows] == ["raised", "cleared", "raised"]


def test_clearing_all_alarms_stores_the_reason(db: Session, session: StudySession) -> None:
    """Clearing all alarms of a session clears only the open ones and stores the reason."""
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
def test_a_value_that_json_cannot_express_is_stored_as_null(
    db: Session, session: StudySession, value: float | None
) -> None:
    """An alarm's value that is not finite is stored as null, and a long message is shortened."""
    store_change(db, session.id, raised(Condition("jump", "x" * 999, "actual", value), 1.0))
    (alarm,) = open_alarms(db, session.id)
    assert (alarm.value, len(alarm.message)) == (None, 400)


@pytest.mark.one_engine
def test_the_alarm_history_needs_a_login(lab: Lab, session: StudySession) -> None:
    """The alarm history of a session is readable over HTTP by signed-in accounts only."""
    with lab.database.writing() as db:
        store_change(db, session.id, raised(GAP, 1.0))
    path = f"/api/sessions/{session.id}/alarms"
    (alarm,) = ok(lab.operator.get(path))
    assert (alarm["code"], alarm["since"]) == ("gap", "2026-03-02T09:30:01Z")
    assert lab.stranger().get(path).status_code == 401
    assert lab.operator.get("/api/sessions/none/alarms").status_code == 404


def test_a_server_restart_clears_open_alarms(database_url: str) -> None:
    """A server that restarts clears the open alarms with the reason that it had stopped."""
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
