"""The JSON messages that the server sends to a headset."""

from typing import Annotated, Any, Literal

from pydantic import Field, TypeAdapter

from app.wire.basis import Message


class StreamPosition(Message):
    """All of `seq < next_seq` of a stream is on disk."""

    stream: str
    epoch: int
    next_seq: int


class PhaseOrder(Message):
    """The phase to run; the headset converges to it. Latency is known here and nowhere else.

    `until_completions`: a practice ends once so many tasks are completed, before its time is up;
    null everywhere else.
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


class ParticipantInfo(Message):
    """What the task needs to know of the participant; null until it was answered."""

    handedness: str | None = None
    footedness: str | None = None
    stature_m: float | None = None


class HeadsetState(Message):
    """Where the session stands, as the headset needs it."""

    type: Literal["state"] = "state"
    version: int
    status: str
    step_index: int | None
    step_kind: str | None
    materialised: bool
    recording: bool
    phase: PhaseOrder | None
    participant: ParticipantInfo


class Welcome(Message):
    """Answers a hello: the client's epoch, where each stream stands, the study's tasks."""

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


class Ack(Message):
    """These positions are on disk."""

    type: Literal["ack"] = "ack"
    positions: tuple[StreamPosition, ...]


class Resend(Message):
    """A seq was skipped: send again from `next_seq`."""

    type: Literal["resend"] = "resend"
    stream: str
    epoch: int
    next_seq: int


class Flag(Message):
    """Samples were stored as they came, and are flagged."""

    type: Literal["flag"] = "flag"
    code: Literal["non_finite", "non_unit"]
    stream: str
    epoch: int
    seq: int
    frames: int
    message: str


class RefusedReport(Message):
    """A report was stored and does not count, because it did not fit the session's state."""

    type: Literal["refused"] = "refused"
    epoch: int
    seq: int
    message: str
    remedy: str


class Failure(Message):
    """Why the server closes the connection."""

    type: Literal["error"] = "error"
    code: str
    message: str
    remedy: str


class ProbeAnswer(Message):
    """The server's clock around a probe."""

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
