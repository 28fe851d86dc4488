"""Tests of a participant's refusal or question, on tablet and console and in the record."""

import uuid
from typing import Any

import pytest

from app.features.record.telemetry.recovery import stop_running_clocks
from tests.features.lab import STUDY, Json, Lab, error, ok

REASON = "Refused consent"


def refusal_request(*, refused: bool = True, step_index: int = 0) -> Json:
    """Return the request that one press on the tablet sends."""
    return {"wish_id": str(uuid.uuid4()), "step_index": step_index, "refused": refused}


def send_refusal(tablet: Any, body: Json) -> Json:
    """Send a refusal request and return the tablet's screen after it."""
    screen: Json = ok(tablet.put("/api/tablet/refusal", json=body))
    return screen


def at_consent(lab: Lab, **fields: Any) -> tuple[Json, Any]:
    """Return a session at its consent, and its tablet."""
    view = lab.command(lab.join(**fields), "start")
    return view, lab.tablet(view["id"])


def codes(view: Json) -> dict[str, str]:
    """Return the severity of each open alarm by code."""
    return {one["code"]: one["severity"] for one in view["alarms"]}


def types(lab: Lab, view: Json) -> list[str]:
    """Return the event types of a session."""
    return [one["type"] for one in lab.events(view["id"])]


def test_a_refusal_reaches_the_operator_and_holds_the_session(lab: Lab) -> None:
    """A refusal raises an alarm, is recorded and holds the session; the tablet asks no more."""
    view, tablet = at_consent(lab)
    screen = send_refusal(tablet, refusal_request())
    assert (screen["screen"], screen["is_refused"]) == ("refused", True)
    assert (screen["text"], screen["consent"], screen["next"]) == (None, None, None)
    now = lab.view(view["id"])
    assert codes(now) == {"consent_refused": "critical"}
    assert now["refusal"]["step"] == 0
    assert now["refusal"]["at"] == now["alarms"][0]["since"]
    assert now["allowed"] == ["withdraw", "reopen_consent", "abort", "note"]
    (event,) = [one for one in lab.events(view["id"]) if one["type"] == "consent_refused"]
    assert event["by"].startswith("tablet:")
    assert event["data"] == {"step": 0, "by": "tablet"}


@pytest.mark.one_engine
def test_a_refused_session_cannot_be_continued(lab: Lab) -> None:
    """After a refusal neither the operator nor another page of the tablet can continue."""
    view, tablet = at_consent(lab)
    send_refusal(tablet, refusal_request())
    now = lab.view(view["id"])
    sheet = {"place": "Folder A", "reason": "They agreed after all"}
    for kind, fields in (
        ("complete_step", {"paper_consent": sheet}),
        ("skip", {"reason": "go on"}),
        ("redo", {"reason": "go on", "step_index": 0}),
    ):
        refusal = error(lab.try_command(now, kind, **fields), 409, "not_now")
        assert "does not want to take part" in refusal["message"]
    agreed = tablet.post("/api/tablet/consent", json={"step_index": 0})
    assert "reopen_consent" in error(agreed, 409, "not_now")["valid"]
    assert lab.view(view["id"])["version"] == now["version"]
    assert ok(lab.operator.get(f"/api/sessions/{view['id']}/consent")) is None


@pytest.mark.one_engine
def test_ending_a_refused_session_frees_its_slot(fresh_lab: Lab) -> None:
    """Ending a refused session frees its slot, and the tablet shows no debriefing."""
    view, tablet = at_consent(fresh_lab)
    send_refusal(tablet, refusal_request())
    ended = fresh_lab.command(fresh_lab.view(view["id"]), "withdraw", reason=REASON)
    assert (ended["status"], ended["refusal"], ended["alarms"]) == ("withdrawn", None, [])
    screen = ok(tablet.get("/api/tablet/state"))
    assert (screen["screen"], screen["is_refused"], screen["text"]) == ("finished", True, None)
    assert fresh_lab.join()["slot"] == view["slot"]
    sessions = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}/sessions"))
    assert [one["status"] for one in sessions] == ["planned", "withdrawn"]


def test_a_repeated_refusal_request_counts_once(lab: Lab) -> None:
    """A repeated refusal request counts once, even if it arrives after the retraction."""
    view, tablet = at_consent(lab)
    first, back = refusal_request(), refusal_request(refused=False)
    for body in (first, first, back, first, back):
        screen = send_refusal(tablet, body)
    assert screen["screen"] == "consent"
    assert types(lab, view) == ["session_started", "consent_refused", "refusal_retracted"]
    assert codes(lab.view(view["id"])) == {"refusal_retracted": "warning"}


@pytest.mark.one_engine
def test_a_participant_who_retracts_a_refusal_may_consent(lab: Lab) -> None:
    """A participant who retracts the refusal sees the consent and may give it."""
    view, tablet = at_consent(lab)
    send_refusal(tablet, refusal_request())
    screen = send_refusal(tablet, refusal_request(refused=False))
    assert (screen["screen"], screen["is_refused"]) == ("consent", False)
    assert lab.view(view["id"])["allowed"][0] == "complete_step"
    ok(tablet.post("/api/tablet/consent", json={"step_index": 0}))
    after = lab.view(view["id"])
    assert (after["current"]["index"], after["alarms"]) == (1, [])
    history = ok(lab.operator.get(f"/api/sessions/{view['id']}/alarms"))
    assert {one["code"]: one["outcome"] for one in history} == {
        "consent_refused": "the participant took the refusal back on the tablet",
        "refusal_retracted": "the participant has agreed or the consent was skipped",
    }


@pytest.mark.one_engine
def test_the_operator_reopens_the_consent_with_a_reason(lab: Lab) -> None:
    """The operator may reopen a refused consent with a reason; this does not give the consent."""
    view, tablet = at_consent(lab)
    error(lab.try_command(view, "reopen_consent", reason="again"), 409, "not_now")
    send_refusal(tablet, refusal_request())
    now = lab.view(view["id"])
    error(lab.try_command(now, "reopen_consent"), 422, "invalid_input")
    after = lab.command(now, "reopen_consent", reason="The participant changed their mind")
    assert (after["refusal"], after["alarms"], after["current"]["index"]) == (None, [], 0)
    assert ok(tablet.get("/api/tablet/state"))["screen"] == "consent"
    (event,) = [one for one in lab.events(view["id"]) if one["type"] == "refusal_retracted"]
    assert event["data"]["by"] == "operator"
    assert event["data"]["content_id"]


@pytest.mark.one_engine
def test_another_tablet_shows_the_refusal(lab: Lab) -> None:
    """Another tablet of the session shows the refusal and may retract it."""
    view, tablet = at_consent(lab)
    send_refusal(tablet, refusal_request())
    other = lab.tablet(view["id"])
    assert ok(other.get("/api/tablet/state"))["screen"] == "refused"
    assert send_refusal(other, refusal_request())["screen"] == "refused"
    assert send_refusal(other, refusal_request(refused=False))["screen"] == "consent"
    assert types(lab, view).count("consent_refused") == 1


@pytest.mark.one_engine
def test_a_late_refusal_holds_the_session_at_its_current_step(lab: Lab) -> None:
    """A refusal that arrives after a consent on paper holds the session at its current step."""
    view, tablet = at_consent(lab)
    sheet = {"place": "Folder A", "reason": "The tablet is offline"}
    lab.command(view, "complete_step", paper_consent=sheet)
    form = ok(tablet.get("/api/tablet/state"))["administration"]
    assert send_refusal(tablet, refusal_request())["screen"] == "refused"
    now = lab.view(view["id"])
    assert (now["current"]["index"], codes(now)) == (1, {"consent_refused": "critical"})
    filled_in = {
        "idempotency_key": uuid.uuid4().hex,
        "administration": form["key"],
        "answers": {},
        "shown_order": form["item_order"],
        "seed": form["seed"],
        "language": "en",
    }
    answer = tablet.post("/api/tablet/submissions", json=filled_in)
    assert answer.status_code in (409, 422)
    assert ok(lab.operator.get(f"/api/sessions/{view['id']}/answers")) == []


def test_a_server_restart_keeps_refusals_and_questions(fresh_lab: Lab) -> None:
    """A restart of the server keeps the alarms of a refusal and a question."""
    view, tablet = at_consent(fresh_lab)
    ok(tablet.put("/api/tablet/question", json={"asked": True}))
    send_refusal(tablet, refusal_request())
    stop_running_clocks(fresh_lab.context)
    after = fresh_lab.view(view["id"])
    assert after["refusal"] is not None
    assert codes(after) == {"consent_refused": "critical", "question_asked": "critical"}


@pytest.mark.one_engine
def test_a_blinded_operator_sees_the_refusal(fresh_lab: Lab) -> None:
    """A blinded operator sees a refusal, which reveals nothing about the condition."""
    yaml = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}"))["yaml"]
    blinded = yaml.replace("operator: false", "operator: true")
    ok(fresh_lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": blinded}))
    view, tablet = at_consent(fresh_lab)
    send_refusal(tablet, refusal_request())
    now = fresh_lab.view(view["id"])
    assert (now["blinded"], codes(now)) == (True, {"consent_refused": "critical"})
    assert now["refusal"]["step"] == 0


@pytest.mark.one_engine
def test_a_refusal_after_the_end_is_not_accepted(lab: Lab) -> None:
    """A refusal after the end of a session is not accepted, and the tablet shows the end."""
    view, tablet = at_consent(lab)
    lab.command(view, "abort", reason="fire alarm")
    error(tablet.put("/api/tablet/refusal", json=refusal_request()), 409, "not_now")
    assert ok(tablet.get("/api/tablet/state"))["screen"] == "finished"


@pytest.mark.one_engine
def test_only_a_consent_can_be_refused(lab: Lab) -> None:
    """A refusal of a step that is not a consent is not accepted."""
    view, tablet = at_consent(lab)
    refusal = error(
        tablet.put("/api/tablet/refusal", json=refusal_request(step_index=1)), 409, "not_now"
    )
    assert (refusal["value"], refusal["valid"]) == (1, [0])
    assert lab.view(view["id"])["version"] == view["version"]


@pytest.mark.one_engine
def test_a_question_raises_an_alarm_until_it_is_answered(lab: Lab) -> None:
    """A question raises an alarm and is recorded once, until the operator answers it."""
    view, tablet = at_consent(lab)
    for _ in range(2):
        screen = ok(tablet.put("/api/tablet/question", json={"asked": True}))
        assert (screen["question_asked"], screen["help_asked"]) == (True, False)
    assert codes(lab.view(view["id"])) == {"question_asked": "critical"}
    ok(lab.operator.post(f"/api/sessions/{view['id']}/help/answered"))
    assert lab.view(view["id"])["alarms"] == []
    assert ok(tablet.get("/api/tablet/state"))["question_asked"] is False
    log = [(one["type"], one["data"], one["by"]) for one in lab.events(view["id"])][1:]
    assert [one[:2] for one in log] == [
        ("question_asked", {"step": 0}),
        ("question_closed", {"outcome": "answered"}),
    ]
    assert (log[0][2].split(":")[0], log[1][2]) == ("tablet", "account:admin")
    (record,) = ok(lab.operator.get(f"/api/sessions/{view['id']}/alarms"))
    assert record["outcome"] == "The experimenter went to the participant."


@pytest.mark.one_engine
def test_a_question_can_be_taken_back(lab: Lab) -> None:
    """A question can be retracted; after the end of a session none can be asked."""
    view, tablet = at_consent(lab)
    ok(tablet.put("/api/tablet/question", json={"asked": True}))
    back = ok(tablet.put("/api/tablet/question", json={"asked": False}))
    assert back["question_asked"] is False
    assert lab.events(view["id"])[-1]["data"] == {"outcome": "taken_back"}
    lab.command(lab.view(view["id"]), "abort", reason="enough")
    assert ok(tablet.put("/api/tablet/question", json={"asked": True}))["question_asked"] is False
    ok(lab.operator.post(f"/api/sessions/{view['id']}/help/answered"))
    assert types(lab, view)[-1] == "session_ended"


@pytest.mark.one_engine
def test_a_steps_own_text_has_its_own_title(lab: Lab) -> None:
    """A step's own text has its own title, unlike the study's text for waiting."""
    view = lab.join()
    tablet = lab.tablet(view["id"])
    assert ok(tablet.get("/api/tablet/state"))["is_own_text"] is False
    view = lab.skip_to(view, "debrief")
    screen = ok(tablet.get("/api/tablet/state"))
    assert (screen["screen"], screen["is_own_text"]) == ("waiting", True)
    assert screen["title"] == "Debriefing"
