"""A refused consent and a question: laws of the engine."""

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
    """A session that stands at its consent, which the participant has refused."""
    run = Run()
    run.do(c.Start())
    run.do(REFUSE)
    return run


@pytest.mark.parametrize(
    "command",
    [*MOVES, AGREE, c.SubmitForm(step=0, submission_id="s", content_hash="h")],
    ids=lambda one: type(one).__name__,
)
def test_nothing_goes_on_after_a_refusal(command: Command) -> None:
    """Not even the participant's own agreement, before the refusal was taken back."""
    run = refused()
    before = run.state
    with pytest.raises(Refused, match="does not want to take part") as refusal:
        run.do(command)
    assert refusal.value.valid == ["withdraw", "abort", "reopen_consent"]
    assert run.state == before


def test_a_refusal_is_an_event_and_counts_once() -> None:
    """Saying it again changes nothing; the end is offered first."""
    run = refused()
    assert run.do(REFUSE) == []
    assert [one.type for one in run.events] == ["session_started", "consent_refused"]
    assert allowed_commands(PLAN, run.state) == ["withdraw", "reopen_consent", "abort", "note"]


@pytest.mark.parametrize("step", [-1, 1, 3, 500])
def test_only_a_consent_that_was_shown_can_be_refused(step: int) -> None:
    """No form and no step that lies ahead."""
    run = Run()
    run.do(c.Start())
    with pytest.raises(Refused) as refusal:
        run.do(c.RefuseConsent(by="tablet", step=step))
    assert refusal.value.valid == [0]


def test_ending_keeps_that_it_was_refused() -> None:
    """The tablet does not thank for taking part then."""
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
def test_whoever_changes_their_mind_stands_at_the_consent_again(command: Command) -> None:
    """Nothing is agreed to by that; agreeing and refusing are possible as before."""
    run = refused()
    (event,) = run.do(command)
    assert isinstance(event, e.RefusalRetracted)
    assert (run.state.refused_consent, run.step.kind) == (None, "consent")
    run.do(REFUSE)
    run.do(command)
    run.do(AGREE)
    assert run.step.index == 1


def test_taking_back_what_was_not_said_is_harmless_on_the_tablet_only() -> None:
    """An operator who was overtaken hears of it."""
    run = Run()
    run.do(c.Start())
    assert run.do(c.RetractRefusal(by="tablet")) == []
    with pytest.raises(Refused, match="already been taken back"):
        run.do(c.RetractRefusal(by="operator", content=WORDS))


def test_a_refusal_that_comes_late_stops_the_clock() -> None:
    """A tablet was offline while the consent was recorded from paper."""
    run = Run().begin(HAND)
    decided = run.do(REFUSE)
    assert [one.type for one in decided] == ["consent_refused", "pause_requested"]
    run.report("paused", 3.0)
    with pytest.raises(Refused, match="does not want to take part"):
        run.do(c.Resume(headset_connected=True))
    run.do(c.RetractRefusal(by="operator", content=WORDS))
    run.do(c.Resume(headset_connected=True))


def test_a_headset_that_counts_down_is_stopped_as_soon_as_its_clock_runs() -> None:
    """It had its order before the refusal came."""
    run = Run().go_to(HAND)
    run.do(c.BeginPhase(headset_connected=True))
    run.do(REFUSE)
    run.report("started", 0.0)
    assert run.state.phase is not None
    assert (run.state.phase.status, run.state.phase.pausing) == (PhaseStatus.RUNNING, True)


def test_consent_needs_a_record_of_how_it_was_given() -> None:
    """Whoever sends the command."""
    run = Run()
    run.do(c.Start())
    with pytest.raises(Refused, match="record of how it was given"):
        run.do(c.CompleteStep(by="operator", step=0))


def test_no_body_appears_without_a_headset() -> None:
    """The log would say that somebody saw it."""
    run = Run().go_to("materialise")
    with pytest.raises(Refused, match="no headset could show") as refusal:
        run.do(c.Materialise(by="operator", headset_connected=False))
    assert refusal.value.value == "headset not connected"
    assert not run.state.materialised


def test_a_question_is_asked_and_closed_once() -> None:
    """Before the start, too; it holds nothing up."""
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


def test_what_was_stored_before_there_were_refusals_is_read() -> None:
    """A snapshot without the fields, and an old log in which an operator's click was a consent."""
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
