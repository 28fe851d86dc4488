"""Tests that late reports from a lost headset's journal correct what the server had assumed."""

import pytest

from app.features.record.sessions.engine import Refused
from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine.state import PhaseState
from tests.features.record.sessions.engine_run import PLAN, Run

ASSUMED = ("headset_lost", "server_restarted")
FOOT = next(step.key for step in PLAN if step.limb == "foot")


def lost(cause: str, active_s: float = 20.0) -> Run:
    """Return a run in a foot phase in which the headset was lost while the clock ran."""
    run = Run().begin(FOOT)
    run.do(c.HeadsetLost(active_s=active_s, cause=cause))
    return run


def phase_of(run: Run) -> PhaseState:
    """Return the current phase of a run."""
    assert run.state.phase is not None
    return run.state.phase


@pytest.mark.parametrize("cause", ASSUMED)
def test_a_walk_back_that_began_before_the_loss_is_accepted(cause: str) -> None:
    """A walk back that began before the loss is accepted, and its end restarts the clock.

    No operator has to resume the phase.
    """
    run = lost(cause)
    run.report("walk_back_started", 20.5)
    assert (phase_of(run).status, phase_of(run).pause_cause) == ("walk_back", None)
    run.report("walk_back_ended", 20.5)
    assert (phase_of(run).status, phase_of(run).active_s) == ("running", 20.5)


@pytest.mark.parametrize("cause", ASSUMED)
def test_a_phase_whose_time_was_up_before_the_loss_ends(cause: str) -> None:
    """A phase whose time was up before the headset was lost ends without a resume."""
    run = lost(cause, active_s=59.5)
    run.report("time_up", 60.0)
    run.report("ended", 60.0)
    assert run.state.phase is None


def test_an_early_resume_is_dropped_with_the_assumed_pause() -> None:
    """An operator's early resume is dropped when the assumed pause proves to be wrong.

    The headset was never paused, so it sends no resume.
    """
    run = lost("server_restarted")
    run.do(c.Resume(headset_connected=True))
    run.report("walk_back_started", 21.0)
    assert not phase_of(run).resuming


def test_a_reported_pause_is_not_corrected() -> None:
    """A pause that the headset itself reported is not corrected by later reports."""
    run = Run().begin(FOOT)
    run.report("paused", 20.0)
    for what in ("walk_back_started", "time_up"):
        with pytest.raises(Refused):
            run.report(what, 60.0)
