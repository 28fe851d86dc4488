"""Tests of the pre-flight: checks of the current state, and overrides with a recorded reason."""

import json
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import func, select, text

from app.features.record.preflight.checks.storage import KIND
from app.features.record.sessions.contents import content_body, contents_of
from app.models import SessionContent
from tests.features.lab import Json, Lab, error, ok

SOUND = {"frame_rate_hz": 89.9, "usual_rate_hz": 90.0, "clock_uncertainty_ms": 1.8}


def checks_of(lab: Lab, session_id: str) -> dict[str, Json]:
    """Return the checks of a session by key."""
    reply = ok(lab.operator.get(f"/api/sessions/{session_id}/preflight"))
    return {check["key"]: check for check in reply["checks"]}


def codes_of(lab: Lab, session_id: str) -> dict[str, str]:
    """Return the code of each check's finding, by the key of the check."""
    return {key: check["code"] for key, check in checks_of(lab, session_id).items()}


def override(lab: Lab, session_id: str, check: str, reason: str = "the lab has one only") -> Any:
    """Request to override a check."""
    path = f"/api/sessions/{session_id}/preflight/overrides"
    return lab.operator.post(path, json={"check": check, "reason": reason})


def wear(lab: Lab, session_id: str, **signal: float | None) -> None:
    """Connect a headset whose signal has these figures."""
    lab.headset_token(session_id)
    lab.context.hub.headset_joined(session_id)
    lab.context.hub.note_signal(session_id, {**SOUND, **signal})


def test_the_checks_of_a_session_that_nobody_has_prepared(lab: Lab) -> None:
    """Without devices their checks fail, those that need them wait; others pass or are unneeded."""
    session_id = lab.join()["id"]
    reply = ok(lab.operator.get(f"/api/sessions/{session_id}/preflight"))
    assert (reply["clear"], reply["asks"]) == (False, True)
    checks = {check["key"]: check for check in reply["checks"]}
    assert [(key, check["status"], check["code"]) for key, check in checks.items()] == [
        ("tablet", "fail", "tablet.unpaired"),
        ("headset", "fail", "headset.unpaired"),
        ("frame_rate", "wait", "frame_rate.no_headset"),
        ("clock", "wait", "clock.no_headset"),
        ("trackers", "wait", "trackers.no_movement"),
        ("lab_trackers", "unneeded", "lab_trackers.unneeded"),
        ("feet", "wait", "feet.no_headset"),
        ("storage", "ok", "storage.ok"),
        ("disk", "ok", checks["disk"]["code"]),
        ("latency", "wait", "latency.unmeasured"),
        ("road", "unneeded", "road.unneeded"),
        ("instruments", "ok", "instruments.ok"),
        ("configuration", "ok", "configuration.ok"),
        ("language", "ok", "language.ok"),
    ]
    assert checks["storage"]["value"] > 0
    assert checks["storage"]["unit"] == "ms"
    assert any(one.startswith("karas2020 v") for one in checks["instruments"]["details"])


@pytest.mark.one_engine
def test_working_devices_pass_their_checks(lab: Lab) -> None:
    """A tablet that was seen and a headset within the limits pass their checks."""
    session_id = lab.join()["id"]
    ok(lab.tablet(session_id).get("/api/tablet/state"))
    wear(lab, session_id)
    checks = checks_of(lab, session_id)
    assert {check["status"] for check in checks.values()} == {"ok", "unneeded", "wait"}
    assert checks["latency"]["status"] == "wait"
    rate, clock = checks["frame_rate"], checks["clock"]
    assert (rate["value"], rate["expected"], rate["limit"]) == (89.9, "at_least", 71.1)
    assert (clock["value"], clock["expected"], clock["limit"]) == (1.8, "at_most", 10.0)
    assert checks["trackers"]["value"] == 22


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("signal", "key", "status", "code"),
    [
        ({"frame_rate_hz": 62.0}, "frame_rate", "fail", "frame_rate.low"),
        ({"frame_rate_hz": 45.0, "usual_rate_hz": 45.0}, "frame_rate", "fail", "frame_rate.low"),
        ({"frame_rate_hz": 90.0, "usual_rate_hz": None}, "frame_rate", "wait", None),
        ({"frame_rate_hz": None}, "frame_rate", "wait", "frame_rate.no_movement"),
        ({"frame_rate_hz": None}, "trackers", "wait", "trackers.no_movement"),
        ({"clock_uncertainty_ms": 10.1}, "clock", "fail", "clock.uncertain"),
        ({"clock_uncertainty_ms": None}, "clock", "wait", "clock.measuring"),
    ],
)
def test_the_headsets_figures_are_checked_against_limits(
    lab: Lab, signal: dict[str, float | None], key: str, status: str, code: str | None
) -> None:
    """The headset's figures are checked against the limits of the live watch; unknown ones wait."""
    session_id = lab.join()["id"]
    wear(lab, session_id, **signal)
    check = checks_of(lab, session_id)[key]
    assert check["status"] == status
    assert code is None or check["code"] == code


@pytest.mark.one_engine
def test_a_disconnected_headset_leaves_no_figures(lab: Lab) -> None:
    """The figures of a disconnected headset are no longer used by the checks."""
    session_id = lab.join()["id"]
    wear(lab, session_id)
    lab.context.hub.headset_left(session_id)
    lab.context.hub.note_signal(session_id, SOUND)
    codes = codes_of(lab, session_id)
    assert (codes["headset"], codes["clock"]) == ("headset.away", "clock.no_headset")


def test_the_storage_check_removes_its_row_and_file(
    lab: Lab, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The storage check removes its row and file, and also those left by an interrupted check."""
    session_id = lab.join()["id"]
    monkeypatch.setattr(
        type(lab.context.settings), "data_dir", property(lambda _: tmp_path), raising=False
    )
    with lab.database.writing() as db:
        db.add(
            SessionContent(
                session_id=session_id,
                kind=KIND,
                body="left",
                created_at=lab.context.clock.utc_now(),
                created_by="server",
            )
        )
    assert checks_of(lab, session_id)["storage"]["status"] == "ok"
    with lab.database.reading() as db:
        query = select(func.count()).select_from(SessionContent).where(SessionContent.kind == KIND)
        assert db.scalar(query) == 0
    assert list(tmp_path.iterdir()) == []


def test_storage_that_reads_back_other_data_fails_the_check(
    fresh_lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The storage check fails if other data are read back than were written."""
    session_id = fresh_lab.join()["id"]
    words = iter(["00", "11"])
    monkeypatch.setattr(
        "app.features.record.preflight.checks.storage._compare",
        lambda database, row_id, _: _compare_with(database, row_id, next(words)),
    )
    assert codes_of(fresh_lab, session_id)["storage"] == "storage.differs"


def _compare_with(database: Any, row_id: str, words: str) -> None:
    from app.features.record.preflight.checks.storage import DiffersError

    with database.reading() as db:
        if db.scalar(select(SessionContent.body).where(SessionContent.id == row_id)) != words:
            raise DiffersError


@pytest.mark.one_engine
def test_a_study_changed_in_the_database_fails_its_checks(fresh_lab: Lab) -> None:
    """A study or instrument that was changed directly in the database fails its check."""
    session_id = fresh_lab.join()["id"]
    with fresh_lab.database.writing() as db:
        db.execute(
            text("UPDATE study_versions SET canonical_json = canonical_json || ' '"),
        )
        db.execute(
            text(
                "UPDATE instrument_versions SET canonical_json = canonical_json || ' '"
                " WHERE key = 'karas2020'"
            ),
        )
    checks = checks_of(fresh_lab, session_id)
    assert checks["configuration"]["code"] == "configuration.differs"
    assert checks["instruments"]["code"] == "instruments.damaged"
    assert checks["instruments"]["details"] == ["karas2020"]


def test_an_override_is_recorded_with_its_reason_and_finding(lab: Lab) -> None:
    """An override is recorded with the check's key, its finding, the reason and the account."""
    session_id = lab.join()["id"]
    reply = ok(override(lab, session_id, "headset", "  on loan until noon "))
    assert reply["status"] == "overridden"
    check = checks_of(lab, session_id)["headset"]
    assert check["status"] == "overridden"
    assert check["override"]["reason"] == "on loan until noon"
    assert check["override"]["by"] == "account:admin"
    (event,) = lab.events(session_id)
    assert (event["type"], event["data"]["check"]) == ("check_overridden", "headset")
    assert "loan" not in json.dumps(event)
    with lab.database.reading() as db:
        (content,) = contents_of(db, session_id, "preflight")
        body = content_body(content)
    assert isinstance(body, dict)
    assert (body["reason"], body["found"]) == ("on loan until noon", "headset.unpaired")
    acts = ok(lab.operator.get("/api/audit?action=session.overridden"))["entries"]
    assert acts[0]["subject"] == session_id


@pytest.mark.one_engine
def test_an_override_applies_to_one_finding_only(lab: Lab) -> None:
    """An override of one finding does not apply to another finding of the same check."""
    session_id = lab.join()["id"]
    ok(override(lab, session_id, "headset"))
    lab.headset_token(session_id)
    check = checks_of(lab, session_id)["headset"]
    assert (check["status"], check["code"]) == ("fail", "headset.away")
    assert check["override"]["found"] == "headset.unpaired"


@pytest.mark.one_engine
def test_failed_checks_do_not_prevent_the_start(lab: Lab) -> None:
    """The pre-flight is clear if all failures are overridden, but a session starts in any case."""
    view = lab.join()
    for key in ("tablet", "headset"):
        ok(override(lab, view["id"], key))
    assert ok(lab.operator.get(f"/api/sessions/{view['id']}/preflight"))["clear"] is True
    assert lab.command(lab.view(view["id"]), "start")["status"] == "active"
    unasked = lab.join()
    assert lab.command(unasked, "start")["status"] == "active"


@pytest.mark.one_engine
def test_overriding_a_passed_check_records_nothing(lab: Lab) -> None:
    """Overriding a check that now passes returns its state and records nothing."""
    view = lab.join()
    reply = ok(override(lab, view["id"], "language"))
    assert (reply["status"], reply["override"]) == ("ok", None)
    assert [one["type"] for one in lab.events(view["id"])].count("check_overridden") == 0


@pytest.mark.one_engine
def test_an_invalid_override_is_refused(lab: Lab) -> None:
    """An override without a reason, of an unknown check or of an ended session is refused."""
    view = lab.join()
    error(override(lab, view["id"], "tablet", "   "), 422, "invalid_input")
    error(override(lab, view["id"], "weather"), 422, "invalid_input")
    lab.command(lab.command(view, "start"), "abort", reason="not in this test")
    error(override(lab, view["id"], "tablet"), 409, "conflict")
    error(lab.operator.get(f"/api/sessions/{view['id']}/preflight"), 409, "conflict")
    error(lab.operator.get("/api/sessions/nobody/preflight"), 404, "not_found")


@pytest.mark.one_engine
@pytest.mark.parametrize("kind", ["simulated", "test", "expert"])
def test_sessions_without_participants_need_no_overrides(lab: Lab, kind: str) -> None:
    """Simulated, test and expert sessions have the same checks, but need no overrides."""
    session_id = lab.join(kind=kind)["id"]
    reply = ok(lab.operator.get(f"/api/sessions/{session_id}/preflight"))
    assert reply["asks"] is False
    assert len(reply["checks"]) == 14
