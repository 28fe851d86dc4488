"""The pre-flight list: made anew from what the server knows, overridden with a reason on record."""

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
    """The list, by key."""
    told = ok(lab.operator.get(f"/api/sessions/{session_id}/preflight"))
    return {check["key"]: check for check in told["checks"]}


def codes_of(lab: Lab, session_id: str) -> dict[str, str]:
    """What each check has found."""
    return {key: check["code"] for key, check in checks_of(lab, session_id).items()}


def override(lab: Lab, session_id: str, check: str, reason: str = "the lab has one only") -> Any:
    """Ask to go on all the same."""
    path = f"/api/sessions/{session_id}/preflight/overrides"
    return lab.operator.post(path, json={"check": check, "reason": reason})


def wear(lab: Lab, session_id: str, **signal: float | None) -> None:
    """A headset is connected, and its watch tells these figures."""
    lab.headset_token(session_id)
    lab.context.hub.headset_joined(session_id)
    lab.context.hub.note_signal(session_id, {**SOUND, **signal})


def test_the_list_of_a_session_that_nobody_has_prepared(lab: Lab) -> None:
    """Devices fail, what hangs on them waits, storage and study are tried and told."""
    session_id = lab.join()["id"]
    told = ok(lab.operator.get(f"/api/sessions/{session_id}/preflight"))
    assert (told["clear"], told["asks"]) == (False, True)
    checks = {check["key"]: check for check in told["checks"]}
    assert [(key, check["status"], check["code"]) for key, check in checks.items()] == [
        ("tablet", "fail", "tablet.unpaired"),
        ("headset", "fail", "headset.unpaired"),
        ("frame_rate", "wait", "frame_rate.no_headset"),
        ("clock", "wait", "clock.no_headset"),
        ("trackers", "wait", "trackers.no_movement"),
        ("storage", "ok", "storage.ok"),
        ("disk", "ok", checks["disk"]["code"]),
        ("latency", "wait", "latency.unmeasured"),
        ("instruments", "ok", "instruments.ok"),
        ("configuration", "ok", "configuration.ok"),
        ("language", "ok", "language.ok"),
    ]
    assert checks["storage"]["value"] > 0
    assert checks["storage"]["unit"] == "ms"
    assert any(one.startswith("karas2020 v") for one in checks["instruments"]["details"])


@pytest.mark.one_engine
def test_sound_devices_make_the_list_clear(lab: Lab) -> None:
    """A tablet that was seen, a headset whose figures keep to the limits."""
    session_id = lab.join()["id"]
    ok(lab.tablet(session_id).get("/api/tablet/state"))
    wear(lab, session_id)
    checks = checks_of(lab, session_id)
    assert {check["status"] for check in checks.values()} == {"ok", "wait"}
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
def test_what_the_headset_tells_is_judged(
    lab: Lab, signal: dict[str, float | None], key: str, status: str, code: str | None
) -> None:
    """By the limits of the live watch; what is not known yet waits."""
    session_id = lab.join()["id"]
    wear(lab, session_id, **signal)
    check = checks_of(lab, session_id)[key]
    assert check["status"] == status
    assert code is None or check["code"] == code


@pytest.mark.one_engine
def test_a_headset_that_has_gone_leaves_no_figures(lab: Lab) -> None:
    """Else the list would go on praising the one that was taken off."""
    session_id = lab.join()["id"]
    wear(lab, session_id)
    lab.context.hub.headset_left(session_id)
    lab.context.hub.note_signal(session_id, SOUND)
    codes = codes_of(lab, session_id)
    assert (codes["headset"], codes["clock"]) == ("headset.away", "clock.no_headset")


def test_the_written_row_and_file_are_gone_again(
    lab: Lab, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Also what an earlier test that was cut off has left."""
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


def test_storage_that_keeps_something_else_is_told(
    fresh_lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is read back is compared, not believed."""
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
def test_a_study_that_was_changed_behind_the_products_back_is_told(fresh_lab: Lab) -> None:
    """Its content has another hash than the record, and so has an instrument's."""
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


def test_an_override_goes_on_record_with_its_reason_and_the_finding(lab: Lab) -> None:
    """The event names the check; the words lie beside it; everybody sees them in the list."""
    session_id = lab.join()["id"]
    told = ok(override(lab, session_id, "headset", "  on loan until noon "))
    assert told["status"] == "overridden"
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
def test_words_about_one_finding_do_not_cover_another(lab: Lab) -> None:
    """A headset that was not there is another thing than one that has gone."""
    session_id = lab.join()["id"]
    ok(override(lab, session_id, "headset"))
    lab.headset_token(session_id)
    check = checks_of(lab, session_id)["headset"]
    assert (check["status"], check["code"]) == ("fail", "headset.away")
    assert check["override"]["found"] == "headset.unpaired"


@pytest.mark.one_engine
def test_all_overridden_is_clear_and_the_session_starts_either_way(lab: Lab) -> None:
    """The server tells and records; it does not refuse the start."""
    view = lab.join()
    for key in ("tablet", "headset"):
        ok(override(lab, view["id"], key))
    assert ok(lab.operator.get(f"/api/sessions/{view['id']}/preflight"))["clear"] is True
    assert lab.command(lab.view(view["id"]), "start")["status"] == "active"
    unasked = lab.join()
    assert lab.command(unasked, "start")["status"] == "active"


@pytest.mark.one_engine
def test_a_check_that_has_turned_green_is_told_and_nothing_is_recorded(lab: Lab) -> None:
    """Somebody writes a reason while the headset connects: it is needed no more."""
    view = lab.join()
    told = ok(override(lab, view["id"], "language"))
    assert (told["status"], told["override"]) == ("ok", None)
    assert [one["type"] for one in lab.events(view["id"])].count("check_overridden") == 0


@pytest.mark.one_engine
def test_what_cannot_be_overridden(lab: Lab) -> None:
    """No reason, an unknown check, a session that is over."""
    view = lab.join()
    error(override(lab, view["id"], "tablet", "   "), 422, "invalid_input")
    error(override(lab, view["id"], "weather"), 422, "invalid_input")
    lab.command(lab.command(view, "start"), "abort", reason="not in this test")
    error(override(lab, view["id"], "tablet"), 409, "conflict")
    error(lab.operator.get(f"/api/sessions/{view['id']}/preflight"), 409, "conflict")
    error(lab.operator.get("/api/sessions/nobody/preflight"), 404, "not_found")


@pytest.mark.one_engine
@pytest.mark.parametrize("kind", ["simulated", "test", "expert"])
def test_sessions_without_participants_are_never_in_the_way(lab: Lab, kind: str) -> None:
    """They show the same list."""
    session_id = lab.join(kind=kind)["id"]
    told = ok(lab.operator.get(f"/api/sessions/{session_id}/preflight"))
    assert told["asks"] is False
    assert len(told["checks"]) == 11
