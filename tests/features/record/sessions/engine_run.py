"""A session engine driven by hand: its plan, its events and the state that follows from them."""

from dataclasses import dataclass, field
from typing import get_args

from app.features.record.sessions.engine import (
    Command,
    ContentRef,
    Event,
    SessionState,
    decide,
    evolve,
    initial_state,
)
from app.features.record.sessions.engine import commands as c
from app.protocol.plan import Step, compile_plan
from app.wire.messages import PhaseEvent
from tests.protocol.helpers import study

PLAN: tuple[Step, ...] = compile_plan(study(), ("latency_125", "latency_0", "latency_350"))
WORDS = ContentRef("content", "hash")
REPORTS: tuple[str, ...] = get_args(PhaseEvent)


def index_of(key: str) -> int:
    """Return the index of the step with that key in the plan."""
    return next(step.index for step in PLAN if step.key == key)


@dataclass
class Run:
    """A session that is run without a database."""

    state: SessionState = field(default_factory=lambda: initial_state(len(PLAN)))
    events: list[Event] = field(default_factory=list)

    def do(self, command: Command) -> list[Event]:
        """Decide a command and apply its events; `Refused` leaves the state unchanged."""
        decided = decide(PLAN, self.state, command)
        for event in decided:
            self.state = evolve(self.state, event)
        self.events += decided
        return decided

    @property
    def step(self) -> Step:
        """The current step."""
        assert self.state.current is not None
        return PLAN[self.state.current]

    def go_to(self, key: str) -> "Run":
        """Start the session if needed and skip every step before `key`."""
        if self.state.current is None:
            self.do(c.Start())
        while self.step.key != key:
            self.do(c.Skip(content=WORDS))
        return self

    def report(self, what: str, active_s: float, client_t_s: float = 1.0) -> list[Event]:
        """Report a change of the phase in progress, in the role of the headset."""
        assert self.state.phase is not None
        return self.do(
            c.Report(
                what=what,
                phase_id=self.state.phase.phase_id,
                client_t_s=client_t_s,
                active_s=active_s,
            )
        )

    def begin(self, key: str) -> "Run":
        """Go to the step `key` and start the clock of its phase."""
        self.go_to(key)
        self.do(c.BeginPhase(headset_connected=True))
        self.report("started", 0.0)
        return self

    def finish(self) -> "Run":
        """Use up the time of the running phase and end it."""
        duration_s = self.step.duration_s or 0.0
        self.report("time_up", duration_s)
        self.report("ended", duration_s)
        return self
