"""Tests that stopping a session succeeds in spite of simultaneous notes and reports."""

import threading
import uuid
from concurrent.futures import ThreadPoolExecutor

import pytest
from httpx2 import Response

from app.features.record.sessions.engine.commands import Report
from app.features.record.sessions.service import apply_command
from app.platform.access import session_by_id
from tests.faults.figures import note
from tests.features.lab import Json, Lab, error, ok

THREADS = 50


def command(lab: Lab, view: Json, kind: str, **fields: object) -> Response:
    """Send a command based on the given view of the session."""
    body = {
        "command_id": str(uuid.uuid4()),
        "expected_version": view["version"],
        "type": kind,
        **fields,
    }
    return lab.operator.post(f"/api/sessions/{view['id']}/commands", json=body)


@pytest.mark.parametrize("kind", ["abort", "withdraw"])
def test_a_stop_succeeds_at_the_first_try(lab: Lab, kind: str) -> None:
    """One stop among 50 simultaneous commands on a session succeeds at the first try."""
    view = lab.command(lab.join(kind="test"), "start")
    together = threading.Barrier(THREADS)

    def act(number: int) -> Response:
        together.wait()
        if number == THREADS // 2:
            return command(lab, view, kind, reason="the participant feels sick")
        if number % 10 == 0:
            return command(lab, view, "skip", reason="somebody else is quicker")
        return command(lab, view, "note", text=f"note {number}")

    with ThreadPoolExecutor(THREADS) as pool:
        answers = list(pool.map(act, range(THREADS)))
    stopped = answers[THREADS // 2]
    tries = 1 if stopped.is_success else 0
    note(25, f"{kind} against 49 others on one session", "ended at the first try", tries)
    assert ok(stopped)["status"] in ("aborted", "withdrawn")
    assert not [answer for answer in answers if answer.status_code >= 500]
    ends = [one for one in lab.events(view["id"]) if one["type"] == "session_ended"]
    assert len(ends) == 1


@pytest.mark.parametrize("kind", ["abort", "withdraw"])
def test_a_stop_needs_no_current_version(lab: Lab, kind: str) -> None:
    """Aborting or withdrawing needs only a reason: the version may be missing or outdated."""
    for version in ({}, {"expected_version": 0}):
        view = lab.command(lab.join(kind="test"), "start")
        lab.command(view, "note", text="written meanwhile")
        body = {"command_id": str(uuid.uuid4()), "type": kind, "reason": "enough", **version}
        after = ok(lab.operator.post(f"/api/sessions/{view['id']}/commands", json=body))
        assert after["status"] in ("aborted", "withdrawn")


def test_a_skip_needs_the_newest_version(lab: Lab) -> None:
    """A skip is rejected if it is based on an outdated version or has no version."""
    view = lab.command(lab.join(kind="test"), "start")
    lab.command(view, "note", text="written meanwhile")
    error(command(lab, view, "skip", reason="late"), 409, "stale")
    body = {"command_id": str(uuid.uuid4()), "type": "skip", "reason": "late"}
    refused = lab.operator.post(f"/api/sessions/{view['id']}/commands", json=body)
    assert "expected_version" in str(error(refused, 422, "invalid_input"))


def test_a_pause_is_accepted_on_any_version(lab: Lab) -> None:
    """A pause is accepted on an outdated version, so that a note does not delay it."""
    view = lab.skip_to(lab.join(kind="test"), "free_roam")
    lab.context.hub.headset_joined(view["id"])
    view = lab.command(view, "begin_phase")
    with lab.database.writing() as db:
        session = session_by_id(db, view["id"], lock=True)
        started = Report(what="started", phase_id=1, client_t_s=1.0, active_s=0.0)
        apply_command(db, lab.context, session, started, actor="headset")
    lab.command(lab.view(view["id"]), "note", text="written meanwhile")
    assert ok(command(lab, view, "pause"))["current"]["pausing"] is True
