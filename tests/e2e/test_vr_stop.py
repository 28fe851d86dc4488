"""Browser test of a stop inside the headset, and of a task that is refused there."""

import re
from pathlib import Path
from typing import Any

import pytest

from tests.features.lab import error
from tests.features.record.headset.site import Site
from tests.protocol.helpers import STUDY as FILE
from tests.support.browser import ContextFactory
from tests.support.vr_visit import WornHeadset, begun, journey_script, ok

STUDY = "headset-stop"
HOLD_FRAMES = 100
"""A little more than the second for which a stop is held."""


def study() -> str:
    """Return the shipped study with a long free movement and short preparations."""
    text = FILE.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
    return re.sub(r"(preparation_s|freeze_s): 5", r"\1: 0.3", text)


@pytest.fixture
def visit_script(tmp_path: Path) -> Path:
    """Provide the emulated headset and its wearer as one script."""
    return journey_script(tmp_path)


def until(headset: WornHeadset, condition: str) -> None:
    """Draw frames until a condition of the page is true."""
    for _ in range(200):
        headset.step(5)
        if headset.tell(condition):
            return
        headset.page.wait_for_timeout(20)
    raise AssertionError(f"never: {condition}; {headset.tell('reembody.panel')}")


def test_a_participant_stops_and_a_foot_task_without_feet_is_refused(
    headset_site: Site, new_context: ContextFactory, visit_script: Path
) -> None:
    """Both grips held for a second alarm and pause; feet that nothing measures refuse the task."""
    server, operator = headset_site.server, headset_site.operator
    ok(operator.post("/api/studies", json={"yaml": study()}))
    context = new_context((960, 480))
    visit, tablet = begun(operator, context, visit_script, server.url, STUDY, time_scale=10.0)
    headset = visit.headset

    def is_roaming(view: dict[str, Any]) -> bool:
        return view["current"] is not None and view["current"]["status"] == "running"

    with tablet:
        visit.perform(until=is_roaming)
        until(headset, "reembody.panel.wanted.kind === 'nothing'")
        recorded = headset.tell("reembody.recorded")
        headset.do("journey.grip(true)")
        headset.step(HOLD_FRAMES)
        headset.do("journey.grip(false)")
        until(headset, "reembody.panel.screen?.key === 'pause told'")
        assert headset.tell("reembody.recorded") > recorded + HOLD_FRAMES
        view = visit.view()
        assert "stop_asked" in [alarm["code"] for alarm in view["alarms"]]
        assert view["current"]["status"] == "paused"
        visit.command(view, "resume")
        until(headset, "reembody.panel.wanted.kind === 'nothing'")
        assert "stop_asked" not in [alarm["code"] for alarm in visit.view()["alarms"]]

        headset.do("journey.takeShinsOff()")
        # One look for both: a step that ended in between must not cost the next one.
        view = visit.view()
        while view["steps"][view["current"]["index"]]["key"] != "block1.foot":
            visit.command(view, "skip", reason="not in this test")
            view = visit.view()
        until(headset, "reembody.panel.wanted.kind === 'feet'")
        assert "feet are not measured" in headset.tell("reembody.panel.screen.problem")
        body = {
            "command_id": "a-foot-task-without-feet",
            "expected_version": visit.view()["version"],
            "type": "begin_phase",
        }
        path = f"/api/sessions/{visit.session_id}/commands"
        refused = error(operator.post(path, json=body), 409, "not_now")
        assert "does not measure" in refused["message"]
