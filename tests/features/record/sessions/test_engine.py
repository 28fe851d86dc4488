"""What a session does, step by step, without a database."""

import pytest

from app.features.record.sessions.engine import Refused
from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.state import PhaseStatus, SessionStatus, StepStatus
from tests.features.record.sessions.engine_run import REPORTS, WORDS, Run, index_of

HAND = "block1.hand"


def test_starting_enters_the_first_step() -> None:
    """A started session is active and stands in step 0."""
    run = Run()
    assert run.do(c.Start()) == [e.SessionStarted()]
    assert (run.state.status, run.state.current) == (SessionStatus.ACTIVE, 0)


def test_starting_twice_is_refused() -> None:
    """The second of two starts hears that the session is active already."""
    run = Run()
    run.do(c.Start())
    with pytest.raises(Refused, match="already active"):
        run.do(c.Start())


def test_nothing_but_notes_and_start_before_the_start() -> None:
    """A planned session refuses commands for its steps and says to start it."""
    with pytest.raises(Refused) as refused:
        Run().do(c.CompleteStep(by="operator"))
    assert refused.value.remedy == "Start the session first."


def test_a_late_click_does_not_complete_the_next_step() -> None:
    """A command for step 0 is refused once the session stands in step 2."""
    run = Run().go_to("instructions")
    with pytest.raises(Refused, match="not the current one"):
        run.do(c.CompleteStep(by="tablet", step=0))


def test_a_step_with_a_form_cannot_be_marked_as_done() -> None:
    """A form is finished by its answers only."""
    run = Run().go_to("form.demographics")
    with pytest.raises(Refused) as refused:
        run.do(c.CompleteStep(by="operator"))
    assert refused.value.value == "form"


def test_a_form_moves_the_session_on() -> None:
    """Submitting the due form leaves its step as done."""
    run = Run().go_to("form.demographics")
    run.do(c.SubmitForm(step=run.step.index, submission_id="s", content_hash="h"))
    assert run.state.steps[index_of("form.demographics")].status is StepStatus.DONE
    assert run.step.key == "instructions"


def test_a_phase_needs_a_headset() -> None:
    """Beginning without a headset is refused, with what to do about it."""
    run = Run().go_to(HAND)
    with pytest.raises(Refused, match="no headset is connected") as refused:
        run.do(c.BeginPhase(headset_connected=False))
    assert "Pair or wake the headset" in refused.value.remedy


def test_a_phase_is_begun_once() -> None:
    """A second begin while one is under way is refused."""
    run = Run().begin(HAND)
    with pytest.raises(Refused, match="already running"):
        run.do(c.BeginPhase(headset_connected=True))


def test_a_phase_carries_the_latency_of_its_block() -> None:
    """The first condition of the order is what the first phase is prepared with."""
    run = Run().go_to(HAND)
    (prepared,) = run.do(c.BeginPhase(headset_connected=True))
    assert prepared == e.PhasePrepared(step=index_of(HAND), phase_id=1, attempt=1, latency_ms=125.0)


def test_a_whole_phase_leads_to_its_questionnaire() -> None:
    """started, time_up and ended leave the phase done and the next step current."""
    run = Run().begin(HAND).finish()
    assert run.step.key == f"{HAND}.karas2020"
    assert run.state.phase is None
    assert run.state.ended_phases[-1].status is PhaseStatus.DONE
    assert run.state.ended_phases[-1].active_s == 60.0


@pytest.mark.parametrize("active_s", [0.0, 59.9])
def test_time_is_not_up_before_the_duration_is_used(active_s: float) -> None:
    """A headset that ends a phase early is refused."""
    run = Run().begin(HAND)
    with pytest.raises(Refused, match="does not fit 'time_up'"):
        run.report("time_up", active_s)


def test_active_time_beyond_the_duration_is_refused() -> None:
    """No phase is longer than its duration and a few frames."""
    run = Run().begin(HAND)
    with pytest.raises(Refused, match="active time 61"):
        run.report("paused", 61.0)


def test_active_time_does_not_run_backwards() -> None:
    """A report with less active time than is known is refused."""
    run = Run().begin(HAND)
    run.report("paused", 30.0)
    with pytest.raises(Refused, match="active time 29"):
        run.report("resumed", 29.0)


def test_a_rounding_step_back_is_taken_as_no_step() -> None:
    """Within a microsecond the known active time stands."""
    run = Run().begin(HAND)
    run.report("paused", 30.0)
    run.report("resumed", 30.0 - 5e-7)
    assert run.state.phase is not None
    assert run.state.phase.active_s == 30.0


def test_a_pause_is_a_wish_until_the_headset_reports_it() -> None:
    """Asking for a pause does not stop the clock; the headset's report does."""
    run = Run().begin(HAND)
    run.do(c.Pause(content=WORDS))
    assert run.state.phase is not None
    assert (run.state.phase.status, run.state.phase.pausing) == (PhaseStatus.RUNNING, True)
    run.report("paused", 12.5)
    assert (run.state.phase.status, run.state.phase.pausing) == (PhaseStatus.PAUSED, False)
    assert (run.state.phase.active_s, run.state.phase.pause_cause) == (12.5, "operator")


def test_asking_twice_for_a_pause_adds_nothing() -> None:
    """The second request gives no event."""
    run = Run().begin(HAND)
    run.do(c.Pause())
    assert run.do(c.Pause()) == []


def test_resuming_is_a_wish_until_the_headset_reports_it() -> None:
    """The clock runs again from the headset's report on."""
    run = Run().begin(HAND)
    run.report("paused", 10.0)
    run.do(c.Resume(headset_connected=True))
    assert run.state.phase is not None
    assert (run.state.phase.status, run.state.phase.resuming) == (PhaseStatus.PAUSED, True)
    run.report("resumed", 10.0)
    assert (run.state.phase.status, run.state.phase.resuming) == (PhaseStatus.RUNNING, False)
    assert run.state.phase.pause_cause is None


def test_resuming_needs_a_headset() -> None:
    """A phase whose headset is gone stays paused."""
    run = Run().begin(HAND)
    run.do(c.HeadsetLost(active_s=5.0, cause="headset_lost"))
    with pytest.raises(Refused, match="no headset is connected"):
        run.do(c.Resume(headset_connected=False))


def test_a_lost_headset_pauses_at_the_last_stored_time() -> None:
    """The clock stops where the record ends, and says why."""
    run = Run().begin(HAND)
    run.do(c.HeadsetLost(active_s=17.25, cause="headset_lost"))
    assert run.state.phase is not None
    assert run.state.phase.status is PhaseStatus.PAUSED
    assert (run.state.phase.active_s, run.state.phase.pause_cause) == (17.25, "headset_lost")


@pytest.mark.parametrize("claimed", [1e9, float("inf"), float("nan"), -3.0])
def test_a_lost_headset_cannot_use_up_more_time_than_there_is(claimed: float) -> None:
    """Whatever a broken stream claimed, the pause stays within the phase's duration."""
    run = Run().begin(HAND)
    run.do(c.HeadsetLost(active_s=claimed, cause="headset_lost"))
    assert run.state.phase is not None
    assert 0.0 <= run.state.phase.active_s <= 60.0


def test_the_headset_corrects_an_assumed_pause_when_it_is_back() -> None:
    """Its own report of the same pause is taken, and the cause stays."""
    run = Run().begin(HAND)
    run.do(c.HeadsetLost(active_s=17.0, cause="headset_lost"))
    run.report("paused", 17.4)
    assert run.state.phase is not None
    assert (run.state.phase.active_s, run.state.phase.pause_cause) == (17.4, "headset_lost")


@pytest.mark.parametrize("until", ["preparing", "freezing"])
def test_losing_the_headset_stops_only_a_running_clock(until: str) -> None:
    """A phase that is counted down or frozen waits as it is."""
    run = Run().go_to(HAND)
    run.do(c.BeginPhase(headset_connected=True))
    if until == "freezing":
        run.report("started", 0.0)
        run.report("time_up", 60.0)
    assert run.do(c.HeadsetLost(active_s=1.0, cause="headset_lost")) == []


def test_walking_back_stops_the_clock() -> None:
    """From the bar to the start square no active time passes."""
    run = Run().begin("block1.foot")
    run.report("walk_back_started", 14.0)
    assert run.state.phase is not None
    assert run.state.phase.status is PhaseStatus.WALK_BACK
    run.report("walk_back_ended", 14.0)
    assert (run.state.phase.status, run.state.phase.active_s) == (PhaseStatus.RUNNING, 14.0)


@pytest.mark.parametrize("what", [what for what in REPORTS if what != "started"])
def test_only_a_start_fits_a_prepared_phase(what: str) -> None:
    """Every other report is refused before the clock has started."""
    run = Run().go_to(HAND)
    run.do(c.BeginPhase(headset_connected=True))
    with pytest.raises(Refused, match="does not fit a phase that is preparing"):
        run.report(what, 0.0)


def test_a_report_of_another_phase_is_refused() -> None:
    """A report that was on its way when the phase was voided does nothing."""
    run = Run().begin(HAND)
    report = c.Report(what="paused", phase_id=7, client_t_s=1.0, active_s=1.0)
    with pytest.raises(Refused, match="phase 7 is not in progress"):
        run.do(report)
