"""Tests that a withdrawal stops the recording immediately."""

import json

import pytest
from sqlalchemy import func, select

from app.models import TelemetryBatch, TelemetryChunk, TelemetryStream
from tests.features.care.rights.visit import FRAMES, make_visit
from tests.features.lab import error, key, ok
from tests.features.record.headset.site import HELLO, Site
from tests.wire.samples import message, standing


def frames_of(site: Site, session_id: str) -> tuple[int, int]:
    """Return the stored frames of a session, and the number that its streams report."""
    with site.database.reading() as db:
        stored = sum(
            db.scalar(
                select(func.coalesce(func.sum(table.frame_count), 0)).where(
                    table.session_id == session_id
                )
            )
            or 0
            for table in (TelemetryBatch, TelemetryChunk)
        )
        reported = db.scalar(
            select(func.sum(TelemetryStream.frames_stored)).where(
                TelemetryStream.session_id == session_id,
                TelemetryStream.stream.in_(("target", "actual")),
            )
        )
    return stored, reported or 0


def test_movement_after_a_withdrawal_is_refused(site: Site) -> None:
    """Movement sent after a withdrawal is refused; other sessions are unaffected."""
    visit, other = make_visit(site, "gone-1"), make_visit(site, "stays-1")
    with (
        site.headset(visit.headset_token) as headset,
        site.headset(other.headset_token) as neighbour,
    ):
        site.command(visit.session_id, "withdraw", reason="enough")
        state = headset.hear("state", lambda reported: reported["status"] == "withdrawn")
        assert state["recording"] is False
        for one in (headset, neighbour):
            one.say(message(standing(9), epoch=one.epoch, seq_first=0))
        refusal = headset.hear("error")
        assert refusal["code"] == "withdrawn"
        assert "withdrawn" in refusal["message"]
        assert "discard" in refusal["remedy"]
        neighbour.acknowledged("target", 9)
    assert frames_of(site, visit.session_id) == (2 * FRAMES, 2 * FRAMES)
    assert frames_of(site, other.session_id) == (2 * FRAMES + 9, 2 * FRAMES + 9)


@pytest.mark.one_engine
def test_a_headset_reconnecting_after_a_withdrawal_is_refused(site: Site) -> None:
    """A headset that reconnects after a withdrawal is refused at its hello."""
    visit = make_visit(site, "gone-2")
    site.command(visit.session_id, "withdraw", reason="enough")
    with site.socket(visit.headset_token) as socket:
        socket.send(json.dumps(HELLO))
        assert json.loads(socket.recv(timeout=10.0))["code"] == "withdrawn"


@pytest.mark.one_engine
def test_an_aborted_session_accepts_its_headsets_backlog(site: Site) -> None:
    """A session that the lab aborted still stores the movement in its headset's journal."""
    visit = make_visit(site, "aborted-1")
    site.command(visit.session_id, "abort", reason="the headset failed")
    with site.headset(visit.headset_token) as headset:
        headset.say(message(standing(9), epoch=headset.epoch, seq_first=0))
        headset.acknowledged("target", 9)


@pytest.mark.one_engine
def test_the_tablet_shows_the_final_screen_after_a_withdrawal(site: Site) -> None:
    """After a withdrawal the tablet shows the final screen and its form is refused."""
    visit = make_visit(site, "gone-3")
    path = f"/api/sessions/{visit.session_id}"
    code = ok(site.operator.post(f"{path}/pairings", json={"device": "tablet"}))["code"]
    with site.server.client() as tablet:
        ok(tablet.post("/api/devices/pair", json={"code": code}))
        site.command(visit.session_id, "withdraw", reason="enough")
        assert ok(tablet.get("/api/tablet/state"))["screen"] == "finished"
        body = {
            "idempotency_key": key(),
            "administration": "form.demographics#1",
            "answers": {"age": 30},
            "shown_order": [],
            "seed": 1,
            "language": "en",
        }
        error(tablet.post("/api/tablet/submissions", json=body), 410, "withdrawn")
