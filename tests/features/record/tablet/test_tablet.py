"""Tests of what a tablet shows and does: its session's current step, and never the condition."""

import json
import re
from typing import Any

import pytest

from tests.features.lab import Json, Lab, error, ok


def state(tablet: Any) -> Json:
    """Return the screen that the tablet shows."""
    screen: Json = ok(tablet.get("/api/tablet/state"))
    return screen


def test_the_screen_follows_the_session(lab: Lab) -> None:
    """The tablet shows waiting, consent, form, instructions and the end as the session proceeds."""
    view = lab.join()
    tablet = lab.tablet(view["id"])
    screens = [state(tablet)["screen"]]
    view = lab.command(view, "start")
    for _ in range(4):
        screens.append(state(tablet)["screen"])
        view = lab.command(view, "skip", reason="not in this test")
    lab.command(view, "withdraw", reason="enough")
    screens.append(state(tablet)["screen"])
    assert screens == ["waiting", "consent", "form", "instructions", "waiting", "finished"]


@pytest.mark.one_engine
def test_a_repeated_acknowledgement_has_no_effect(lab: Lab) -> None:
    """A consent acknowledged twice completes its step once."""
    view = lab.command(lab.join(), "start")
    tablet = lab.tablet(view["id"])
    for _ in range(2):
        answer = ok(tablet.post("/api/tablet/acknowledge", json={"step_index": 0}))
        assert answer["screen"] == "form"
    events = [event["type"] for event in lab.events(view["id"])]
    assert events == ["session_started", "step_completed"]


@pytest.mark.one_engine
@pytest.mark.parametrize("step_index", [1, 3, 6, 500])
def test_a_tablet_acknowledges_only_consent_and_instructions(lab: Lab, step_index: int) -> None:
    """Only the consent and the instructions can be acknowledged from the tablet."""
    tablet = lab.tablet(lab.command(lab.join(), "start")["id"])
    answer = tablet.post("/api/tablet/acknowledge", json={"step_index": step_index})
    refusal = error(answer, 422, "invalid_input")
    assert refusal["valid"] == [0, 2]


@pytest.mark.one_engine
def test_a_tablet_cannot_acknowledge_a_later_step(lab: Lab) -> None:
    """A tablet cannot acknowledge instructions before they are due."""
    tablet = lab.tablet(lab.command(lab.join(), "start")["id"])
    error(tablet.post("/api/tablet/acknowledge", json={"step_index": 2}), 409, "not_now")


@pytest.mark.one_engine
def test_the_language_can_be_chosen(lab: Lab) -> None:
    """A tablet can change the language to one of the study's; any other is refused."""
    view = lab.command(lab.join(), "start")
    tablet = lab.tablet(view["id"])
    german = ok(tablet.put("/api/tablet/language", json={"language": "de"}))
    assert (german["language"], "Danke, dass Sie" in german["text"]) == ("de", True)
    refusal = error(
        tablet.put("/api/tablet/language", json={"language": "fr"}), 422, "invalid_input"
    )
    assert refusal["valid"] == ["en", "de"]


@pytest.mark.one_engine
def test_no_screen_reveals_the_condition(lab: Lab) -> None:
    """No screen of the tablet reveals the latency before the debriefing."""
    view = lab.command(lab.join(), "start")
    tablet = lab.tablet(view["id"])
    while view["status"] == "active":
        step = view["steps"][view["current"]["index"]]
        if step["kind"] != "debrief":
            shown = json.dumps({**state(tablet), "session_id": None, "administration": None})
            assert "latency" not in shown.lower()
            assert "125" not in shown
        view = lab.command(view, "skip", reason="not in this test")


def test_a_call_for_help_raises_an_alarm_until_answered(lab: Lab) -> None:
    """A call for help raises one critical alarm until the operator answers it."""
    view = lab.join()
    tablet = lab.tablet(view["id"])
    assert state(tablet)["help_asked"] is False
    for _ in range(2):
        assert ok(tablet.put("/api/tablet/help", json={"asked": True}))["help_asked"] is True
    (alarm,) = lab.view(view["id"])["alarms"]
    assert (alarm["code"], alarm["severity"]) == ("help_asked", "critical")
    ok(lab.operator.post(f"/api/sessions/{view['id']}/help/answered"))
    assert lab.view(view["id"])["alarms"] == []
    assert state(tablet)["help_asked"] is False
    (record,) = ok(lab.operator.get(f"/api/sessions/{view['id']}/alarms"))
    assert record["cleared_at"] is not None
    assert record["outcome"] == "The experimenter went to the participant."


@pytest.mark.one_engine
def test_a_call_can_be_taken_back(lab: Lab) -> None:
    """A call for help can be retracted; after the end of a session none can be made."""
    view = lab.join()
    tablet = lab.tablet(view["id"])
    ok(tablet.put("/api/tablet/help", json={"asked": True}))
    assert ok(tablet.put("/api/tablet/help", json={"asked": False}))["help_asked"] is False
    (record,) = ok(lab.operator.get(f"/api/sessions/{view['id']}/alarms"))
    assert record["outcome"] == "The participant no longer needs help."
    lab.command(lab.command(view, "start"), "abort", reason="enough")
    assert ok(tablet.put("/api/tablet/help", json={"asked": True}))["help_asked"] is False
    assert len(ok(lab.operator.get(f"/api/sessions/{view['id']}/alarms"))) == 1


@pytest.mark.one_engine
def test_an_unpaired_tablet_can_query_its_pairing(lab: Lab) -> None:
    """An unpaired tablet gets an empty state without an error; a paired one gets its screen."""
    view = lab.join()
    assert ok(lab.stranger().get("/api/tablet/paired")) == {"state": None}
    tablet = lab.tablet(view["id"])
    assert ok(tablet.get("/api/tablet/paired"))["state"] == state(tablet)
    (device,) = lab.view(view["id"])["devices"]
    lab.operator.delete(f"/api/sessions/{view['id']}/devices/{device['id']}")
    assert ok(tablet.get("/api/tablet/paired")) == {"state": None}


@pytest.mark.one_engine
def test_the_page_brings_its_first_screen(lab: Lab) -> None:
    """A paired tablet's page contains its screen and is kept nowhere; a stranger's has none."""
    view = lab.join()
    plain = lab.stranger().get("/tablet")
    assert plain.headers["cache-control"] == "no-cache"
    assert _in_page(plain) is None
    tablet = lab.tablet(view["id"])
    page = tablet.get("/tablet")
    assert page.headers["cache-control"] == "no-store"
    assert _in_page(page) == {"state": state(tablet)}
    assert 'rel="preload"' not in page.text
    (device,) = lab.view(view["id"])["devices"]
    lab.operator.delete(f"/api/sessions/{view['id']}/devices/{device['id']}")
    assert _in_page(tablet.get("/tablet")) == {"state": None}


def _in_page(page: Any) -> Json | None:
    """Return what the server has written into a page, as the page reads it."""
    found = re.search(
        r'<script type="application/json" id="first-answer">([^<]*)</script>', page.text
    )
    return None if found is None else json.loads(found[1])
