"""Tests of stop rules on both engines: their effect on console, tablet and record."""

import pytest

from app.features.record.telemetry.recovery import stop_running_clocks
from tests.features.lab import Json, Lab, error, ok
from tests.features.record.sessions.options_lab import FMS, answer_fms, joined


def answered(lab: Lab, value: int | None, step: str = FMS) -> Json:
    """Return a session after a sickness rating at the end of its first block."""
    view = lab.skip_to(joined(lab), step)
    ok(answer_fms(lab, view["id"], value))
    return lab.view(view["id"])


def alarms(view: Json) -> dict[str, str]:
    """Return the severity of each open alarm by code."""
    return {one["code"]: one["severity"] for one in view["alarms"]}


@pytest.mark.one_engine
def test_a_rating_below_every_limit_has_no_effect(lab: Lab) -> None:
    """A rating below every limit raises no alarm and does not hold the session."""
    view = answered(lab, 9)
    assert (view["held"], alarms(view)) == (None, {})
    assert "begin_phase" in view["allowed"]


@pytest.mark.one_engine
def test_a_rating_at_the_warning_limit_raises_a_warning(lab: Lab) -> None:
    """A rating at the warning limit raises a warning, which a lower rating clears."""
    view = answered(lab, 10)
    assert (view["held"], alarms(view)) == (None, {"stop_rule_near": "warning"})
    assert "begin_phase" in view["allowed"]
    view = lab.skip_to(view, "block2.fms")
    ok(answer_fms(lab, view["id"], 3))
    assert alarms(lab.view(view["id"])) == {}


def test_a_rating_at_the_stop_limit_holds_the_session(lab: Lab) -> None:
    """A rating at the stop limit holds the session with a critical alarm; the tablet is neutral."""
    view = answered(lab, 15)
    assert view["held"] == {
        "rule": 0,
        "instrument": "How are you? (FMS)",
        "score": "Motion sickness",
        "stop_at": 15.0,
        "is_rise": False,
    }
    assert alarms(view) == {"stop_rule_met": "critical"}
    assert view["allowed"] == ["abort", "withdraw", "override_stop", "note"]
    tablet = ok(lab.tablet(view["id"]).get("/api/tablet/state"))
    assert (tablet["screen"], tablet["text"], tablet["next"]) == ("held", None, None)
    assert tablet["administration"] is None


@pytest.mark.one_engine
def test_a_held_session_refuses_to_continue_with_a_remedy(lab: Lab) -> None:
    """A held session refuses every command that continues it, with advice."""
    view = answered(lab, 20)
    for kind in ("begin_phase", "complete_step", "resume", "materialise", "skip", "redo"):
        refusal = error(lab.try_command(view, kind, reason="go"), 409, "not_now")
        assert "stop rule" in refusal["message"]
        assert "Then end the session, or continue with a reason." in refusal["remedy"]
    assert lab.view(view["id"])["version"] == view["version"]


def test_overriding_a_stop_rule_needs_a_reason_and_is_recorded(lab: Lab) -> None:
    """Overriding a stop rule needs a reason, clears the alarm and is recorded."""
    view = answered(lab, 17)
    error(lab.try_command(view, "override_stop"), 422, "invalid_input")
    view = lab.command(view, "override_stop", reason="Sat down, feels well again")
    assert (view["held"], alarms(view)) == (None, {})
    assert "begin_phase" in view["allowed"]
    events = lab.events(view["id"])
    met = next(one for one in events if one["type"] == "stop_rule_met")
    assert set(met["data"]) == {"rule", "submission_id"}
    assert events[-1]["type"] == "stop_rule_overridden"
    assert events[-1]["data"]["content_id"]
    assert 17 not in [value for one in events for value in one["data"].values()]
    history = ok(lab.operator.get(f"/api/sessions/{view['id']}/alarms"))
    assert [(one["code"], one["outcome"]) for one in history] == [
        ("stop_rule_met", "the operator continued, with a reason on record")
    ]


@pytest.mark.one_engine
def test_aborting_a_held_session_clears_its_hold(lab: Lab) -> None:
    """Aborting a held session clears its hold and its alarm."""
    view = answered(lab, 15)
    ended = lab.command(view, "abort", reason="Stop rule: sickness")
    assert (ended["status"], ended["held"], alarms(ended)) == ("aborted", None, {})


@pytest.mark.one_engine
def test_a_missing_score_raises_a_warning(lab: Lab) -> None:
    """A score that could not be computed raises a warning until a later form has one."""
    view = answered(lab, None)
    assert (view["held"], alarms(view)) == (None, {"stop_rule_unknown": "warning"})
    view = lab.skip_to(view, "block2.fms")
    ok(answer_fms(lab, view["id"], 15))
    assert alarms(lab.view(view["id"])) == {"stop_rule_met": "critical"}


@pytest.mark.one_engine
def test_a_server_restart_keeps_the_hold_and_its_alarm(fresh_lab: Lab) -> None:
    """A restart of the server keeps a session's hold and its alarm."""
    view = answered(fresh_lab, 15)
    stop_running_clocks(fresh_lab.context)
    after = fresh_lab.view(view["id"])
    assert after["held"] is not None
    assert alarms(after) == {"stop_rule_met": "critical"}


@pytest.mark.one_engine
def test_a_stop_rules_alarm_does_not_contain_the_answer(lab: Lab) -> None:
    """The alarm of a stop rule does not contain the answer."""
    view = answered(lab, 19)
    (alarm,) = view["alarms"]
    assert (alarm["value"], "19" in alarm["message"]) == (None, False)
    assert alarm["message"] == "sickness_score of fms is at or above 15"
