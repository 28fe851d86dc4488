"""Browser test of a whole visit in the headset's page: from pairing to the debriefing."""

import re
from pathlib import Path

import pytest
from sqlalchemy import select

from app.models import ClientReport
from tests.features.record.headset.site import Site
from tests.protocol.helpers import SHIPPED, loaded
from tests.support.browser import ContextFactory
from tests.support.vr_rules import derived, stored
from tests.support.vr_visit import QUICK, SPAN_BY_STATURE, begun, journey_script, ok

STUDY = "headset-visit"
GOALS_WITHOUT_A_WAIST, MOST_ERROR_CM = 5, 3.0


def short_study() -> str:
    """Return the shipped study with its physics avatar and phases of a few seconds."""
    text = SHIPPED.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
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
    """A wearer who follows the page is calibrated, completes tasks, and all of it is stored.

    The rules in Python make the same contacts and completions of what the body touched.
    """
    server, operator = headset_site.server, headset_site.operator
    ok(operator.post("/api/studies", json={"yaml": short_study()}))
    visit, tablet = begun(
        operator,
        new_context(),
        visit_script,
        server.url,
        STUDY,
        time_scale=10.0,
        traits=QUICK,
    )
    with tablet:
        view = visit.perform()
    assert tablet.error is None
    assert view["status"] == "completed"
    done = [(one["kind"], one["limb"], one["status"]) for one in view["phases"]]
    blocks = [("task", "hand", "done"), ("task", "foot", "done")] * 3
    assert done == [("free_roam", None, "done"), *blocks]
    hands = [one["completions"] for one in view["phases"] if one["limb"] == "hand"]
    assert sum(hands) >= 1
    measured = view["calibration"]
    assert (measured["cause"], measured["notices"]) == ("first", ["waist_inferred"])
    assert abs(measured["stature_m"] - visit.person.stature_m) < 0.01
    assert abs(measured["span_m"] - SPAN_BY_STATURE * visit.person.stature_m) < 0.02
    assert len(measured["residuals_cm"]) == GOALS_WITHOUT_A_WAIST
    assert max(measured["residuals_cm"].values()) <= MOST_ERROR_CM
    receipt = ok(operator.get(f"/api/sessions/{visit.session_id}/receipt"))
    assert receipt["problems"] == []
    for one in receipt["achieved_latency"]:
        # The worker's frame is taken off a latency, but cannot be taken off none.
        assert one["headset_added_ms"] > 0.0
        taken_off_ms = one["headset_added_ms"] if one["latency_ms"] > 0.0 else 0.0
        assert one["headset_compensated_ms"] == taken_off_ms
    inputs = visit.headset.tell("journey.rules")
    with headset_site.database.reading() as db:
        reported = stored(db, visit.session_id)
        own = select(ClientReport).filter_by(session_id=visit.session_id, type="call")
        told = list(db.scalars(own))
    assert told == [], "no movement of a task is a stop"
    assert derived(inputs, loaded(short_study()).protocol.tasks) == reported
