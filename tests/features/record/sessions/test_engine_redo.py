"""Doing over, skipping and ending: what was voided stays voided."""

import pytest

from app.features.record.sessions.engine import Refused, evolve
from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.state import PhaseStatus, SessionStatus, StepStatus
from tests.features.record.sessions.engine_run import PLAN, WORDS, Run, index_of

HAND = "block1.hand"


def begin_again(run: Run) -> None:
    """Call the phase of the current step and start its clock."""
    run.do(c.BeginPhase(headset_connected=True))
    run.report("started", 0.0)


def test_redoing_a_running_phase_voids_it() -> None:
    """The broken run keeps its data as voided, and the same step is ready as attempt 2."""
    run = Run().begin(HAND)
    run.do(c.Redo(content=WORDS))
    assert run.state.ended_phases[0].status is PhaseStatus.VOIDED
    assert run.step.key == HAND
    assert run.state.steps[run.step.index].attempt == 2


def test_redoing_counts_a_new_phase() -> None:
    """The repetition has an id of its own, so its telemetry cannot mix with the first."""
    run = Run().begin(HAND)
    run.do(c.Redo(content=WORDS))
    begin_again(run)
    assert run.state.phase is not None
    assert (run.state.phase.phase_id, run.state.phase.attempt) == (2, 2)


def test_going_back_voids_everything_after() -> None:
    """Redoing an earlier step voids its phase and the later ones and reopens all steps since."""
    run = Run().begin(HAND).finish()
    run.go_to("block1.foot")
    begin_again(run)
    run.do(c.Redo(content=WORDS, step=index_of(HAND)))
    assert [past.status for past in run.state.ended_phases] == [PhaseStatus.VOIDED] * 2
    assert run.step.key == HAND
    statuses = {step.key: run.state.steps[step.index].status for step in PLAN}
    assert statuses[f"{HAND}.karas2020"] is StepStatus.PENDING


def test_going_back_leaves_earlier_phases_alone() -> None:
    """What was done before the reopened step still counts."""
    run = Run().begin(HAND).finish()
    run.begin("block1.foot").finish()
    run.do(c.Redo(content=WORDS, step=index_of("block1.foot")))
    assert [past.status for past in run.state.ended_phases] == [
        PhaseStatus.DONE,
        PhaseStatus.VOIDED,
    ]


@pytest.mark.parametrize("step", [-1, 3, 99])
def test_only_what_was_reached_can_be_redone(step: int) -> None:
    """A step that lies ahead, or no step at all, is refused."""
    run = Run().go_to("instructions")
    with pytest.raises(Refused, match="has not been reached yet"):
        run.do(c.Redo(content=WORDS, step=step))


def test_skipping_a_running_phase_voids_it() -> None:
    """A skipped phase does not count, and the session stands in the next step."""
    run = Run().begin(HAND)
    run.do(c.Skip(content=WORDS))
    assert run.state.ended_phases[0].status is PhaseStatus.VOIDED
    assert run.state.steps[index_of(HAND)].status is StepStatus.SKIPPED
    assert run.step.key == f"{HAND}.karas2020"


@pytest.mark.parametrize("status", ["aborted", "withdrawn"])
def test_stopping_ends_the_session_and_voids_what_runs(status: str) -> None:
    """Abort and withdrawal end everything at once."""
    run = Run().begin(HAND)
    run.do(c.Stop(status=status, content=WORDS))
    assert (run.state.status, run.state.current) == (status, None)
    assert run.state.phase is None
    assert run.state.ended_phases[0].status is PhaseStatus.VOIDED


def test_an_ended_session_takes_notes_only() -> None:
    """After the end a note is added, and every other command is refused."""
    run = Run().go_to(HAND)
    run.do(c.Stop(status="aborted", content=WORDS))
    run.do(c.AddNote(content=WORDS))
    with pytest.raises(Refused, match="the session is aborted"):
        run.do(c.Skip(content=WORDS))


def test_leaving_the_last_step_completes_the_session() -> None:
    """The debriefing is followed by the session's end in the same decision."""
    run = Run().go_to("debrief")
    decided = run.do(c.CompleteStep(by="operator"))
    assert [event.type for event in decided] == ["step_completed", "session_ended"]
    assert (run.state.status, run.state.current) == (SessionStatus.COMPLETED, None)


def test_skipping_the_last_step_completes_the_session_too() -> None:
    """A session without debriefing has still reached its end."""
    run = Run().go_to("debrief")
    run.do(c.Skip(content=WORDS))
    assert run.state.status is SessionStatus.COMPLETED


def test_folding_is_total() -> None:
    """An event of a clock that no phase has leaves the state as it was, one version on."""
    run = Run()
    after = evolve(run.state, e.PhaseResumed(phase_id=3, active_s=1.0, client_t_s=1.0))
    assert (after.version, after.phase) == (1, None)
