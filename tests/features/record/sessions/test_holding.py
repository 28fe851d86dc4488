"""Tests of the engine when a stop rule is met."""

import pytest

from app.features.record.sessions.engine import (
    Command,
    Refused,
    allowed_commands,
    state_from_json,
    state_to_json,
)
from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.decide import GOES_ON
from app.features.record.sessions.engine.state import Hold
from tests.features.record.sessions.engine_run import PLAN, WORDS, Run

FORM = "block1.hand.karas2020"
MOVES: tuple[Command, ...] = (
    c.BeginPhase(headset_connected=True),
    c.CompleteStep(by="operator"),
    c.Materialise(by="operator", headset_connected=True),
    c.Redo(content=WORDS, step=0),
    c.Resume(headset_connected=True),
    c.Skip(content=WORDS),
)


def submitted(*rules: int, form: str = FORM) -> Run:
    """Return a session after a form that met these rules."""
    run = Run().go_to(form)
    run.do(
        c.SubmitForm(
            step=run.step.index, submission_id="s", content_hash="h", rules_met=tuple(rules)
        )
    )
    return run


def test_a_met_stop_rule_holds_the_session_after_the_form() -> None:
    """A met stop rule holds the session after the form is stored; the first rule is named."""
    run = submitted(1, 0)
    assert [event.type for event in run.events[-3:]] == [
        "form_submitted",
        "stop_rule_met",
        "stop_rule_met",
    ]
    assert run.state.held == Hold(1, "s")
    assert run.step.key == "block1.foot"


def test_the_stop_rule_event_has_no_answer() -> None:
    """The event of a met stop rule has only the rule and the submission."""
    (event,) = [one for one in submitted(0).events if isinstance(one, e.StopRuleMet)]
    assert vars(event) == {"rule": 0, "submission_id": "s"}


@pytest.mark.parametrize("command", MOVES, ids=lambda one: type(one).__name__)
def test_a_held_session_refuses_to_continue(command: Command) -> None:
    """A held session refuses every command that continues it, and names the valid ones."""
    run = submitted(0)
    before = run.state
    with pytest.raises(Refused, match="stop rule") as refused:
        run.do(command)
    assert refused.value.valid == ["withdraw", "abort", "override_stop"]
    assert "participant" in refused.value.remedy
    assert run.state == before


def test_all_commands_that_continue_a_session_are_tested() -> None:
    """`MOVES` has every command that the engine regards as continuing a session."""
    assert {type(one) for one in MOVES} == set(GOES_ON)


def test_a_held_session_lists_its_end_first() -> None:
    """The allowed commands of a held session begin with those that end it."""
    assert allowed_commands(PLAN, submitted(0).state) == [
        "abort",
        "withdraw",
        "override_stop",
        "note",
    ]


def test_overriding_lifts_the_hold_and_stores_the_reason() -> None:
    """Overriding the stop rule with a reason lifts the hold; overriding again is refused."""
    run = submitted(0)
    (event,) = run.do(c.OverrideStop(content=WORDS))
    assert event == e.StopRuleOverridden(content_id="content", content_hash="hash")
    assert run.state.held is None
    assert allowed_commands(PLAN, run.state)[0] == "begin_phase"
    with pytest.raises(Refused, match="not held by a stop rule"):
        run.do(c.OverrideStop(content=WORDS))


@pytest.mark.parametrize("status", ["aborted", "withdrawn"])
def test_a_held_session_can_be_ended(status: str) -> None:
    """Aborting or withdrawing ends a held session and its hold."""
    run = submitted(0)
    run.do(c.Stop(status=status, content=WORDS))
    assert (run.state.status, run.state.held) == (status, None)


def test_a_snapshot_without_the_hold_field_is_read() -> None:
    """A snapshot stored before stop rules existed can still be read."""
    run = Run().go_to(FORM)
    stored = state_to_json(run.state)
    del stored["held"]
    assert state_from_json(stored) == run.state


def test_a_held_session_survives_being_stored() -> None:
    """The hold is part of the stored snapshot."""
    state = submitted(2).state
    assert state_from_json(state_to_json(state)) == state
