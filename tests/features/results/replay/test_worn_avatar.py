"""Tests of the avatar that a replay shows: the one that was worn, whatever is asked for later."""

from typing import Any

import pytest
from sqlalchemy import select

from app.features.record.doubts.statures import read_statures
from app.features.record.sessions import RecordAvatar, apply_command, store_content
from app.features.record.sessions.avatars import avatars_of_phase
from app.models import Phase, SessionEvent, StudySession
from app.platform.access import session_by_id
from tests.features.lab import Json, Lab, error, ok
from tests.features.record.headset.test_avatar import request_avatar
from tests.features.record.sessions.test_avatar_changes import in_the_body, joined, wearing
from tests.wire.message_vectors import CALIBRATION


def replayed_m(lab: Lab, session_id: str, phase_id: int) -> float:
    """Return the stature of the body in a replay."""
    view = ok(lab.operator.get(f"/api/sessions/{session_id}/phases/{phase_id}/replay"))
    assert view["stature_known"]
    return float(view["stature_m"])


def test_a_replay_shows_the_body_that_its_phase_began_with(fresh_lab: Lab) -> None:
    """A body asked for in mid-phase is that of later phases; one after the end changes nothing.

    A session of an earlier release may have recorded bodies after its end: they were never worn.
    """
    lab, view = fresh_lab, joined(fresh_lab)
    token = lab.headset_token(view["id"])
    ok(request_avatar(lab, token, {"stature_m": 1.75}))
    with wearing(lab, token) as wearer:
        view = in_the_body(lab, lab.view(view["id"]), wearer)
        view = lab.skip_to(view, "free_roam")
        for phase_id, stature_m in ((1, 1.9), (2, 2.0)):
            view = lab.command(lab.view(view["id"]), "begin_phase")
            clock: dict[str, Any] = {"kind": "phase", "phase_id": phase_id}
            wearer.report(**clock, what="started", t_s=10.0 * phase_id, active_s=0.0)
            ok(request_avatar(lab, token, {"stature_m": stature_m}))
            view = lab.command(lab.view(view["id"]), "redo", reason="once more")
        view = lab.command(view, "abort", reason="enough")
    assert [replayed_m(lab, view["id"], phase_id) for phase_id in (1, 2)] == [1.75, 1.9]
    with lab.database.reading() as db:
        phases = list(db.scalars(select(Phase).order_by(Phase.phase_id)))
        statures = read_statures(db, StudySession.id == view["id"], phases)
    assert [[one.stature_m for one in statures[view["id"], at]] for at in (1, 2)] == [
        [1.75, 1.9],
        [1.9, 2.0],
    ]
    old: Json = {"stature_m": 0.6, "model_hash": "f" * 64}
    with lab.database.writing() as db:
        row = session_by_id(db, view["id"], lock=True)
        now = lab.context.clock.utc_now()
        made = store_content(db, session_id=row.id, kind="avatar", body=old, by="headset", now=now)
        late = RecordAvatar(configuration_hash="0" * 64, content=made)
        apply_command(db, lab.context, row, late, actor="headset")
    assert [replayed_m(lab, view["id"], phase_id) for phase_id in (1, 2)] == [1.75, 1.9]


@pytest.mark.one_engine
def test_nothing_new_is_asked_of_a_session_that_has_ended(fresh_lab: Lab) -> None:
    """After the end a headset gets no new body and changes no language, and measures nobody.

    It may still be paired, because its journal may have what the session lacks; a withdrawn session
    refuses everything.
    """
    lab, view = fresh_lab, joined(fresh_lab)
    token = lab.headset_token(view["id"])
    ok(request_avatar(lab, token, {"stature_m": 1.75}))
    bearer = {"authorization": f"Bearer {token}"}
    before = len(lab.events(view["id"])) + 2
    lab.command(lab.command(lab.view(view["id"]), "start"), "abort", reason="enough")
    client = lab.stranger()
    late = error(request_avatar(lab, token, {"stature_m": 1.8}), 409, "conflict")
    assert (late["value"], late["valid"]) == ("aborted", ["planned", "active"])
    put = client.put("/api/vr/language", json={"language": "de"}, headers=bearer)
    assert "has ended" in error(put, 409, "not_now")["message"]
    tablet = lab.tablet(view["id"])
    error(tablet.put("/api/tablet/language", json={"language": "de"}), 409, "not_now")
    ok(tablet.put("/api/tablet/language", json={"language": "en"}))
    with wearing(lab, lab.headset_token(view["id"]), calibrates=True) as late_run:
        late_run.report(**CALIBRATION)
    assert len(lab.events(view["id"])) == before
    after = lab.view(view["id"])
    assert (after["calibration"], after["language"]) == (None, "en")
    path = f"/api/studies/{view['study_key']}/sessions"
    gone = ok(lab.operator.post(path, json={"kind": "test"}))
    token = lab.headset_token(gone["id"])
    lab.command(lab.command(gone, "start"), "withdraw", reason="wants to")
    assert request_avatar(lab, token, {"stature_m": 1.75}).status_code in (401, 410)


def log(*events: tuple[str, str]) -> list[SessionEvent]:
    """Return a log of events, given as type and payload."""
    return [
        SessionEvent(session_id="s", seq=seq, type=kind, payload=payload)
        for seq, (kind, payload) in enumerate(events, start=1)
    ]


def built(content: str, body: str) -> tuple[str, str]:
    """Return the event of an avatar that was built for a body, which is written as JSON."""
    return ("avatar_built", f'{{"content_id": "{content}", "body": {body}}}')


def test_every_body_has_its_own_newest_avatar() -> None:
    """A phase begins with the newest avatar of its own body; other bodies do not matter."""
    events = log(
        built("a", "null"),
        built("b", '"five"'),
        built("c", '"five"'),
        built("d", '"four"'),
        ("phase_started", '{"phase_id": 1}'),
        built("e", '"five"'),
        ("phase_ended", '{"phase_id": 1}'),
        built("f", '"five"'),
        ("phase_started", '{"phase_id": 2}'),
        ("session_ended", "{}"),
        built("g", '"five"'),
    )

    def contents(phase_id: int, body: str | None) -> list[str]:
        return [one.content_id for one in avatars_of_phase(events, phase_id, body)]

    assert contents(1, "five") == ["c", "e"]
    assert contents(2, "five") == ["f"]
    assert (contents(1, None), contents(1, "four"), contents(1, "six")) == (["a"], ["d"], [])
