"""The JSON messages that a headset sends beside its binary batches."""

from typing import Annotated, Literal, Self

from pydantic import Field, TypeAdapter, model_validator

from app.wire.basis import Count, Epoch, Message, Name, Nanoseconds, Seconds, Seq


class Hello(Message):
    """Opens a connection. `epoch` is null for a new run of the client.

    `avatars`: what the client can show. One that cannot show the session's avatar is refused: the
    record would name another than the participant saw.
    """

    type: Literal["hello"] = "hello"
    protocol: int
    client: Name = Field(max_length=120)
    epoch: Epoch | None = None
    avatars: tuple[Annotated[Name, Field(max_length=40)], ...] = Field(
        default=("delayed_copy",), max_length=10
    )


class PhaseReport(Message):
    """What the headset did to the clock of a phase, at its own monotonic time."""

    kind: Literal["phase"] = "phase"
    phase_id: Count
    what: Literal[
        "started",
        "paused",
        "resumed",
        "walk_back_started",
        "walk_back_ended",
        "time_up",
        "ended",
    ]
    t_s: Seconds
    active_s: Seconds
    cause: Name = Field(default="headset", max_length=40)


class MaterialisedReport(Message):
    """The participant pressed the grips and the avatar appeared."""

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
    """A completed task."""

    kind: Literal["completion"] = "completion"
    phase_id: Count
    number: int = Field(ge=1, le=10_000)
    t_s: Seconds
    active_s: Seconds
    duration_s: Seconds
    order: tuple[Count, ...] = Field(max_length=16)
    out_of_order_touches: Count


ReportBody = Annotated[
    PhaseReport | MaterialisedReport | ContactReport | CompletionReport,
    Field(discriminator="kind"),
]


class Report(Message):
    """A numbered report: journaled by the client until it is acknowledged, like a batch."""

    type: Literal["report"] = "report"
    epoch: Epoch
    seq: Seq
    body: ReportBody


class Probe(Message):
    """Asks for the server's clock."""

    type: Literal["probe"] = "probe"
    client_sent_s: Seconds


class Probed(Message):
    """The client's raw reading of one exchange; all null where no answer came in time."""

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
    """How far the client itself has come in an epoch: its next seqs, sent or not.

    What the server holds is compared with this, so that nothing can be missing unnoticed.
    """

    type: Literal["produced"] = "produced"
    epoch: Epoch
    streams: dict[Literal["target", "actual", "reports"], Seq] = Field(max_length=3)


ClientMessages = Hello | Report | Probe | Probed | Produced
ClientMessage = Annotated[ClientMessages, Field(discriminator="type")]
CLIENT_MESSAGE: TypeAdapter[ClientMessages] = TypeAdapter(ClientMessage)
