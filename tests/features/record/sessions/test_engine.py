"""Tests of the session engine, step by step, without a database."""

import pytest

from app.features.record.sessions.engine import Refused
from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.state import PhaseStatus, SessionStatus, StepStatus
from tests.features.record.sessions.engine_run import REPORTS, WORDS, Run, index_of

HAND = "block1.hand"


def test_starting_enters_the_first_step() -> None:
    """A started session is active and at its first step."""
    run = Run()
    assert run.do(c.Start()) == [e.SessionStarted()]
    assert (run.state.status, run.state.current) == (SessionStatus.ACTIVE, 0)


def test_starting_twice_is_refused() -> None:
    """Starting a session that is already active is refused."""
    run = Run()
    run.do(c.Start())
    with pytest.raises(Refused, match="already active"):
        run.do(c.Start())


def test_a_planned_session_refuses_commands_for_its_steps() -> None:
    """A planned session refuses commands for its steps with the advice to start it."""
    with pytest.raises(Refused) as refused:
        Run().do(c.CompleteStep(by="operator"))
    assert refused.value.remedy == "Start the session first."


def test_a_late_click_does_not_complete_the_next_step() -> None:
    """A command for a step that is no longer current is refused."""
    run = Run().go_to("instructions")
    with pytest.raises(Refused, match="not the current one"):
        run.do(c.CompleteStep(by="tablet", step=0))


def test_a_step_with_a_form_cannot_be_marked_as_done() -> None:
    """A form's step cannot be completed without its answers."""
    run = Run().go_to("form.demographics")
    with pytest.raises(Refused) as refused:
        run.do(c.CompleteStep(by="operator"))
    assert refused.value.value == "form"


def test_submitting_a_form_advances_the_session() -> None:
    """Submitting the form that is due completes its step."""
    run = Run().go_to("form.demographics")
    run.do(c.SubmitForm(step=run.step.index, submission_id="s", content_hash="h"))
    assert run.state.steps[index_of("form.demographics")].status is StepStatus.DONE
    assert run.step.key == "instructions"


def test_a_phase_needs_a_headset() -> None:
    """Starting a phase without a headset is refused with advice."""
    run = Run().go_to(HAND)
    with pytest.raises(Refused, match="no headset is connected") as refused:
        run.do(c.BeginPhase(headset_connected=False))
    assert "Pair or wake the headset" in refused.value.remedy


def test_a_phase_cannot_be_started_twice() -> None:
    """Starting a phase that is already in progress is refused."""
    run = Run().begin(HAND)
    with pytest.raises(Refused, match="already running"):
        run.do(c.BeginPhase(headset_connected=True))


def test_a_phase_has_the_latency_of_its_block() -> None:
    """A phase is prepared with the latency of its block."""
    run = Run().go_to(HAND)
    (prepared,) = run.do(c.BeginPhase(headset_connected=True))
    assert prepared == e.PhasePrepared(step=index_of(HAND), phase_id=1, attempt=1, latency_ms=125.0)


def test_a_whole_phase_leads_to_its_questionnaire() -> None:
    """A completed phase is done, and its questionnaire becomes the current step."""
    run = Run().begin(HAND).finish()
    assert run.step.key == f"{HAND}.karas2020"
    assert run.state.phase is None
    assert run.state.ended_phases[-1].status is PhaseStatus.DONE
    assert run.state.ended_phases[-1].active_s == 60.0


@pytest.mark.parametrize("active_s", [0.0, 59.9])
def test_time_is_not_up_before_the_duration_is_used(active_s: float) -> None:
    """A report that a phase's time is up before its duration has elapsed is refused."""
    run = Run().begin(HAND)
    with pytest.raises(Refused, match="does not fit 'time_up'"):
        run.report("time_up", active_s)


def test_active_time_beyond_the_duration_is_refused() -> None:
    """A report with more active time than the phase's duration is refused."""
    run = Run().begin(HAND)
    with pytest.raises(Refused, match="active time 61"):
        run.report("paused", 61.0)


def test_decreasing_active_time_is_refused() -> None:
    """A report with less active time than before is refused."""
    run = Run().begin(HAND)
    run.report("paused", 30.0)
    with pytest.raises(Refused, match="active time 29"):
        run.report("resumed", 29.0)


def test_a_rounding_error_in_active_time_is_tolerated() -> None:
    """Active time that is less than before by under a microsecond counts as unchanged."""
    run = Run().begin(HAND)
    run.report("paused", 30.0)
    run.report("resumed", 30.0 - 5e-7)
    assert run.state.phase is not None
    assert run.state.phase.active_s == 30.0


def test_a_pause_takes_effect_when_the_headset_reports_it() -> None:
    """A requested pause stops the phase's clock only when the headset reports it."""
    run = Run().begin(HAND)
    run.do(c.Pause(content=WORDS))
    assert run.state.phase is not None
    assert (run.state.phase.status, run.state.phase.pausing) == (PhaseStatus.RUNNING, True)
    run.report("paused", 12.5)
    assert (run.state.phase.status, run.state.phase.pausing) == (PhaseStatus.PAUSED, False)
    assert (run.state.phase.active_s, run.state.phase.pause_cause) == (12.5, "operator")


def test_a_second_pause_request_has_no_effect() -> None:
    """Requesting a pause twice makes no second event."""
    run = Run().begin(HAND)
    run.do(c.Pause())
    assert run.do(c.Pause()) == []


def test_resuming_takes_effect_when_the_headset_reports_it() -> None:
    """A resumed phase's clock runs only when the headset reports it."""
    run = Run().begin(HAND)
    run.report("paused", 10.0)
    run.do(c.Resume(headset_connected=True))
    assert run.state.phase is not None
    assert (run.state.phase.status, run.state.phase.resuming) == (PhaseStatus.PAUSED, True)
    run.report("resumed", 10.0)
    assert (run.state.phase.status, run.state.phase.resuming) == (PhaseStatus.RUNNING, False)
    assert run.state.phase.pause_cause is None


def test_a_pause_that_is_reported_again_takes_back_no_request_to_resume() -> None:
    """A late report of a known pause leaves the operator's newer request to resume in force."""
    run = Run().begin(HAND)
    run.report("paused", 10.0)
    run.do(c.Resume(headset_connected=True))
    run.report("paused", 10.0)
    assert run.state.phase is not None
    assert (run.state.phase.status, run.state.phase.resuming) == (PhaseStatus.PAUSED, True)
    run.report("resumed", 10.0)
    run.report("paused", 11.0)
    assert (run.state.phase.status, run.state.phase.resuming) == (PhaseStatus.PAUSED, False)


def test_a_wish_to_stop_takes_back_a_request_to_resume_that_is_not_carried_out_yet() -> None:
    """A request to resume lapses if the participant asks to stop first, and a new one counts."""
    run = Run().begin(HAND)
    run.report("paused", 10.0)
    run.do(c.Resume(headset_connected=True))
    run.do(c.AskToStop(client_t_s=12.0))
    assert run.state.phase is not None
    assert (run.state.phase.status, run.state.phase.resuming) == (PhaseStatus.PAUSED, False)
    assert run.state.stop_asked
    run.do(c.Resume(headset_connected=True))
    assert (run.state.phase.resuming, run.state.stop_asked) == (True, False)
    assert [type(one) for one in run.report("resumed", 10.0)] == [e.PhaseResumed]


def test_a_headset_that_resumes_against_a_wish_to_stop_is_told_to_pause() -> None:
    """A headset that had obeyed the lapsed request before it heard of the wish pauses again."""
    run = Run().begin(HAND)
    run.report("paused", 10.0)
    run.do(c.Resume(headset_connected=True))
    run.do(c.AskToStop(client_t_s=12.0))
    resumed = run.report("resumed", 10.0)
    assert [type(one) for one in resumed] == [e.PhaseResumed, e.PauseRequested]
    assert run.state.phase is not None
    assert (run.state.phase.status, run.state.phase.pausing) == (PhaseStatus.RUNNING, True)


def test_resuming_needs_a_headset() -> None:
    """Resuming a phase without a headset is refused."""
    run = Run().begin(HAND)
    run.do(c.HeadsetLost(active_s=5.0, cause="headset_lost"))
    with pytest.raises(Refused, match="no headset is connected"):
        run.do(c.Resume(headset_connected=False))


def test_a_lost_headset_pauses_at_the_last_stored_time() -> None:
    """Losing the headset pauses the phase at the last stored active time, with the cause."""
    run = Run().begin(HAND)
    run.do(c.HeadsetLost(active_s=17.25, cause="headset_lost"))
    assert run.state.phase is not None
    assert run.state.phase.status is PhaseStatus.PAUSED
    assert (run.state.phase.active_s, run.state.phase.pause_cause) == (17.25, "headset_lost")


@pytest.mark.parametrize("claimed", [1e9, float("inf"), float("nan"), -3.0])
def test_a_lost_headsets_pause_stays_within_the_duration(claimed: float) -> None:
    """The pause of a lost headset lies within the phase's duration, whatever time it claimed."""
    run = Run().begin(HAND)
    run.do(c.HeadsetLost(active_s=claimed, cause="headset_lost"))
    assert run.state.phase is not None
    assert 0.0 <= run.state.phase.active_s <= 60.0


def test_the_headset_corrects_an_assumed_pause_when_it_is_back() -> None:
    """A headset that is back corrects the active time at which the server assumed it to pause."""
    run = Run().begin(HAND)
    run.do(c.HeadsetLost(active_s=17.0, cause="headset_lost"))
    run.report("paused", 17.4)
    assert run.state.phase is not None
    assert (run.state.phase.active_s, run.state.phase.pause_cause) == (17.4, "headset_lost")


@pytest.mark.parametrize("until", ["preparing", "freezing"])
def test_losing_the_headset_stops_only_a_running_clock(until: str) -> None:
    """Losing the headset changes nothing while the phase is preparing or freezing."""
    run = Run().go_to(HAND)
    run.do(c.BeginPhase(headset_connected=True))
    if until == "freezing":
        run.report("started", 0.0)
        run.report("time_up", 60.0)
    assert run.do(c.HeadsetLost(active_s=1.0, cause="headset_lost")) == []


def test_walking_back_stops_the_clock() -> None:
    """Active time stops while the participant walks back to the start square."""
    run = Run().begin("block1.foot")
    run.report("walk_back_started", 14.0)
    assert run.state.phase is not None
    assert run.state.phase.status is PhaseStatus.WALK_BACK
    run.report("walk_back_ended", 14.0)
    assert (run.state.phase.status, run.state.phase.active_s) == (PhaseStatus.RUNNING, 14.0)


@pytest.mark.parametrize("what", [what for what in REPORTS if what != "started"])
def test_only_a_start_fits_a_prepared_phase(what: str) -> None:
    """A prepared phase refuses every report but that it has started."""
    run = Run().go_to(HAND)
    run.do(c.BeginPhase(headset_connected=True))
    with pytest.raises(Refused, match="does not fit a phase that is preparing"):
        run.report(what, 0.0)


def test_a_report_of_another_phase_is_refused() -> None:
    """A report about a phase that is not in progress is refused."""
    run = Run().begin(HAND)
    report = c.Report(what="paused", phase_id=7, client_t_s=1.0, active_s=1.0)
    with pytest.raises(Refused, match="phase 7 is not in progress"):
        run.do(report)
