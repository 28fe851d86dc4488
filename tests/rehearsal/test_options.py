"""Tests of a rehearsal with practice, a signed consent and a met stop rule."""

import asyncio
import re
from pathlib import Path

from app.rehearsal.rehearse import RehearsalPlan, RehearsalReport, rehearse
from tests.features.lab import ok
from tests.protocol.options import KEY, with_options
from tests.support.server import ADMIN_PASSWORD, LiveServer

SPEED = 12.0


def short() -> str:
    """Return a study with short tasks after a full practice and a stop rule that is always met."""
    text = with_options(("stop_at: 15, warn_at: 10", "stop_at: 1"))
    text = text.replace("duration_s: 120", "duration_s: 2")
    text = re.sub("duration_s: 60", "duration_s: 3", text)
    text = re.sub("duration_s: 30", "duration_s: 120", text)
    return re.sub(r"(preparation_s|freeze_s): 5", r"\1: 0.5", text)


def test_a_study_with_every_option_is_rehearsed(tmp_path: Path) -> None:
    """With every option in a study, two completions end the practice and consent is signed.

    The operator continues after the stop rule.
    """
    with LiveServer(tmp_path) as server, server.client() as api:
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        ok(api.post("/api/studies", json={"yaml": short()}))
        plan = RehearsalPlan(
            url=server.url, study=KEY, speed=SPEED, seed=3, password=ADMIN_PASSWORD
        )
        report: RehearsalReport = asyncio.run(rehearse(plan))
        session = f"/api/sessions/{report.session_id}"
        view, events = ok(api.get(session)), ok(api.get(f"{session}/events"))
        consent = ok(api.get(f"{session}/consent"))
    assert view["status"] == "completed"
    kinds = [phase["kind"] for phase in report.phases]
    assert kinds == ["practice", "free_roam", *["task"] * 6]
    practice = report.phases[0]
    assert (practice["status"], practice["completions"]) == ("done", 2)
    assert 0.0 < practice["active_s"] < 119.0
    assert (consent["mode"], consent["simulated"]) == ("tablet", True)
    assert consent["signature"].startswith("M")
    assert [line["ticked"] for line in consent["statements"]] == [True, True, False]
    types = [event["type"] for event in events]
    assert types.count("stop_rule_met") == types.count("stop_rule_overridden") > 0
