"""Browser test of a whole visit in the headset's page: from pairing to the debriefing."""

import re
from pathlib import Path

import pytest

from tests.features.record.headset.site import Site
from tests.protocol.helpers import STUDY as FILE
from tests.support.browser import ContextFactory
from tests.support.vr_visit import begun, journey_script, ok

STUDY = "headset-visit"


def short_study() -> str:
    """Return the shipped study with its physics avatar and phases of a few seconds."""
    text = FILE.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
    text = text.replace("duration_s: 120", "duration_s: 1")
    text = text.replace("duration_s: 60", "duration_s: 9", 1).replace(
        "duration_s: 60", "duration_s: 6"
    )
    return re.sub(r"(preparation_s|freeze_s): 5", r"\1: 0.3", text)


@pytest.fixture
def visit_script(tmp_path: Path) -> Path:
    """Provide the emulated headset and its wearer as one script."""
    return journey_script(tmp_path)


def test_a_visit_from_pairing_to_debriefing(
    headset_site: Site, new_context: ContextFactory, visit_script: Path
) -> None:
    """A wearer who only follows the page completes tasks, and all that the page made is stored."""
    server, operator = headset_site.server, headset_site.operator
    ok(operator.post("/api/studies", json={"yaml": short_study()}))
    visit, tablet = begun(operator, new_context(), visit_script, server.url, STUDY, time_scale=10.0)
    with tablet:
        view = visit.perform()
    assert tablet.error is None
    assert view["status"] == "completed"
    done = [(one["kind"], one["limb"], one["status"]) for one in view["phases"]]
    blocks = [("task", "hand", "done"), ("task", "foot", "done")] * 3
    assert done == [("free_roam", None, "done"), *blocks]
    hands = [one["completions"] for one in view["phases"] if one["limb"] == "hand"]
    assert sum(hands) >= 1
    receipt = ok(operator.get(f"/api/sessions/{visit.session_id}/receipt"))
    assert receipt["problems"] == []
