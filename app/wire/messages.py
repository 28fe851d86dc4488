"""The JSON messages that accompany the binary batches, typed for headset and server.

A headset sends `hello` first and may then send `report`, `produced`, `probe` and `probed` messages
and binary batches. The server answers with `welcome`, and sends `state` on every change of the
session, `ack` after each commit, `resend` where it expected an earlier seq, `flag` for bad samples,
`refused` for a report that did not fit the session's state, and `error` before it closes.
"""

import math
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    TypeAdapter,
    model_validator,
)

PROTOCOL_VERSION = 1
SUBPROTOCOL = "reembody.v1"
REPORT_STREAM = "reports"
MAX_SEQ = 2**53
MAX_EPOCH = 2**31 - 1
GOALS = ("Hips", "Head", "LeftHand", "RightHand", "LeftLowerLeg", "RightLowerLeg")
"""The parts of the body whose goals may be tracked: those of inverse kinematics."""


def _number(value: object) -> object:
    """Return what is no truth value and no text, which would be taken for a number, and finite.

    1.0 is as good as 1: JSON does not tell them apart, and many clients know doubles only.
    """
    if isinstance(value, bool | str):
        raise ValueError("must be a number, not true, false or a text")
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError("must be a finite number")
    return value


_NUMBER = BeforeValidator(_number)
YesOrNo = Annotated[bool, Field(strict=True)]
Protocol = Annotated[int, _NUMBER]
Number = Annotated[int, _NUMBER, Field(ge=1, le=10_000)]
Seconds = Annotated[float, _NUMBER, Field(allow_inf_nan=False, ge=0.0, le=1e9)]
Seq = Annotated[int, _NUMBER, Field(ge=0, lt=MAX_SEQ)]
Epoch = Annotated[int, _NUMBER, Field(ge=1, le=MAX_EPOCH)]
Angle = Annotated[float, _NUMBER, Field(allow_inf_nan=False, ge=-7.0, le=7.0)]
Count = Annotated[int, _NUMBER, Field(ge=0, lt=2**31)]
Nanoseconds = Annotated[int, _NUMBER, Field(ge=0, lt=2**63)]
# PostgreSQL stores no NUL in a text.
Name = Annotated[str, Field(pattern=r"^[^\x00]*$")]
Goal = Literal["Hips", "Head", "LeftHand", "RightHand", "LeftLowerLeg", "RightLowerLeg"]
GoalState = Literal["tracked", "inferred", "lost"]
"""How a goal is known: measured; computed from the other goals; or not at all at the moment."""
Metres = Annotated[float, _NUMBER, Field(allow_inf_nan=False, ge=-10.0, le=10.0)]
Length = Annotated[float, _NUMBER, Field(allow_inf_nan=False, ge=0.0, le=10.0)]
Stature = Annotated[float, _NUMBER, Field(allow_inf_nan=False, ge=0.5, le=2.6)]
"""As far as a body can be built for it."""
Vector = tuple[Metres, Metres, Metres]
Cosine = Annotated[float, _NUMBER, Field(allow_inf_nan=False, ge=-1.001, le=1.001)]


class Message(BaseModel):
    """Base of all messages: frozen, without unknown fields."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Hello(Message):
    """The client's first message. `epoch` is null for a new run of the client.

    `avatars`: the kinds of avatar that the client can show. A client that cannot show the session's
    avatar is refused: the record would name an avatar that the participant did not see. `fingers`:
    this run sends the streams of fingers, too, with every frame from its first one on; phases
    without them are then reported as incomplete. `changes_avatar`: whether it can carry out an
    `AvatarOrder`, that is, change a physics avatar while it runs. `goals`: this run reports how the
    goals of the body are known, and every change (`GoalsReport`). `panels`: whether it shows the
    texts and forms of a `PanelOrder`. `calibrates`: whether it carries out a `CalibrationOrder`.
    """

    type: Literal["hello"] = "hello"
    protocol: Protocol
    client: Name = Field(max_length=120)
    epoch: Epoch | None = None
    avatars: tuple[Annotated[Name, Field(max_length=40)], ...] = Field(
        default=("delayed_copy",), max_length=10
    )
    fingers: YesOrNo = False
    changes_avatar: YesOrNo = Field(default=False, exclude_if=lambda value: not value)
    goals: YesOrNo = Field(default=False, exclude_if=lambda value: not value)
    panels: YesOrNo = Field(default=False, exclude_if=lambda value: not value)
    calibrates: YesOrNo = Field(default=False, exclude_if=lambda value: not value)

    @property
    def abilities(self) -> frozenset[str]:
        """What the client said that it can do, by the names of the fields."""
        fields = ("fingers", "changes_avatar", "goals", "panels", "calibrates")
        return frozenset(name for name in fields if getattr(self, name))


PhaseEvent = Literal[
    "started",
    "paused",
    "resumed",
    "walk_back_started",
    "walk_back_ended",
    "time_up",
    "ended",
]
"""What a headset can report about the clock of a phase."""


class PhaseReport(Message):
    """A change of a phase's clock by the headset, at the headset's monotonic time."""

    kind: Literal["phase"] = "phase"
    phase_id: Count
    what: PhaseEvent
    t_s: Seconds
    active_s: Seconds
    cause: Name = Field(default="headset", max_length=40)


class MaterialisedReport(Message):
    """Reports that the participant pressed the grips and the avatar appeared."""

    kind: Literal["materialised"] = "materialised"
    t_s: Seconds


class ContactReport(Message):
    """A finished contact of one body part with one surface, inside one active interval."""

    kind: Literal["contact"] = "contact"
    phase_id: Count
    surface: Name = Field(max_length=40)
    surface_kind: Literal["panel", "side", "target", "start"]
    box: Count | None = None
    side: Name | None = Field(default=None, max_length=20)
    body_part: Name = Field(max_length=40)
    begin_s: Seconds
    end_s: Seconds
    begin_active_s: Seconds
    end_active_s: Seconds
    effect: Name = Field(max_length=20)


class CompletionReport(Message):
    """Reports a completed task of a phase."""

    kind: Literal["completion"] = "completion"
    phase_id: Count
    number: Number
    t_s: Seconds
    active_s: Seconds
    duration_s: Seconds
    order: tuple[Count, ...] = Field(max_length=16)
    out_of_order_touches: Count


class AvatarChangeReport(Message):
    """Reports that the avatar follows the `AvatarOrder` of this revision, or why it does not.

    `t_s`: when it took effect. `held_rad`: for each axis in a cast, the angle at which it is held.
    """

    kind: Literal["avatar_changes"] = "avatar_changes"
    revision: Count
    t_s: Seconds
    applied: YesOrNo
    problem: Name | None = Field(default=None, max_length=300)
    held_rad: dict[Annotated[Name, Field(max_length=40)], Angle] = Field(
        default_factory=dict, max_length=200
    )


class GoalsReport(Message):
    """Reports how every goal is known from a frame on; sent when the run begins and on a change.

    `frame_seq`: the seq, in the streams of this epoch, of the first frame to which it applies.
    `source`: where the poses come from, such as controllers, hands, body, or script.
    """

    kind: Literal["goals"] = "goals"
    t_s: Seconds
    frame_seq: Seq
    source: Name = Field(max_length=40)
    states: dict[Goal, GoalState]

    @model_validator(mode="after")
    def _all_goals(self) -> Self:
        missing = [goal for goal in GOALS if goal not in self.states]
        if missing:
            raise ValueError(f"states must name all six goals; missing: {', '.join(missing)}")
        return self


class Pose(Message):
    """A position in metres and a rotation as a quaternion w, x, y, z."""

    position_m: Vector
    rotation: tuple[Cosine, Cosine, Cosine, Cosine]


class CalibrationReport(Message):
    """Reports a completed calibration of the participant's body, which is used from now on.

    `revision`: that of the `CalibrationOrder` it answers; null if the headset made it by itself,
    and `cause` says why: first, order, error (a goal was too far off) or reset (the origin moved).
    `tracker_from_goal`: for each goal that is tracked, the pose of the part's joint in the frame of
    what tracks it; for the head, that is the frame between the eyes. `residuals_m`: how far each
    goal was off in the poses that test the calibration. `sources`: what each goal was tracked by.
    `notices`: what the headset noticed, such as swapped_hands or bent_knees. `segments_m`: lengths
    that were measured, by the names of an avatar's segments.
    """

    kind: Literal["calibration"] = "calibration"
    t_s: Seconds
    revision: Count | None = None
    cause: Name = Field(max_length=40)
    stature_m: Stature
    span_m: Length | None = None
    eye_height_m: Length | None = None
    tracker_from_goal: dict[Goal, Pose] = Field(default_factory=dict)
    residuals_m: dict[Goal, Length] = Field(default_factory=dict)
    sources: dict[Goal, Annotated[Name, Field(max_length=40)]] = Field(default_factory=dict)
    notices: tuple[Annotated[Name, Field(max_length=40)], ...] = Field(default=(), max_length=20)
    segments_m: dict[Annotated[Name, Field(max_length=40)], Length] = Field(
        default_factory=dict, max_length=40, exclude_if=lambda value: not value
    )


class CalibrationStepReport(Message):
    """Reports how far a calibration is that is under way, for the operator to see.

    `step`: what the participant is asked to do (square, n_pose, t_pose, squat, reach, mirror), the
    `number`th of `total`. `problem`: what keeps it from being done; null while nothing does.
    """

    kind: Literal["calibration_step"] = "calibration_step"
    t_s: Seconds
    step: Name = Field(max_length=40)
    number: Count
    total: Count
    problem: Annotated[Name, Field(max_length=40)] | None = None


class AddedLatencyReport(Message):
    """Reports how much latency the headset's own computing adds in a phase.

    `added_s`: by which what is shown is late, such as one frame if the physics runs in a worker;
    `compensated_s`: how much of it was taken off the delay that the server ordered, which is
    possible only if that is long enough. The avatar is then late by what was ordered, plus
    `added_s` minus `compensated_s`. `runs_in`: where the body is computed.
    """

    kind: Literal["added_latency"] = "added_latency"
    phase_id: Count
    t_s: Seconds
    added_s: Annotated[float, _NUMBER, Field(allow_inf_nan=False, ge=0.0, le=1.0)]
    compensated_s: Annotated[float, _NUMBER, Field(allow_inf_nan=False, ge=0.0, le=1.0)]
    runs_in: Literal["page", "worker"]

    @model_validator(mode="after")
    def _no_more_than_added(self) -> Self:
        if self.compensated_s > self.added_s:
            raise ValueError("compensated_s must be at most added_s")
        return self


class CallReport(Message):
    """Reports that the participant called from inside the headset.

    `stop`: wants to stop now, so a running phase is paused; `help`: wants to speak to the
    experimenter; `taken_back`: no longer does.
    """

    kind: Literal["call"] = "call"
    t_s: Seconds
    what: Literal["stop", "help", "taken_back"]


ReportBody = Annotated[
    PhaseReport
    | MaterialisedReport
    | ContactReport
    | CompletionReport
    | AvatarChangeReport
    | GoalsReport
    | CalibrationReport
    | CalibrationStepReport
    | AddedLatencyReport
    | CallReport,
    Field(discriminator="kind"),
]


class Report(Message):
    """A numbered report: journaled by the client until it is acknowledged, like a batch."""

    type: Literal["report"] = "report"
    epoch: Epoch
    seq: Seq
    body: ReportBody


class Probe(Message):
    """A request for the server's clock reading."""

    type: Literal["probe"] = "probe"
    client_sent_s: Seconds


class Probed(Message):
    """The client's raw readings of one clock probe; all null if no answer came in time."""

    type: Literal["probed"] = "probed"
    client_sent_s: Seconds
    server_received_ns: Nanoseconds | None
    server_sent_ns: Nanoseconds | None
    client_received_s: Seconds | None

    @model_validator(mode="after")
    def _whole_or_null(self) -> Self:
        times = (self.server_received_ns, self.server_sent_ns, self.client_received_s)
        if len({time is None for time in times}) > 1:
            raise ValueError("give all three times of an answer, or null for all three")
        return self


class Produced(Message):
    """The next seq of each of the client's streams in an epoch, whether sent or not.

    It is compared with what the server has stored, so that no loss goes unnoticed.
    """

    type: Literal["produced"] = "produced"
    epoch: Epoch
    streams: dict[
        Literal["target", "actual", "target_fingers", "actual_fingers", "reports"], Seq
    ] = Field(max_length=5)


ClientMessages = Hello | Report | Probe | Probed | Produced
ClientMessage = Annotated[ClientMessages, Field(discriminator="type")]
CLIENT_MESSAGE: TypeAdapter[ClientMessages] = TypeAdapter(ClientMessage)


class StreamPosition(Message):
    """A position in a stream, before which everything (`seq < next_seq`) is on disk."""

    stream: str
    epoch: int
    next_seq: int


class PhaseOrder(Message):
    """The phase to run, to which the headset brings its own state.

    Of the headset's messages only this one contains the latency. `until_completions`: the phase
    ends once this many tasks or crossings are completed, before its time is up; null if it does
    not. `has_road`: the participant crosses the welcome's `road`, whose socket is open meanwhile.
    `body`: the name of the body to wear, one of the welcome's `bodies`; null for that of the
    avatar's configuration.
    """

    phase_id: int
    kind: str
    limb: str | None
    status: str
    latency_ms: float
    preparation_s: float
    duration_s: float
    freeze_s: float
    active_s: float
    completions: int
    pausing: bool
    resuming: bool
    until_completions: int | None = None
    # Left out if not set: older clients do not know them, and accept no unknown fields.
    has_road: bool = Field(default=False, exclude_if=lambda value: not value)
    body: str | None = Field(default=None, exclude_if=lambda value: value is None)


class LayerOrder(Message):
    """Whether the parts of two collision layers collide."""

    layers: tuple[str, str]
    collide: bool


class MotorOrder(Message):
    """The gains and greatest torque of one axis."""

    kp_nm_per_rad: float
    kd_nm_s_per_rad: float
    max_torque_nm: float


class AvatarOrder(Message):
    """How the avatar differs from its configuration now; what is left out is as configured.

    It lists all changes in force: a client applies them to its body and reports `revision`, which
    rises with every change. `colliders`: body part -> simple, mesh or none. `layers`: pairs that
    collide, or that no longer do. `held_rad`: axes in a cast -> angle, or null for the angle at
    which the axis is when the client first learns of it. `motors`: axes with other gains.
    """

    revision: int
    gravity: bool | None = None
    self_collision: bool | None = None
    colliders: dict[str, Literal["simple", "mesh", "none"]] = Field(default_factory=dict)
    layers: tuple[LayerOrder, ...] = ()
    held_rad: dict[str, float | None] = Field(default_factory=dict)
    motors: dict[str, MotorOrder] = Field(default_factory=dict)


class CalibrationOrder(Message):
    """How the calibration should differ from the headset's own; replaces earlier orders.

    `revision` rises with every change. `calibrate`: calibrate again now, and report it with this
    revision; the step and its phase stay as they are. `shifts_m`: goal -> shift of the part's
    joint, x to the right, y up and z backwards, in the axes that the part has in the T-pose. A new
    calibration ends the shifts of the one before.
    """

    revision: int
    calibrate: bool
    shifts_m: dict[str, tuple[float, float, float]] = Field(default_factory=dict)


class PanelOrder(Message):
    """What the participant should read, answer or do beside the scene, in the session's language.

    `title` and `text` are those of the current step, or the study's waiting text. `form`: the key
    of the form to fill in inside the headset, which `GET /api/vr/form` returns. `answer`: where the
    current form is answered; null if no form is due. `acknowledge`: the participant may complete
    the step inside the headset (`POST /api/vr/acknowledge`), having read its text. `headset_off`:
    the step takes place outside the headset, so the participant should take it off. `held`: the
    session waits for the experimenter. `called`: the participant has called, and nobody has come
    yet. `limb`: what the current step's task is done with; left out if it is no task.
    `screen_texts`: the study's words for `freeze` and `walk_back`, as far as it has any.
    """

    language: str
    title: str | None
    text: str | None
    form: str | None
    answer: Literal["headset", "tablet", "oral"] | None
    acknowledge: bool
    headset_off: bool
    held: bool
    called: bool
    limb: Literal["hand", "foot"] | None = Field(
        default=None, exclude_if=lambda value: value is None
    )
    screen_texts: dict[str, str] = Field(default_factory=dict, exclude_if=lambda value: not value)


class ParticipantInfo(Message):
    """The facts about the participant that the task needs; null until they are known."""

    handedness: str | None = None
    footedness: str | None = None
    stature_m: float | None = None


class HeadsetState(Message):
    """The state of the session, as far as the headset needs it."""

    type: Literal["state"] = "state"
    version: int
    status: str
    step_index: int | None
    step_kind: str | None
    materialised: bool
    recording: bool
    phase: PhaseOrder | None
    participant: ParticipantInfo
    # Only sent once something was changed, so that older clients notice nothing.
    avatar_changes: AvatarOrder | None = Field(default=None, exclude_if=lambda value: value is None)
    # Only for clients that said `panels`, and `calibrates` once something was ordered.
    panel: PanelOrder | None = Field(default=None, exclude_if=lambda value: value is None)
    calibration: CalibrationOrder | None = Field(
        default=None, exclude_if=lambda value: value is None
    )


class Welcome(Message):
    """The answer to a hello: the client's epoch, the position of each stream, the study's tasks.

    `bodies`: the bodies that conditions of the study name, in the order of its file; left out if
    there are none. A client requests the avatar of each before the first block. `appearance`: the
    palettes of the study's boxes, as in its file. `road`: the road that participants cross, its
    sizes only; left out if the study has none.
    """

    type: Literal["welcome"] = "welcome"
    protocol: int
    session_id: str
    epoch: int
    time_scale: float
    language: str
    avatar: str
    on_disconnect: str
    undelayed_parts: tuple[str, ...]
    tasks: dict[str, Any]
    texts: dict[str, Any]
    positions: tuple[StreamPosition, ...]
    state: HeadsetState
    bodies: tuple[str, ...] = Field(default=(), exclude_if=lambda value: not value)
    appearance: dict[str, Any] = Field(default_factory=dict, exclude_if=lambda value: not value)
    road: dict[str, Any] = Field(default_factory=dict, exclude_if=lambda value: not value)


class Ack(Message):
    """Acknowledges that everything before these positions is on disk."""

    type: Literal["ack"] = "ack"
    positions: tuple[StreamPosition, ...]


class Resend(Message):
    """A seq was skipped: the client must send again from `next_seq`."""

    type: Literal["resend"] = "resend"
    stream: str
    epoch: int
    next_seq: int


class Flag(Message):
    """Reports bad samples, which were stored unchanged and are flagged."""

    type: Literal["flag"] = "flag"
    code: Literal["non_finite", "non_unit"]
    stream: str
    epoch: int
    seq: int
    frames: int
    message: str


class RefusedReport(Message):
    """A report was stored but does not count, because it did not fit the session's state."""

    type: Literal["refused"] = "refused"
    epoch: int
    seq: int
    message: str
    remedy: str


class Failure(Message):
    """The reason why the server closes the connection."""

    type: Literal["error"] = "error"
    code: str
    message: str
    remedy: str


class ProbeAnswer(Message):
    """The server's clock readings when it received a probe and when it answered."""

    type: Literal["probe"] = "probe"
    client_sent_s: float
    server_received_ns: int
    server_sent_ns: int


ServerMessage = Annotated[
    Welcome | HeadsetState | Ack | Resend | Flag | RefusedReport | Failure | ProbeAnswer,
    Field(discriminator="type"),
]
SERVER_MESSAGE: TypeAdapter[
    Welcome | HeadsetState | Ack | Resend | Flag | RefusedReport | Failure | ProbeAnswer
] = TypeAdapter(ServerMessage)
