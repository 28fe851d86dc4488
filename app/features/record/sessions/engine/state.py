"""Where a session stands: a frozen value, folded from its events."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from pydantic import TypeAdapter


class SessionStatus(StrEnum):
    """The life of a session."""

    PLANNED = "planned"
    ACTIVE = "active"
    COMPLETED = "completed"
    ABORTED = "aborted"
    WITHDRAWN = "withdrawn"


class StepStatus(StrEnum):
    """The life of a step of the procedure."""

    PENDING = "pending"
    CURRENT = "current"
    DONE = "done"
    SKIPPED = "skipped"


class PhaseStatus(StrEnum):
    """The life of a timed phase.

    preparing -> running <-> paused, running <-> walk_back, running -> freezing -> done.
    `voided` phases were redone, skipped or broken off: their data stay, no summary uses them.
    """

    PREPARING = "preparing"
    RUNNING = "running"
    PAUSED = "paused"
    WALK_BACK = "walk_back"
    FREEZING = "freezing"
    DONE = "done"
    VOIDED = "voided"


@dataclass(frozen=True)
class StepState:
    """One step. `attempt` starts at 1 and grows when the step is done over."""

    status: StepStatus = StepStatus.PENDING
    attempt: int = 1


@dataclass(frozen=True)
class PhaseState:
    """The timed phase under way, or one that has ended.

    `active_s` is the last value that is known for certain: the headset reports it at every change
    and the telemetry carries it in between. `pausing` and `resuming` are the operator's wish until
    the headset reports that it did so.
    """

    phase_id: int
    step: int
    attempt: int
    status: PhaseStatus
    active_s: float = 0.0
    pausing: bool = False
    resuming: bool = False
    pause_cause: str | None = None


@dataclass(frozen=True)
class Hold:
    """Why the session may not simply go on: a form met a stop rule of the study (its index)."""

    rule: int
    submission_id: str


@dataclass(frozen=True)
class SessionState:
    """The whole state. `version` is the number of events folded so far.

    `held`: set from a stop rule that was met until the operator goes on with a reason.
    `refused_consent`: the consent step at which the participant said that they do not want to take
    part; set until they change their mind, also after the session has ended because of it.
    `question_open`: the participant has asked a question that nobody has answered yet.
    `erased`: the participant's data are gone, and nothing is added any more.
    """

    version: int
    status: SessionStatus
    steps: tuple[StepState, ...]
    current: int | None = None
    phase: PhaseState | None = None
    ended_phases: tuple[PhaseState, ...] = ()
    materialised: bool = False
    held: Hold | None = None
    refused_consent: int | None = None
    question_open: bool = False
    erased: bool = False

    @property
    def next_phase_id(self) -> int:
        """Phase ids count from 1 in order of preparation."""
        return len(self.ended_phases) + (self.phase is not None) + 1


_ADAPTER = TypeAdapter(SessionState)


def state_to_json(state: SessionState) -> dict[str, Any]:
    """The snapshot that is stored beside the events."""
    # Every command writes one: dataclasses.asdict took sixteen times as long.
    snapshot: dict[str, Any] = _ADAPTER.dump_python(state)
    return snapshot


def state_from_json(snapshot: dict[str, Any]) -> SessionState:
    """The state in a snapshot; raises pydantic.ValidationError if it is not one."""
    return _ADAPTER.validate_python(snapshot)
