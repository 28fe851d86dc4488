"""Tests of the engine when a participant refuses consent or has a question."""

import pytest

from app.features.record.sessions.engine import (
    Command,
    Refused,
    allowed_commands,
    event_from_json,
    evolve,
    initial_state,
    state_from_json,
    state_to_json,
)
from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.state import PhaseStatus
from tests.features.record.sessions.engine_run import PLAN, WORDS, Run
from tests.features.record.sessions.test_holding import MOVES

HAND = "block1.hand"
REFUSE = c.RefuseConsent(by="tablet", step=0)
AGREE = c.CompleteStep(by="tablet", step=0, content=WORDS)


def refused() -> Run:
    """Return a session whose participant has refused consent."""
    run = Run()
    run.do(c.Start())
    run.do(REFUSE)
    return run


@pytest.mark.parametrize(
    "command",
    [*MOVES, AGREE, c.SubmitForm(step=0, submission_id="s", content_hash="h")],
    ids=lambda one: type(one).__name__,
)
def test_a_session_cannot_continue_after_a_refusal(command: Command) -> None:
    """After a refusal no command continues the session, not even the participant's agreement."""
    run = refused()
    before = run.state
    with pytest.raises(Refused, match="does not want to take part") as refusal:
        run.do(command)
    assert refusal.value.valid == ["withdraw", "abort", "reopen_consent"]
    assert run.state == before


def test_a_refusal_is_recorded_once() -> None:
    """A repeated refusal makes no second event, and ending is the first allowed command."""
    run = refused()
    assert run.do(REFUSE) == []
    assert [one.type for one in run.events] == ["session_started", "consent_refused"]
    assert allowed_commands(PLAN, run.state) == ["withdraw", "reopen_consent", "abort", "note"]


@pytest.mark.parametrize("step", [-1, 1, 3, 500])
def test_only_a_consent_that_was_shown_can_be_refused(step: int) -> None:
    """Refusing a step other than a consent that was shown is refused."""
    run = Run()
    run.do(c.Start())
    with pytest.raises(Refused) as refusal:
        run.do(c.RefuseConsent(by="tablet", step=step))
    assert refusal.value.valid == [0]


def test_an_ended_session_keeps_its_refusal() -> None:
    """A session that ends after a refusal keeps the refusal."""
    run = refused()
    run.do(c.Stop(status="withdrawn", content=WORDS))
    assert (run.state.status, run.state.refused_consent) == ("withdrawn", 0)
    with pytest.raises(Refused, match="withdrawn"):
        run.do(c.RetractRefusal(by="tablet"))


@pytest.mark.parametrize(
    "command",
    [c.RetractRefusal(by="tablet"), c.RetractRefusal(by="operator", content=WORDS)],
    ids=["by the participant", "by the operator"],
)
def test_a_retracted_refusal_returns_to_the_consent(command: Command) -> None:
    """Retracting a refusal returns to the consent, which can then be given or refused."""
    run = refused()
    (event,) = run.do(command)
    assert isinstance(event, e.RefusalRetracted)
    assert (run.state.refused_consent, run.step.kind) == (None, "consent")
    run.do(REFUSE)
    run.do(command)
    run.do(AGREE)
    assert run.step.index == 1


def test_retracting_no_refusal_is_an_error_for_the_operator_only() -> None:
    """Retracting a missing refusal is ignored from the tablet and an error for the operator."""
    run = Run()
    run.do(c.Start())
    assert run.do(c.RetractRefusal(by="tablet")) == []
    with pytest.raises(Refused, match="already been taken back"):
        run.do(c.RetractRefusal(by="operator", content=WORDS))


def test_a_late_refusal_pauses_the_running_phase() -> None:
    """A refusal that arrives during a phase pauses it, and it cannot be resumed."""
    run = Run().begin(HAND)
    decided = run.do(REFUSE)
    assert [one.type for one in decided] == ["consent_refused", "pause_requested"]
    run.report("paused", 3.0)
    with pytest.raises(Refused, match="does not want to take part"):
        run.do(c.Resume(headset_connected=True))
    run.do(c.RetractRefusal(by="operator", content=WORDS))
    run.do(c.Resume(headset_connected=True))


def test_a_refusal_during_the_countdown_pauses_the_phase_at_its_start() -> None:
    """A refusal during a phase's countdown requests a pause as soon as the clock runs."""
    run = Run().go_to(HAND)
    run.do(c.BeginPhase(headset_connected=True))
    run.do(REFUSE)
    run.report("started", 0.0)
    assert run.state.phase is not None
    assert (run.state.phase.status, run.state.phase.pausing) == (PhaseStatus.RUNNING, True)


def test_consent_needs_a_record_of_how_it_was_given() -> None:
    """Completing a consent without a record of how it was given is refused."""
    run = Run()
    run.do(c.Start())
    with pytest.raises(Refused, match="record of how it was given"):
        run.do(c.CompleteStep(by="operator", step=0))


def test_entering_the_body_needs_a_headset() -> None:
    """Entering the body without a headset is refused."""
    run = Run().go_to("materialise")
    with pytest.raises(Refused, match="no headset could show") as refusal:
        run.do(c.Materialise(by="operator", headset_connected=False))
    assert refusal.value.value == "headset not connected"
    assert not run.state.materialised


def test_a_question_is_asked_and_closed_once() -> None:
    """While open, a question is recorded only once, and it does not hold the session."""
    run = Run()
    for _ in range(2):
        run.do(c.AskQuestion())
    run.do(c.Start())
    for _ in range(2):
        run.do(c.CloseQuestion(outcome="answered"))
    run.do(c.AskQuestion())
    run.do(AGREE)
    assert [one.type for one in run.events] == [
        "question_asked",
        "session_started",
        "question_closed",
        "question_asked",
        "step_completed",
    ]
    assert [one.step for one in run.events if isinstance(one, e.QuestionAsked)] == [None, 0]
    run.do(c.Stop(status="aborted", content=WORDS))
    assert run.state.question_open is False
    with pytest.raises(Refused, match="aborted"):
        run.do(c.AskQuestion())


def test_a_snapshot_from_before_refusals_is_read() -> None:
    """Snapshots and event logs stored before refusals existed can still be read."""
    run = Run()
    run.do(c.Start())
    stored = state_to_json(run.state)
    del stored["refused_consent"], stored["question_open"]
    assert state_from_json(stored) == run.state
    state = initial_state(len(PLAN))
    for name, payload in (
        ("session_started", {}),
        ("step_completed", {"step": 0, "by": "operator"}),
    ):
        state = evolve(state, event_from_json(name, payload))
    assert (state.current, state.refused_consent) == (1, None)
