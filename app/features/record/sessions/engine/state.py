"""The state of a session: an immutable value folded from its events."""

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from pydantic import TypeAdapter

from app.features.record.sessions.engine.events import Companion


class SessionStatus(StrEnum):
    """The status of a session."""

    PLANNED = "planned"
    ACTIVE = "active"
    COMPLETED = "completed"
    ABORTED = "aborted"
    WITHDRAWN = "withdrawn"


class StepStatus(StrEnum):
    """The status of a step of the procedure."""

    PENDING = "pending"
    CURRENT = "current"
    DONE = "done"
    SKIPPED = "skipped"


class PhaseStatus(StrEnum):
    """The status of a timed phase.

    preparing -> running <-> paused, running <-> walk_back, running -> freezing -> done. `voided`
    phases were repeated, skipped or broken off: their data are retained, but no summary uses them.
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
    """The state of one step. `attempt` starts at 1 and increases when the step is repeated."""

    status: StepStatus = StepStatus.PENDING
    attempt: int = 1


@dataclass(frozen=True)
class PhaseState:
    """The state of the current timed phase, or of one that has ended.

    `active_s` is the last value that is certain: the headset reports it at every change, and the
    telemetry carries it in between. `pausing` and `resuming`: the operator has requested it, and
    the headset has not confirmed it yet.
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
    """The stop rule (its index) that a form met, so that the session is held."""

    rule: int
    submission_id: str


@dataclass(frozen=True)
class AvatarChangesState:
    """How the running avatar was changed, by the study for a phase and by the operator.

    `revision`: the number of the event since which the two are in force. `reported`: the revision
    that the headset reported last, and whether it `applied` it; `content_id` is that of the report.
    """

    revision: int
    study: dict[str, Any] | None = None
    operator: dict[str, Any] | None = None
    reported: int | None = None
    applied: bool | None = None
    content_id: str | None = None


@dataclass(frozen=True)
class CalibrationState:
    """What the operator has ordered of the headset's calibration.

    `revision`: the number of the event since which it is in force. `asked`: the number of the
    event that asked for a calibration, None once it was reported. `shifts_m`: goal -> shift of its
    joint.
    """

    revision: int
    asked: int | None = None
    shifts_m: dict[str, tuple[float, float, float]] = field(default_factory=dict)

    @property
    def wanted(self) -> bool:
        """Return whether a calibration was asked for and has not been reported yet."""
        return self.asked is not None


@dataclass(frozen=True)
class TrackersState:
    """The lab's trackers that the headset uses: the door and the label of their source."""

    door: str
    source: str


@dataclass(frozen=True)
class SessionState:
    """The state of a session. `version` is the number of events folded so far.

    `held`: set from when a stop rule is met until the operator continues with a reason.
    `refused_consent`: the consent step at which the participant refused to take part; set until
    they change their mind, and also after the session has ended because of it. `question_open`: the
    participant has asked a question that has not been answered yet. `erased`: the participant's
    data were erased, and nothing more can be added. `avatar_changes`: None until the running avatar
    is changed, and after the session has ended; `calibration` likewise until something is ordered.
    `stop_asked`: the participant wants to stop, and the experimenter has not come yet. `trackers`:
    None while the headset uses none of the lab's, and after the session has ended; `companion`
    likewise while the participant is shown nobody else.
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
    avatar_changes: AvatarChangesState | None = None
    calibration: CalibrationState | None = None
    stop_asked: bool = False
    trackers: TrackersState | None = None
    companion: Companion | None = None

    @property
    def next_phase_id(self) -> int:
        """Return the id of the next phase; ids count from 1 in order of preparation."""
        return len(self.ended_phases) + (self.phase is not None) + 1


_ADAPTER = TypeAdapter(SessionState)


def state_to_json(state: SessionState) -> dict[str, Any]:
    """Return the snapshot of a state, which is stored with the session."""
    # Every command writes a snapshot, and dataclasses.asdict took sixteen times as long.
    snapshot: dict[str, Any] = _ADAPTER.dump_python(state)
    return snapshot


def state_from_json(snapshot: dict[str, Any]) -> SessionState:
    """Rebuild a state from its snapshot; raises pydantic.ValidationError if it is invalid."""
    return _ADAPTER.validate_python(snapshot)
