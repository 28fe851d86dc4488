"""Tests of the demo lab: its study, its refusals, and its removal as a whole."""

import json
import re
import time

import pytest
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.database import Base
from app.errors import Conflict
from app.features.design.studies import create_study, newest_version, protocol_of, study_by_key
from app.features.people.accounts import issue_token
from app.features.people.accounts.service import is_active
from app.features.people.audit import record
from app.features.record.demo.demo_study import (
    DEMO_KEY,
    LOADED,
    PAUSE_S,
    PEOPLE,
    PHASE_S,
    demo_code,
    demo_yaml,
    remove_study,
)
from app.features.record.demo.runner import INTERRUPTED, DemoRunner
from app.features.record.sessions import content_body, contents_of
from app.features.record.tryout import TryoutRunner
from app.models import Account, AuditEntry, StudySession
from app.platform.access import Caller
from app.protocol import TIMED_KINDS, compile_plan, sequences
from tests.features.builders import NOW, STUDY, SessionSpec, build_session, build_study
from tests.features.lab import Lab, error, ok

WITHIN_S = 60.0
NOBODY = "http://127.0.0.1:9"


def _rows(db: Session) -> dict[str, int]:
    tables = Base.metadata.sorted_tables
    counts = {one.name: db.scalar(select(func.count()).select_from(one)) or 0 for one in tables}
    return {name: count for name, count in counts.items() if count}


def test_every_phase_of_the_demo_lab_lasts_ten_seconds(fresh_lab: Lab) -> None:
    """The demo study is the shipped one in phases of 10 s, as it says; its orders fit twelve."""
    with fresh_lab.database.writing() as db:
        build_study(db)
        create_study(db, demo_yaml(), NOW)
        protocol = protocol_of(newest_version(db, study_by_key(db, DEMO_KEY)))
        shipped = protocol_of(newest_version(db, study_by_key(db, STUDY)))
    orders = sequences(protocol)
    timed = [step for step in compile_plan(protocol, orders[0]) if step.kind in TIMED_KINDS]
    assert {step.duration_s for step in timed} == {PHASE_S}
    assert [one.latency_ms for one in protocol.conditions] == [
        one.latency_ms for one in shipped.conditions
    ]
    assert PEOPLE % len(orders) == 0
    said = " ".join((protocol.provenance.verified, *protocol.provenance.notes))
    assert {step.preparation_s for step in timed if step.preparation_s} == {PAUSE_S}
    assert f"every timed phase lasts {PHASE_S} s, with {PAUSE_S} s of preparation" in said
    assert not re.search(r"\b(60|5) s\b|2 min", said)
    assert len({demo_code(number) for number in range(1, PEOPLE + 1)}) == PEOPLE


def test_removing_a_study_removes_its_rows_and_no_others(fresh_lab: Lab) -> None:
    """What two sessions of the demo lab stored is gone afterwards, and everything else is there."""
    with fresh_lab.database.writing() as db:
        build_study(db)
        build_session(db, SessionSpec("P-0001"))
        before = _rows(db)
        create_study(db, demo_yaml(), NOW)
        for number in (1, 2):
            spec = SessionSpec(demo_code(number), kind="simulated")
            build_session(db, spec, study=DEMO_KEY)
        filled = _rows(db)
        removed = remove_study(db, study_by_key(db, DEMO_KEY))
        db.flush()
        assert _rows(db) == before
    assert removed == sum(filled.values()) - sum(before.values())
    assert filled["answers"] > before["answers"]


@pytest.mark.one_engine
def test_a_demo_lab_that_cannot_be_loaded_says_why_and_is_removed(fresh_lab: Lab) -> None:
    """Without a reachable server the demo lab fails with a reason; removing it leaves no study."""
    lab = fresh_lab
    assert ok(lab.operator.get("/api/demo"))["state"] == "absent"
    error(lab.operator.delete("/api/demo"), 404, "not_found")
    error(lab.operator.post("/api/demo", json={"language": "fr"}), 422, "invalid_input")
    with lab.database.reading() as db:
        account = db.query(Account).filter_by(username="admin").one()
    caller = Caller(account.id, account.username, account.role)
    runner = lab.context.part(DemoRunner)
    assert runner.load(caller, "en", NOBODY).state == "loading"
    error(lab.operator.post("/api/demo", json={"language": "en"}), 409, "conflict")
    give_up_s = time.monotonic() + WITHIN_S
    while (view := ok(lab.operator.get("/api/demo")))["state"] == "loading":
        assert time.monotonic() < give_up_s
        time.sleep(0.05)
    assert view["state"] == "failed"
    assert NOBODY in view["message"]
    assert view["remedy"]
    assert ok(lab.operator.delete("/api/demo"))["rows"] > 0
    assert ok(lab.operator.get("/api/demo"))["state"] == "absent"
    error(lab.operator.get(f"/api/studies/{DEMO_KEY}"), 404, "not_found")


def test_a_study_that_others_made_with_the_demos_key_is_neither_filled_nor_removed(
    fresh_lab: Lab,
) -> None:
    """The lab's own study of this key keeps its people: loading and removing are refused."""
    lab = fresh_lab
    with lab.database.writing() as db:
        build_study(db)
        create_study(db, demo_yaml(), NOW)
        build_session(db, SessionSpec("P-0001"), study=DEMO_KEY)
        before = _rows(db)
    view = ok(lab.operator.get("/api/demo"))
    assert view["state"] == "absent"
    assert "was not made by the demo lab" in view["message"]
    error(lab.operator.post("/api/demo", json={"language": "en"}), 409, "conflict")
    refused = error(lab.operator.delete("/api/demo"), 409, "conflict")
    assert refused["valid"]
    assert refused["remedy"]
    with lab.database.reading() as db:
        assert _rows(db) == before


def _load_one(db: Session) -> None:
    """Store the demo lab's own study with one simulated session."""
    build_study(db)
    create_study(db, demo_yaml(), NOW)
    record(db, actor="account:admin", action=LOADED, subject=DEMO_KEY, now=NOW)
    build_session(db, SessionSpec(demo_code(1), kind="simulated"), study=DEMO_KEY)


def test_a_demo_lab_with_a_session_of_a_person_is_not_removed(fresh_lab: Lab) -> None:
    """A study that the demo lab made is kept, too, once somebody took part; else it is audited."""
    lab = fresh_lab
    with lab.database.writing() as db:
        _load_one(db)
        account = db.query(Account).filter_by(username="admin").one()
        caller = Caller(account.id, account.username, account.role)
        blind = Caller(account.id, account.username, account.role, all_studies=False)
    runner = lab.context.part(DemoRunner)
    assert runner.view(blind).message == "the demo lab is not possible here"
    with pytest.raises(Conflict):
        runner.remove(blind)
    with lab.database.writing() as db:
        build_session(db, SessionSpec("P-0001"), study=DEMO_KEY)
    with pytest.raises(Conflict) as refusal:
        runner.remove(caller)
    assert refusal.value.value == {"not_simulated": 1, "running": 0}


def test_the_audit_trail_says_what_was_removed(fresh_lab: Lab) -> None:
    """The entry of a removal names the study and counts its participants and sessions."""
    lab = fresh_lab
    with lab.database.writing() as db:
        _load_one(db)
    assert ok(lab.operator.delete("/api/demo"))["rows"] > 0
    with lab.database.reading() as db:
        (entry,) = db.query(AuditEntry).filter_by(action="demo.removed")
    assert json.loads(entry.details) == {"study": DEMO_KEY, "participants": 1, "sessions": 1}


def test_visits_that_were_broken_off_are_ended_on_the_record_before_people_come_again(
    fresh_lab: Lab,
) -> None:
    """Loading again aborts the demo lab's unfinished sessions with a reason, and no others."""
    lab = fresh_lab
    with lab.database.writing() as db:
        _load_one(db)
        account = db.query(Account).filter_by(username="admin").one()
    caller = Caller(account.id, account.username, account.role)
    views = [
        ok(
            lab.operator.post(
                f"/api/studies/{DEMO_KEY}/sessions",
                json={"kind": "simulated", "participant_code": code},
            )
        )
        for code in (demo_code(2), demo_code(3), "SIM-9999")
    ]
    for view in (views[0], views[2]):
        lab.command(view, "start")
    *broken_off, other = (view["id"] for view in views)
    runner = lab.context.part(DemoRunner)
    assert runner.load(caller, "en", NOBODY).state == "loading"
    runner.stop()
    assert [lab.view(one)["status"] for one in broken_off] == ["aborted", "aborted"]
    assert lab.view(other)["status"] == "active"
    with lab.database.reading() as db:
        reasons = [
            content_body(row) for one in broken_off for row in contents_of(db, one, "reason")
        ]
    assert reasons == [INTERRUPTED, INTERRUPTED]


def test_no_login_of_simulated_people_outlives_their_server(fresh_lab: Lab) -> None:
    """A server that starts revokes the logins of the one before, and leaves those of scripts."""
    lab = fresh_lab
    with lab.database.writing() as db:
        account = db.query(Account).filter_by(username="admin").one()
        tokens = [
            issue_token(db, account, purpose=one, now=NOW, hours=2.0).token
            for one in ("demo", "tryout", "script")
        ]
    lab.context.part(DemoRunner).start()
    lab.context.part(TryoutRunner).start()
    with lab.database.reading() as db:
        assert [is_active(db, one) for one in tokens] == [False, False, True]


def test_only_the_demo_labs_own_people_are_counted(fresh_lab: Lab) -> None:
    """Somebody else who completes a simulated session there does not count among its people."""
    lab = fresh_lab
    with lab.database.writing() as db:
        _load_one(db)
        build_session(db, SessionSpec("SIM-0001", kind="simulated"), study=DEMO_KEY)
        statuses = db.scalars(select(StudySession.status)).all()
        account = db.query(Account).filter_by(username="admin").one()
    assert statuses == ["completed", "completed"]
    caller = Caller(account.id, account.username, account.role)
    assert lab.context.part(DemoRunner).view(caller).completed == 1
