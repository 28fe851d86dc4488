"""A stop rule that is met: laws of the engine."""

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
    """A session whose form met these rules."""
    run = Run().go_to(form)
    run.do(
        c.SubmitForm(
            step=run.step.index, submission_id="s", content_hash="h", rules_met=tuple(rules)
        )
    )
    return run


def test_a_rule_that_is_met_holds_the_session_behind_the_form() -> None:
    """The form is stored and the step is left; the first of several rules is named."""
    run = submitted(1, 0)
    assert [event.type for event in run.events[-3:]] == [
        "form_submitted",
        "stop_rule_met",
        "stop_rule_met",
    ]
    assert run.state.held == Hold(1, "s")
    assert run.step.key == "block1.foot"


def test_the_event_holds_no_answer() -> None:
    """Which rule and which form, nothing else."""
    (event,) = [one for one in submitted(0).events if isinstance(one, e.StopRuleMet)]
    assert vars(event) == {"rule": 0, "submission_id": "s"}


@pytest.mark.parametrize("command", MOVES, ids=lambda one: type(one).__name__)
def test_nothing_moves_a_held_session_on(command: Command) -> None:
    """The refusal says why and what can be done, and leaves everything as it was."""
    run = submitted(0)
    before = run.state
    with pytest.raises(Refused, match="stop rule") as refused:
        run.do(command)
    assert refused.value.valid == ["withdraw", "abort", "override_stop"]
    assert "participant" in refused.value.remedy
    assert run.state == before


def test_every_command_that_moves_on_is_tried_here() -> None:
    """The list of the engine and the list above are one."""
    assert {type(one) for one in MOVES} == set(GOES_ON)


def test_a_held_session_offers_its_end_first() -> None:
    """Ending is the first choice, going on the other."""
    assert allowed_commands(PLAN, submitted(0).state) == [
        "abort",
        "withdraw",
        "override_stop",
        "note",
    ]


def test_going_on_lifts_the_hold_and_keeps_the_reason() -> None:
    """Afterwards the next step is the operator's again; a second override is refused."""
    run = submitted(0)
    (event,) = run.do(c.OverrideStop(content=WORDS))
    assert event == e.StopRuleOverridden(content_id="content", content_hash="hash")
    assert run.state.held is None
    assert allowed_commands(PLAN, run.state)[0] == "begin_phase"
    with pytest.raises(Refused, match="not held by a stop rule"):
        run.do(c.OverrideStop(content=WORDS))


@pytest.mark.parametrize("status", ["aborted", "withdrawn"])
def test_a_held_session_can_be_ended(status: str) -> None:
    """And is not held any more when it is over."""
    run = submitted(0)
    run.do(c.Stop(status=status, content=WORDS))
    assert (run.state.status, run.state.held) == (status, None)


def test_a_snapshot_from_before_there_were_rules_is_read() -> None:
    """A session that was running during an update goes on."""
    run = Run().go_to(FORM)
    stored = state_to_json(run.state)
    del stored["held"]
    assert state_from_json(stored) == run.state


def test_a_held_session_survives_being_stored() -> None:
    """The hold is part of the snapshot."""
    state = submitted(2).state
    assert state_from_json(state_to_json(state)) == state
