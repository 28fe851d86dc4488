"""Tests of the scripted participant: refusals, readable failures, and one at a time."""

import time

import pytest

from app.features.record.tryout.runner import TryoutRunner
from app.models import Account, LoginToken
from app.platform.access import Caller
from app.platform.tokens import hash_token
from tests.features.lab import STUDY, Json, Lab, error, ok

WITHIN_S = 60.0
NOBODY = "http://127.0.0.1:9"


def _until_over(desk: TryoutRunner, caller: Caller) -> Json:
    give_up_s = time.monotonic() + WITHIN_S
    while True:
        view = desk.newest(caller)
        assert view is not None
        if view.state not in ("starting", "running"):
            return view.model_dump()
        assert time.monotonic() < give_up_s, f"it is still {view.state}"
        time.sleep(0.05)


@pytest.mark.one_engine
def test_a_failed_tryout_reports_why_and_revokes_its_login(fresh_lab: Lab) -> None:
    """A scripted participant without a reachable server fails with a reason and is logged out."""
    lab = fresh_lab
    assert ok(lab.operator.get("/api/tryout")) is None
    error(lab.operator.delete("/api/tryout"), 404, "not_found")
    request = {"language": "fr"}
    error(lab.operator.post(f"/api/studies/{STUDY}/tryout", json=request), 422, "invalid_input")
    with lab.database.reading() as db:
        account = db.query(Account).filter_by(username="admin").one()
    caller = Caller(account.id, account.username, account.role)
    desk = lab.context.part(TryoutRunner)
    desk.begin(caller, STUDY, "en", NOBODY)
    repeated = lab.operator.post(f"/api/studies/{STUDY}/tryout", json={"language": "en"})
    refusal = error(repeated, 409, "conflict")
    assert "one at a time" in refusal["valid"]
    view = _until_over(desk, caller)
    assert view["state"] == "failed"
    assert NOBODY in view["trouble"]["message"]
    assert view["trouble"]["remedy"]
    assert ok(lab.operator.get("/api/tryout"))["state"] == "failed"
    assert desk._newest is not None
    token = hash_token(desk._newest.token)
    give_up_s = time.monotonic() + WITHIN_S
    while time.monotonic() < give_up_s:
        with lab.database.reading() as db:
            if db.get_one(LoginToken, token).revoked_at is not None:
                return
        time.sleep(0.05)
    raise AssertionError("its login was not revoked")
