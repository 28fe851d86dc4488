"""Tables of telemetry: streams, batches, chunks, reports, contacts, joint errors."""

from datetime import datetime
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    LargeBinary,
    String,
)
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime


class TelemetryStream(Base):
    """A stream of one client run (epoch), of which everything with `seq < next_seq` is stored.

    `produced` is the next seq that the client has reported: what lies between is still in its
    journal, or was lost with it. `phase_id` and `active_s` are those of the newest stored frame:
    after a crash they show how much active time is certain. `abilities`: what the client run said
    that it can do, on its stream of reports; None on all others, and for runs that were recorded
    before it was stored.
    """

    __tablename__ = "telemetry_streams"

    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), primary_key=True)
    stream: Mapped[str] = mapped_column(String(20), primary_key=True)
    epoch: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    next_seq: Mapped[int] = mapped_column(BigInteger, default=0)
    produced: Mapped[int] = mapped_column(BigInteger, default=0, server_default="0")
    frames_stored: Mapped[int] = mapped_column(BigInteger, default=0)
    frames_flagged: Mapped[int] = mapped_column(BigInteger, default=0)
    phase_id: Mapped[int] = mapped_column(default=0)
    active_s: Mapped[float] = mapped_column(default=0.0)
    first_at: Mapped[UtcTime]
    last_at: Mapped[UtcTime]
    abilities: Mapped[list[str] | None] = mapped_column(JSON(none_as_null=True))


class TelemetryBatch(Base):
    """A message exactly as received, kept until it is merged into a chunk."""

    __tablename__ = "telemetry_batches"

    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), primary_key=True)
    stream: Mapped[str] = mapped_column(String(20), primary_key=True)
    epoch: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    seq_first: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    frame_count: Mapped[int]
    phase_id: Mapped[int]
    received_at: Mapped[UtcTime] = mapped_column(index=True)
    message: Mapped[bytes] = mapped_column(LargeBinary)


class TelemetryChunk(Base):
    """About one second of a stream in compressed columns, lossless; it never spans two phases."""

    __tablename__ = "telemetry_chunks"
    __table_args__ = (Index("ix_telemetry_chunks_phase", "session_id", "phase_id", "stream"),)

    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), primary_key=True)
    stream: Mapped[str] = mapped_column(String(20), primary_key=True)
    epoch: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    seq_first: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    frame_count: Mapped[int]
    phase_id: Mapped[int]
    values_per_frame: Mapped[int]
    t_first_s: Mapped[float]
    t_last_s: Mapped[float]
    encoding: Mapped[str] = mapped_column(String(40))
    data: Mapped[bytes] = mapped_column(LargeBinary)


class ClientReport(Base):
    """A headset's report as received, and whether the server accepted it."""

    __tablename__ = "client_reports"

    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), primary_key=True)
    epoch: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    seq: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    type: Mapped[str] = mapped_column(String(40))
    payload: Mapped[dict[str, Any]] = mapped_column(JSON)
    accepted: Mapped[bool]
    refusal: Mapped[str | None] = mapped_column(String(400))
    received_at: Mapped[UtcTime]


class Contact(Base):
    """One body part touching one surface, for one interval of active time.

    Times are the monotonic seconds of the client run `epoch`, `*_active_s` the phase's active time.
    `effect` is how the task counted it: green, out_of_order, wrong_part, early, side, target, start
    or none.
    """

    __tablename__ = "contacts"
    __table_args__ = (
        ForeignKeyConstraint(["session_id", "phase_id"], ["phases.session_id", "phases.phase_id"]),
        Index("ix_contacts_phase", "session_id", "phase_id"),
    )

    id: Mapped[Id]
    session_id: Mapped[str] = mapped_column(String(32))
    epoch: Mapped[int] = mapped_column(BigInteger, server_default="1")
    phase_id: Mapped[int]
    surface: Mapped[str] = mapped_column(String(40))
    surface_kind: Mapped[str] = mapped_column(String(20))
    box: Mapped[int | None]
    side: Mapped[str | None] = mapped_column(String(20))
    body_part: Mapped[str] = mapped_column(String(40))
    begin_s: Mapped[float]
    end_s: Mapped[float]
    begin_active_s: Mapped[float]
    end_active_s: Mapped[float]
    effect: Mapped[str] = mapped_column(String(20))


class Completion(Base):
    """One completed task: every panel in order, then the target."""

    __tablename__ = "completions"
    __table_args__ = (
        ForeignKeyConstraint(["session_id", "phase_id"], ["phases.session_id", "phases.phase_id"]),
    )

    session_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    phase_id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    epoch: Mapped[int] = mapped_column(BigInteger, server_default="1")
    at_s: Mapped[float]
    active_s: Mapped[float]
    duration_s: Mapped[float]
    order: Mapped[list[Any]] = mapped_column(JSON)
    out_of_order_touches: Mapped[int]


class JointErrorRow(Base):
    """The angular distance of a joint from its target over the active time of a phase, per axis.

    `reference` is `present` (the target at that moment) or `command` (the delayed command, which
    shows the quality of the controller). Radians; null if no sample counts. `clipped_share` is the
    share of the samples in which the limits of a physics avatar clipped the target; null without
    limits, or without a hinge that moves.
    """

    __tablename__ = "joint_errors"
    __table_args__ = (
        ForeignKeyConstraint(["session_id", "phase_id"], ["phases.session_id", "phases.phase_id"]),
    )

    session_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    phase_id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    reference: Mapped[str] = mapped_column(String(20), primary_key=True)
    joint: Mapped[str] = mapped_column(String(40), primary_key=True)
    axis: Mapped[str] = mapped_column(String(10), primary_key=True)
    mean_rad: Mapped[float | None]
    rms_rad: Mapped[float | None]
    p95_rad: Mapped[float | None]
    max_rad: Mapped[float | None]
    clipped_share: Mapped[float | None]
    samples: Mapped[int]
    excluded: Mapped[int]


class JointErrorCourseRow(Base):
    """The time course of a phase's joint error over its active time, in bins of `bin_s` from 0 s.

    `reference` as in `joint_errors`. For each bin: `mean_rad`, the mean angle over the joints and
    frames that count, null if none does, and `samples`, their number.
    """

    # One row per phase and reference, not per bin: the bins of a phase are always read together,
    # and a figure of a thousand sessions then reads 7,000 rows instead of 96,000.
    __tablename__ = "joint_error_courses"
    __table_args__ = (
        ForeignKeyConstraint(["session_id", "phase_id"], ["phases.session_id", "phases.phase_id"]),
    )

    session_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    phase_id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    reference: Mapped[str] = mapped_column(String(20), primary_key=True)
    bin_s: Mapped[float]
    mean_rad: Mapped[list[float | None]] = mapped_column(JSON)
    samples: Mapped[list[int]] = mapped_column(JSON)


class ClockProbe(Base):
    """One exchange of clock readings, raw; the clocks are mapped in the analysis.

    If no answer came in time, all three times after the first are null.
    """

    __tablename__ = "clock_probes"

    id: Mapped[Id]
    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), index=True)
    epoch: Mapped[int] = mapped_column(BigInteger)
    client_sent_s: Mapped[float]
    server_received_ns: Mapped[int | None] = mapped_column(BigInteger)
    server_sent_ns: Mapped[int | None] = mapped_column(BigInteger)
    client_received_s: Mapped[float | None]
    server_utc: Mapped[datetime] = mapped_column(UtcDateTime)


class TrackerChunk(Base):
    """About one second of what a source of the lab's trackers sent for a session, as it came.

    `number` counts the chunks of a session from 1. `source` is the source's label, `address` its
    sender's; the head by the headset itself has the door `headset`. `first_s` and `last_s` are
    arrivals by the server's monotonic clock, `first_at` the time of day at the first one.
    `trackers`: their names, to which the columns in `data` refer. Of a performer who was shown to
    the participant, a chunk has the poses as they were sent to the headset, at these times; its
    `encoding` is another, and `trackers` are the joints.
    """

    __tablename__ = "tracker_chunks"

    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    door: Mapped[str] = mapped_column(String(20))
    source: Mapped[str] = mapped_column(String(64))
    address: Mapped[str] = mapped_column(String(60))
    first_s: Mapped[float]
    last_s: Mapped[float]
    first_at: Mapped[UtcTime]
    sample_count: Mapped[int]
    trackers: Mapped[list[str]] = mapped_column(JSON)
    encoding: Mapped[str] = mapped_column(String(40))
    data: Mapped[bytes] = mapped_column(LargeBinary)


class TrackerAlignment(Base):
    """How a session's trackers lay in the headset's world from a time on, or no longer did.

    `change`: first, refit, recentred, moved or lost (`app.science.alignment.Change`). `client_t_s`
    is the headset's monotonic time. `figures`: the alignment with its mount and its quality, and
    the jump that was found; each null if there is none.
    """

    __tablename__ = "tracker_alignments"

    id: Mapped[Id]
    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), index=True)
    at: Mapped[UtcTime]
    change: Mapped[str] = mapped_column(String(20))
    client_t_s: Mapped[float]
    door: Mapped[str] = mapped_column(String(20))
    source: Mapped[str] = mapped_column(String(64))
    tracker: Mapped[str] = mapped_column(String(64))
    figures: Mapped[dict[str, Any]] = mapped_column(JSON)
