"""What a tablet shows and does: its own session's step, and nothing of the condition."""

import json
from typing import Any

import pytest

from tests.features.lab import Json, Lab, error, ok


def state(tablet: Any) -> Json:
    """The screen."""
    screen: Json = ok(tablet.get("/api/tablet/state"))
    return screen


def test_the_screen_follows_the_session(lab: Lab) -> None:
    """Waiting, consent, form, instructions, waiting, finished."""
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
def test_acknowledging_twice_does_no_harm(lab: Lab) -> None:
    """Consent sent again after a lost answer leaves the session where it is."""
    view = lab.command(lab.join(), "start")
    tablet = lab.tablet(view["id"])
    for _ in range(2):
        answer = ok(tablet.post("/api/tablet/acknowledge", json={"step_index": 0}))
        assert answer["screen"] == "form"
    events = [event["type"] for event in lab.events(view["id"])]
    assert events == ["session_started", "step_completed"]


@pytest.mark.one_engine
@pytest.mark.parametrize("step_index", [1, 3, 6, 500])
def test_a_tablet_completes_only_what_is_its_own(lab: Lab, step_index: int) -> None:
    """Forms, heights and phases cannot be acknowledged."""
    tablet = lab.tablet(lab.command(lab.join(), "start")["id"])
    answer = tablet.post("/api/tablet/acknowledge", json={"step_index": step_index})
    refusal = error(answer, 422, "invalid_input")
    assert refusal["valid"] == [0, 2]


@pytest.mark.one_engine
def test_a_tablet_cannot_run_ahead(lab: Lab) -> None:
    """Instructions are acknowledged when they are due, not before."""
    tablet = lab.tablet(lab.command(lab.join(), "start")["id"])
    error(tablet.post("/api/tablet/acknowledge", json={"step_index": 2}), 409, "not_now")


@pytest.mark.one_engine
def test_the_language_can_be_chosen(lab: Lab) -> None:
    """The screen answers in it; a language without texts is refused."""
    view = lab.command(lab.join(), "start")
    tablet = lab.tablet(view["id"])
    german = ok(tablet.put("/api/tablet/language", json={"language": "de"}))
    assert (german["language"], "Danke, dass Sie" in german["text"]) == ("de", True)
    refusal = error(
        tablet.put("/api/tablet/language", json={"language": "fr"}), 422, "invalid_input"
    )
    assert refusal["valid"] == ["en", "de"]


@pytest.mark.one_engine
def test_no_screen_tells_the_condition(lab: Lab) -> None:
    """Neither latency nor order reaches the participant before the debriefing."""
    view = lab.command(lab.join(), "start")
    tablet = lab.tablet(view["id"])
    while view["status"] == "active":
        step = view["steps"][view["current"]["index"]]
        if step["kind"] != "debrief":
            shown = json.dumps({**state(tablet), "session_id": None, "administration": None})
            assert "latency" not in shown.lower()
            assert "125" not in shown
        view = lab.command(view, "skip", reason="not in this test")


def test_a_call_stands_until_it_is_answered(lab: Lab) -> None:
    """The operator sees an alarm once, the tablet that it has arrived and that somebody came."""
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
    """Both are on record; an ended session has nobody to call."""
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
def test_an_unpaired_tablet_may_ask_whether_it_is_paired(lab: Lab) -> None:
    """No error, no screen; a paired one gets its screen at once, an unpaired one none again."""
    view = lab.join()
    assert ok(lab.stranger().get("/api/tablet/paired")) == {"state": None}
    tablet = lab.tablet(view["id"])
    assert ok(tablet.get("/api/tablet/paired"))["state"] == state(tablet)
    (device,) = lab.view(view["id"])["devices"]
    lab.operator.delete(f"/api/sessions/{view['id']}/devices/{device['id']}")
    assert ok(tablet.get("/api/tablet/paired")) == {"state": None}
