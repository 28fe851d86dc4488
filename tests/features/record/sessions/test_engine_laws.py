"""Tests of laws of the session engine that hold for every sequence of commands."""

import contextlib
import json
from dataclasses import fields

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from app.features.record.sessions.engine import (
    EVENT_TYPES,
    Command,
    Event,
    Refused,
    SessionState,
    allowed_commands,
    decide,
    event_from_json,
    event_to_json,
    evolve,
    initial_state,
    state_from_json,
    state_to_json,
)
from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine.events import Companion
from app.features.record.sessions.engine.state import PhaseStatus
from tests.features.record.sessions.engine_run import PLAN, REPORTS, WORDS, Run
from tests.support.repetitions import usually

STEPS = st.none() | st.integers(-1, len(PLAN))
TIMES = st.one_of(
    st.floats(0, 121), st.sampled_from([0.0, 60.0, 120.0, -1.0, float("nan"), float("inf")])
)
ANYTHING: st.SearchStrategy[Command] = st.one_of(
    st.just(c.Start()),
    st.builds(
        c.CompleteStep, by=st.just("operator"), step=STEPS, content=st.none() | st.just(WORDS)
    ),
    st.builds(
        c.SubmitForm,
        step=st.integers(-1, 30),
        submission_id=st.just("s"),
        content_hash=st.just(""),
        rules_met=st.sampled_from([(), (), (0,), (1, 2)]),
    ),
    st.just(c.OverrideStop(content=WORDS)),
    st.just(c.OverrideCheck(check="disk", content=WORDS)),
    st.builds(
        c.Materialise,
        by=st.just("headset"),
        client_t_s=st.just(1.0),
        headset_connected=st.booleans(),
    ),
    st.builds(c.RefuseConsent, by=st.just("tablet"), step=st.integers(-1, len(PLAN))),
    st.just(c.RetractRefusal(by="tablet")),
    st.just(c.RetractRefusal(by="operator", content=WORDS)),
    st.just(c.AskQuestion()),
    st.builds(c.CloseQuestion, outcome=st.sampled_from(["answered", "taken_back"])),
    st.builds(c.BeginPhase, headset_connected=st.booleans()),
    st.builds(c.Pause, content=st.none() | st.just(WORDS)),
    st.builds(c.Resume, headset_connected=st.booleans()),
    st.builds(c.Redo, content=st.just(WORDS), step=STEPS),
    st.just(c.Skip(content=WORDS)),
    st.just(c.AddNote(content=WORDS)),
    st.builds(
        c.Report,
        what=st.sampled_from((*REPORTS, "nonsense")),
        phase_id=st.integers(0, 6),
        client_t_s=st.just(1.0),
        active_s=TIMES,
    ),
    st.builds(c.HeadsetLost, active_s=TIMES, cause=st.just("headset_lost")),
    st.builds(c.RequestCalibration, headset_can=st.none() | st.booleans()),
    st.builds(
        c.ShiftTracker,
        goal=st.sampled_from(["Head", "LeftHand"]),
        shift_m=st.sampled_from([(0.0, 0.0, 0.0), (0.01, 0.0, -0.02)]),
        headset_can=st.booleans(),
    ),
    st.builds(
        c.ReportCalibration,
        cause=st.sampled_from(["first", "order"]),
        client_t_s=st.just(1.0),
        content=st.just(WORDS),
        revision=st.none() | st.integers(0, 60),
    ),
    st.builds(c.AskToStop, client_t_s=st.just(1.0)),
    st.builds(c.CloseStop, outcome=st.sampled_from(["answered", "taken_back"])),
)


def meant_by(name: str, state: SessionState) -> Command:
    """Return the command that a page sends when it offers `name`."""
    assert state.current is not None or name in ("start", "note")
    current = state.current or 0
    timed = PLAN[current].kind in ("task", "free_roam")
    return {
        "start": c.Start(),
        "note": c.AddNote(content=WORDS),
        "complete_step": c.CompleteStep(by="operator", step=current, content=WORDS),
        "enter_answers": c.SubmitForm(step=current, submission_id="s", content_hash="h"),
        "materialise": c.Materialise(by="operator", headset_connected=True),
        "begin_phase": c.BeginPhase(headset_connected=True),
        "pause": c.Pause(content=WORDS),
        "resume": c.Resume(headset_connected=True),
        "calibrate": c.RequestCalibration(headset_can=True),
        "shift_tracker": c.ShiftTracker(goal="Head", shift_m=(0.0, 0.01, 0.0), headset_can=True),
        "override_stop": c.OverrideStop(content=WORDS),
        "reopen_consent": c.RetractRefusal(by="operator", content=WORDS),
        "redo": c.Redo(content=WORDS, step=None if timed else current - 1),
        "skip": c.Skip(content=WORDS),
        "abort": c.Stop(status="aborted", content=WORDS),
        "withdraw": c.Stop(status="withdrawn", content=WORDS),
    }[name]


def fitting(state: SessionState, what: str, share: float) -> Command:
    """Return a valid report about the phase in progress, at a possible active time."""
    assert state.phase is not None
    left_s = (PLAN[state.phase.step].duration_s or 0.0) - state.phase.active_s
    whole = what in ("time_up", "ended")
    active_s = 0.0 if what == "started" else state.phase.active_s + left_s * (whole or share)
    return c.Report(what=what, phase_id=state.phase.phase_id, client_t_s=1.0, active_s=active_s)


class AnySession(RuleBasedStateMachine):
    """Send commands in any order: allowed ones, headset reports and invalid ones."""

    def __init__(self) -> None:
        super().__init__()
        self.run = Run()
        self.voided: set[int] = set()
        self.active_s: dict[int, float] = {}

    @rule(command=ANYTHING)
    def try_any_command(self, command: Command) -> None:
        """Any command is either accepted or refused."""
        self._do(command)

    @rule(data=st.data())
    def send_an_allowed_command(self, data: st.DataObject) -> None:
        """Send a command that the session allows, and only rarely one that ends it."""
        offered = allowed_commands(PLAN, self.run.state)
        name = data.draw(st.sampled_from([one for one in offered if one != "withdraw"]))
        if name != "abort" or data.draw(st.integers(0, 9)) == 0:
            self._do(meant_by(name, self.run.state))

    @precondition(lambda self: self.run.state.phase is not None)
    @rule(what=st.sampled_from(REPORTS), share=st.floats(0, 1))
    def send_a_valid_report(self, what: str, share: float) -> None:
        """Send a valid report about the phase in progress."""
        self._do(fitting(self.run.state, what, share))

    def _do(self, command: Command) -> None:
        before = self.run.state
        decided: list[Event] = []
        with contextlib.suppress(Refused):
            decided = self.run.do(command)
        assert self.run.state.version == before.version + len(decided)

    @invariant()
    def folding_all_events_gives_the_state(self) -> None:
        """Replaying all events gives the current state."""
        state = initial_state(len(PLAN))
        for event in self.run.events:
            state = evolve(state, event)
        assert state == self.run.state

    @invariant()
    def the_snapshot_is_the_state(self) -> None:
        """The state is unchanged after being stored as JSON and read back."""
        stored = json.loads(json.dumps(state_to_json(self.run.state), allow_nan=False))
        assert state_from_json(stored) == self.run.state

    @invariant()
    def active_time_never_decreases(self) -> None:
        """A phase's active time never decreases and never exceeds its duration."""
        state = self.run.state
        for phase in (*state.ended_phases, *([state.phase] if state.phase else [])):
            assert phase.active_s >= self.active_s.get(phase.phase_id, 0.0)
            assert phase.active_s <= (PLAN[phase.step].duration_s or 0.0) + 0.05
            self.active_s[phase.phase_id] = phase.active_s

    @invariant()
    def a_voided_phase_stays_void(self) -> None:
        """A voided phase stays void, and no phase id is used twice."""
        ended = self.run.state.ended_phases
        assert [phase.phase_id for phase in ended] == list(range(1, len(ended) + 1))
        voided = {phase.phase_id for phase in ended if phase.status is PhaseStatus.VOIDED}
        assert self.voided <= voided
        self.voided = voided

    @invariant()
    def one_step_is_current_while_active(self) -> None:
        """A session has a current step exactly while it is active."""
        assert (self.run.state.current is not None) == (self.run.state.status == "active")

    @invariant()
    def a_held_session_cannot_continue(self) -> None:
        """A held session is active and allows only ending, overriding and notes."""
        if self.run.state.held is not None and self.run.state.refused_consent is None:
            assert self.run.state.status == "active"
            offered = allowed_commands(PLAN, self.run.state)
            assert offered == ["abort", "withdraw", "override_stop", "note"]

    @invariant()
    def a_refused_consent_stops_the_session(self) -> None:
        """After a refused consent nothing that continues is allowed, and no phase keeps running."""
        state = self.run.state
        if state.refused_consent is None or state.status != "active":
            return
        assert allowed_commands(PLAN, state) == ["withdraw", "reopen_consent", "abort", "note"]
        assert state.phase is None or state.phase.status != "running" or state.phase.pausing

    @invariant()
    def every_allowed_command_is_accepted(self) -> None:
        """Every command listed as allowed is accepted."""
        for name in allowed_commands(PLAN, self.run.state):
            decide(PLAN, self.run.state, meant_by(name, self.run.state))


TestAnySession = AnySession.TestCase
TestAnySession.settings = settings(
    max_examples=usually(15, at_length=40), stateful_step_count=50, deadline=None
)


def events(kind: type[Event]) -> st.SearchStrategy[Event]:
    """Return a strategy for events of a type."""
    values: dict[str, st.SearchStrategy[object]] = {
        "str": st.text(),
        "int": st.integers(0),
        "float": st.floats(0, 1e6),
        "bool": st.booleans(),
        "tuple[float, float, float]": st.tuples(*[st.floats(-1, 1)] * 3),
        f"{Companion.__module__}.Companion": st.builds(
            Companion,
            position_m=st.tuples(*[st.floats(-9, 9)] * 2),
            heading_rad=st.floats(-4, 4),
        ),
        "dict[str, typing.Any]": st.dictionaries(st.text(), st.text() | st.booleans()),
    }
    strategies = {}
    for one in fields(kind):
        base, _, optional = str(one.type).partition(" |")
        name = base.removeprefix("<class '").removesuffix("'>")
        strategies[one.name] = values[name] | st.none() if optional else values[name]
    return st.builds(kind, **strategies)


@pytest.mark.parametrize("name", sorted(EVENT_TYPES))
@given(data=st.data())
@settings(max_examples=15)
def test_every_event_survives_being_stored(name: str, data: st.DataObject) -> None:
    """Every event read back from its JSON equals the original."""
    event = data.draw(events(EVENT_TYPES[name]))
    payload = json.loads(json.dumps(event_to_json(event)))
    assert event_from_json(event.type, payload) == event


def test_an_unknown_event_type_is_an_error() -> None:
    """Reading an event of an unknown type raises an error."""
    with pytest.raises(KeyError):
        event_from_json("teleported", {})
