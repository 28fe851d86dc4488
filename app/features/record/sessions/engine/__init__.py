"""The session as pure functions: `decide(plan, state, command) -> events`, `evolve(...) -> state`.

Nothing here uses a database, a clock or a network. A command is decided against the state and gives
events; the state is the fold of the events. So a server resumes after a crash by folding the events
again, and the record contains exactly what determined the state.
"""

from app.features.record.sessions.engine.allowed import allowed_commands
from app.features.record.sessions.engine.commands import Command, ContentRef
from app.features.record.sessions.engine.decide import Refused, decide
from app.features.record.sessions.engine.events import (
    EVENT_TYPES,
    Event,
    event_from_json,
    event_to_json,
)
from app.features.record.sessions.engine.evolve import evolve, initial_state
from app.features.record.sessions.engine.state import (
    PhaseStatus,
    SessionState,
    SessionStatus,
    StepStatus,
    state_from_json,
    state_to_json,
)

__all__ = [
    "EVENT_TYPES",
    "Command",
    "ContentRef",
    "Event",
    "PhaseStatus",
    "Refused",
    "SessionState",
    "SessionStatus",
    "StepStatus",
    "allowed_commands",
    "decide",
    "event_from_json",
    "event_to_json",
    "evolve",
    "initial_state",
    "state_from_json",
    "state_to_json",
]
