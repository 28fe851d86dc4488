"""Request and response models of the session endpoints."""

from datetime import datetime
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from app.features.record.alarms import AlarmView
from app.features.record.ledger import Kind, Shortfall
from app.features.record.questionnaires import StoredScores
from app.features.record.self_tests import RunningTest
from app.features.record.sessions import ConsentForm, PaperConsent
from app.protocol import AvatarChanges, FormPlace, StepKind

Status = Literal["planned", "active", "completed", "aborted", "withdrawn"]
StepStatus = Literal["pending", "current", "done", "skipped"]
CurrentStatus = Literal["ready", "preparing", "running", "paused", "walk_back", "freezing"]
PhaseStatus = Literal["preparing", "running", "paused", "walk_back", "freezing", "done", "voided"]
LimbName = Literal["hand", "foot"]
CommandType = Literal[
    "start",
    "complete_step",
    "begin_phase",
    "materialise",
    "pause",
    "resume",
    "redo",
    "skip",
    "abort",
    "withdraw",
    "override_stop",
    "reopen_consent",
    "change_avatar",
    "calibrate",
    "shift_tracker",
    "note",
]
GoalName = Literal["Hips", "Head", "LeftHand", "RightHand", "LeftLowerLeg", "RightLowerLeg"]
ShiftCm = Annotated[float, Field(ge=-50.0, le=50.0, allow_inf_nan=False)]
"""A shift in one direction, in centimetres."""

NEVER_STALE: tuple[CommandType, ...] = ("note", "pause", "abort", "withdraw")
"""Commands that are accepted on any version of the session.

A note cannot conflict with anything. A stop must take effect whatever was written or reported in
the meantime: a participant who feels sick must not wait for a page to reload.
"""

AllowedType = CommandType | Literal["enter_answers"]


class NewSession(BaseModel):
    """A request to create a session of a study.

    A repeated `request_id` creates no second session.
    """

    model_config = ConfigDict(extra="forbid")

    request_id: str | None = Field(default=None, min_length=8, max_length=36)

    participant_code: str | None = None
    kind: Kind = "people"
    language: str = "en"
    time_scale: float = Field(default=1.0, allow_inf_nan=False)


class Height(BaseModel):
    """The participant's height as stated and as matched to the avatar, in metres."""

    model_config = ConfigDict(extra="forbid")

    stated: float | None = Field(default=None, ge=0.8, le=2.5)
    matched: float | None = Field(default=None, ge=0.8, le=2.5)


class TrackerShift(BaseModel):
    """A shift of the joint of `goal` from where its tracker says, in centimetres, in all.

    To the participant's right, up, and to the back, in the axes that the part has in the T-pose.
    Three zeros take an earlier shift back.
    """

    model_config = ConfigDict(extra="forbid")

    goal: GoalName
    right_cm: ShiftCm
    up_cm: ShiftCm
    back_cm: ShiftCm


class CommandRequest(BaseModel):
    """An operator's command, with the version of the session that their page showed.

    Commands in `NEVER_STALE` apply to any version and may omit `expected_version`.
    `avatar_changes` replaces the operator's earlier changes; empty, it takes them back.
    """

    model_config = ConfigDict(extra="forbid")

    command_id: str = Field(min_length=8, max_length=36)
    expected_version: int | None = Field(default=None, ge=0, lt=2**31)
    type: CommandType
    reason: str | None = Field(default=None, max_length=2000)
    text: str | None = Field(default=None, max_length=4000)
    step_index: int | None = Field(default=None, ge=0, lt=1000)
    height_m: Height | None = None
    paper_consent: PaperConsent | None = None
    avatar_changes: AvatarChanges | None = None
    tracker_shift: TrackerShift | None = None

    @model_validator(mode="after")
    def _on_a_version(self) -> Self:
        if self.expected_version is None and self.type not in NEVER_STALE:
            raise ValueError(f"expected_version is missing: {self.type} applies to one version")
        if self.type == "change_avatar" and self.avatar_changes is None:
            raise ValueError("avatar_changes is missing: {} takes the operator's changes back")
        return self


class Reveal(BaseModel):
    """The reason for showing the condition of a blinded session before the session has ended."""

    model_config = ConfigDict(extra="forbid")

    reason: str = Field(max_length=2000)


class SlotInfo(BaseModel):
    """The slot of the ledger that a session occupies."""

    index: int
    block: int
    replicate: int


class StepView(BaseModel):
    """A step of the procedure; fields that do not apply are null."""

    index: int
    key: str
    kind: StepKind
    title: str
    block: int | None
    latency_ms: float | None
    body: str | None
    limb: LimbName | None
    preparation_s: float | None
    duration_s: float | None
    freeze_s: float | None
    instrument: str | None
    status: StepStatus
    attempt: int
    reason: str | None
    consent: ConsentForm | None = None
    until_completions: int | None = None
    avatar_changes: AvatarChanges | None = None
    forms: FormPlace = "tablet"


class CurrentView(BaseModel):
    """The current step of a session; `status` is `ready` or the status of its phase."""

    index: int
    status: CurrentStatus
    active_s: float
    duration_s: float | None
    pausing: bool
    resuming: bool
    pause_reason: str | None


class HeldView(BaseModel):
    """The stop rule that holds a session: the limit `stop_at` on a score, or on its rise."""

    rule: int
    instrument: str
    score: str
    stop_at: float
    is_rise: bool


class RefusalView(BaseModel):
    """A participant's refusal to take part, given at the consent step `step` at the time `at`.

    `at` is null if the event log was restored without its alarms.
    """

    step: int
    at: datetime | None


class DeviceView(BaseModel):
    """A device that is paired with a session; `self_test`: what a headset makes of itself now."""

    id: str
    kind: Literal["tablet", "headset"]
    name: str
    paired_at: datetime
    connected: bool
    last_seen_at: datetime | None
    self_test: RunningTest | None


class PhaseView(BaseModel):
    """A phase that has been prepared, with what has happened in it so far.

    `side_contacts` counts how many times a side turned red; `side_contact_s` is the total duration,
    in seconds of active time. Both, and `completions`, are null for blinded readers until the phase
    has ended: the moment at which they rise reveals the latency.

    `active_s` is null for a voided phase in an older record, which does not say how far it was.

    The achieved latency is measured once the phase has ended; `movement_s` is null until then. It
    has a 95 % interval; if it cannot be determined, it is null and `latency_reason` says why.
    `latency_off`: whether it deviates by more than 10 ms and more than one frame, which is all that
    a blinded operator is shown.
    """

    phase_id: int
    step_index: int
    attempt: int
    kind: StepKind
    limb: LimbName | None
    latency_ms: float | None
    body: str | None
    status: PhaseStatus
    active_s: float | None
    completions: int | None
    side_contacts: int | None
    side_contact_s: float | None
    achieved_latency_ms: float | None
    achieved_low_ms: float | None
    achieved_high_ms: float | None
    latency_off: bool | None
    latency_reason: str | None
    movement_s: float | None
    started_at: datetime | None
    ended_at: datetime | None


class NoteView(BaseModel):
    """A note that the lab wrote during a session."""

    id: str
    text: str
    at: datetime
    by: str


class SessionSummary(BaseModel):
    """A row in a list of sessions.

    `sequence`: the latencies of its blocks in ms. `bodies`: the body worn at each of them, null for
    that of the configuration; null instead of the list for blinded readers, and where latencies
    tell the conditions apart.
    `shortfalls`: the rules of its study that a completed session does not meet; it is valid if
    there are none. Null if the study has no rules, or the session is not completed.
    """

    id: str
    participant_code: str
    kind: Kind
    simulated: bool
    status: Status
    sequence: list[float] | None
    bodies: list[str | None] | None = None
    study_version: int
    created_at: datetime
    started_at: datetime | None
    ended_at: datetime | None
    end_reason: str | None = None
    shortfalls: list[Shortfall] | None


class StepBrief(BaseModel):
    """Where a running session is: the step's index, counted from 0, of how many, and what it is."""

    index: int
    steps: int
    kind: StepKind
    limb: LimbName | None
    paused: bool


class ListedSession(SessionSummary):
    """A row in a study's list of sessions; `step` is null unless the session runs."""

    step: StepBrief | None = None


class AvatarChangesView(BaseModel):
    """The changes to the avatar that are in force: those of the study, and those of the operator.

    `applied`: whether the headset has carried them out, or null while it has not answered;
    `problem`: why it could not, in the headset's words; null for readers who must not know the
    condition, because the words may name the body. `gravity`, `self_collision`, parts in a cast
    (`held_parts`) and parts without collider (`passing_parts`) are those that result, with the
    avatar's configuration.
    """

    revision: int
    study: AvatarChanges | None
    operator: AvatarChanges | None
    applied: bool | None
    problem: str | None
    gravity: bool
    self_collision: bool
    held_parts: list[str]
    passing_parts: list[str]


class GoalsView(BaseModel):
    """How the headset knows the goals of the body, and where their poses come from."""

    source: str
    states: dict[GoalName, Literal["tracked", "inferred", "lost"]]


class CalibrationStepView(BaseModel):
    """How far a calibration under way is; `problem`: what keeps the step from being done."""

    step: str
    number: int
    total: int
    problem: str | None


class BodyCalibrationView(BaseModel):
    """The newest calibration of the headset, and what the operator ordered since.

    `at` and what was measured are null before the first calibration; `residuals_cm`: how far each
    goal was off in the poses that test it. `wanted`: a calibration was ordered and has not been
    reported yet. `shifts_cm`: shifts in force, to the right, up and to the back. `underway`: null
    while the participant is not being calibrated.
    """

    at: datetime | None
    cause: str | None
    stature_m: float | None
    span_m: float | None
    eye_height_m: float | None
    residuals_cm: dict[GoalName, float]
    sources: dict[GoalName, str]
    notices: list[str]
    wanted: bool
    shifts_cm: dict[GoalName, tuple[float, float, float]]
    underway: CalibrationStepView | None


class NamedAvatar(BaseModel):
    """The version of an avatar that a study names, and the name that people gave the avatar."""

    key: str
    title: str
    version: int


class SessionView(SessionSummary):
    """Everything the cockpit shows of a session.

    `sequence` and latencies are null if the reader is `blinded`. `avatar_configuration_hash`
    identifies the content of the physics avatar, `avatar_version` where it is found; both are null
    for an avatar without physics. `study_title`: by language. `alarms`: the open alarms, oldest
    first. `avatar_changes`: null until the running avatar is changed. `goals`: null unless the
    headset's program reports them. `calibration`: null before the first calibration begins or is
    ordered.
    """

    blinded: bool
    study_key: str
    study_title: dict[str, str]
    avatar: str
    avatar_configuration_hash: str | None
    avatar_version: NamedAvatar | None
    language: str
    version: int
    time_scale: float
    slot: SlotInfo
    steps: list[StepView]
    current: CurrentView | None
    held: HeldView | None
    refusal: RefusalView | None
    allowed: list[AllowedType]
    devices: list[DeviceView]
    alarms: list[AlarmView]
    phases: list[PhaseView]
    notes: list[NoteView]
    scores: list[StoredScores]
    avatar_changes: AvatarChangesView | None = None
    goals: GoalsView | None = None
    calibration: BodyCalibrationView | None = None


class EventView(BaseModel):
    """An event of a session's log."""

    seq: int
    type: str
    at: datetime
    by: str
    data: dict[str, Any]
    hash: str | None


class StreamView(BaseModel):
    """The amount of one stream that is on disk, for one epoch of the headset.

    `frames_flagged`: how many have values that no summary uses; null for blinded readers, except of
    the participant's own movement.
    """

    stream: str
    epoch: int
    next_seq: int
    frames_stored: int
    frames_flagged: int | None
