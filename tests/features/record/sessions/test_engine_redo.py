"""Tests of repeating, skipping and ending: a voided phase stays void."""

import pytest

from app.features.record.sessions.engine import Refused, evolve
from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.state import PhaseStatus, SessionStatus, StepStatus
from tests.features.record.sessions.engine_run import PLAN, WORDS, Run, index_of

HAND = "block1.hand"


def begin_phase(run: Run) -> None:
    """Start the phase of the current step and its clock."""
    run.do(c.BeginPhase(headset_connected=True))
    run.report("started", 0.0)


def test_repeating_a_running_phase_voids_it() -> None:
    """Repeating a running phase voids it and makes its step ready for attempt 2."""
    run = Run().begin(HAND)
    run.do(c.Redo(content=WORDS))
    assert run.state.ended_phases[0].status is PhaseStatus.VOIDED
    assert run.step.key == HAND
    assert run.state.steps[run.step.index].attempt == 2


def test_a_repeated_phase_has_a_new_id() -> None:
    """A repeated phase has its own id, so that its movement does not mix with the first."""
    run = Run().begin(HAND)
    run.do(c.Redo(content=WORDS))
    begin_phase(run)
    assert run.state.phase is not None
    assert (run.state.phase.phase_id, run.state.phase.attempt) == (2, 2)


def test_repeating_an_earlier_step_voids_all_later_ones() -> None:
    """Repeating an earlier step voids its phase and all later ones, and reopens their steps."""
    run = Run().begin(HAND).finish()
    run.go_to("block1.foot")
    begin_phase(run)
    run.do(c.Redo(content=WORDS, step=index_of(HAND)))
    assert [past.status for past in run.state.ended_phases] == [PhaseStatus.VOIDED] * 2
    assert run.step.key == HAND
    statuses = {step.key: run.state.steps[step.index].status for step in PLAN}
    assert statuses[f"{HAND}.karas2020"] is StepStatus.PENDING


def test_repeating_a_step_keeps_the_earlier_phases() -> None:
    """Phases before the repeated step still count."""
    run = Run().begin(HAND).finish()
    run.begin("block1.foot").finish()
    run.do(c.Redo(content=WORDS, step=index_of("block1.foot")))
    assert [past.status for past in run.state.ended_phases] == [
        PhaseStatus.DONE,
        PhaseStatus.VOIDED,
    ]


@pytest.mark.parametrize("step", [-1, 3, 99])
def test_only_a_step_that_was_reached_can_be_repeated(step: int) -> None:
    """Repeating a step that was not reached or does not exist is refused."""
    run = Run().go_to("instructions")
    with pytest.raises(Refused, match="has not been reached yet"):
        run.do(c.Redo(content=WORDS, step=step))


def test_skipping_a_running_phase_voids_it() -> None:
    """Skipping a running phase voids it and continues with the next step."""
    run = Run().begin(HAND)
    run.do(c.Skip(content=WORDS))
    assert run.state.ended_phases[0].status is PhaseStatus.VOIDED
    assert run.state.steps[index_of(HAND)].status is StepStatus.SKIPPED
    assert run.step.key == f"{HAND}.karas2020"


@pytest.mark.parametrize("status", ["aborted", "withdrawn"])
def test_stopping_ends_the_session_and_voids_the_running_phase(status: str) -> None:
    """Aborting or withdrawing ends the session and voids the running phase."""
    run = Run().begin(HAND)
    run.do(c.Stop(status=status, content=WORDS))
    assert (run.state.status, run.state.current) == (status, None)
    assert run.state.phase is None
    assert run.state.ended_phases[0].status is PhaseStatus.VOIDED


def test_an_ended_session_accepts_notes_only() -> None:
    """An ended session accepts notes and refuses every other command."""
    run = Run().go_to(HAND)
    run.do(c.Stop(status="aborted", content=WORDS))
    run.do(c.AddNote(content=WORDS))
    with pytest.raises(Refused, match="the session is aborted"):
        run.do(c.Skip(content=WORDS))


def test_leaving_the_last_step_completes_the_session() -> None:
    """Completing the last step completes the session."""
    run = Run().go_to("debrief")
    decided = run.do(c.CompleteStep(by="operator"))
    assert [event.type for event in decided] == ["step_completed", "session_ended"]
    assert (run.state.status, run.state.current) == (SessionStatus.COMPLETED, None)


def test_skipping_the_last_step_completes_the_session_too() -> None:
    """Skipping the last step completes the session."""
    run = Run().go_to("debrief")
    run.do(c.Skip(content=WORDS))
    assert run.state.status is SessionStatus.COMPLETED


def test_an_event_of_an_unknown_phase_changes_only_the_version() -> None:
    """An event about an unknown phase changes nothing but the version."""
    run = Run()
    after = evolve(run.state, e.PhaseResumed(phase_id=3, active_s=1.0, client_t_s=1.0))
    assert (after.version, after.phase) == (1, None)
