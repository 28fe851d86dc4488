"""Tables of data quality: achieved latency of phases, quality of their streams, and alarms."""

from typing import Any

from sqlalchemy import JSON, BigInteger, ForeignKey, ForeignKeyConstraint, String
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcTime


class PhaseLatency(Base):
    """The achieved latency of a phase, next to the latency that was set.

    `achieved_s` with its 95 % interval is null if there was too little movement to measure it;
    `reason` then states this. `flagged`: the two differ by more than 10 ms and more than one frame
    (`frame_s`).
    """

    __tablename__ = "phase_latencies"
    __table_args__ = (
        ForeignKeyConstraint(["session_id", "phase_id"], ["phases.session_id", "phases.phase_id"]),
    )

    session_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    phase_id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    ordered_s: Mapped[float]
    achieved_s: Mapped[float | None]
    low_s: Mapped[float | None]
    high_s: Mapped[float | None]
    movement_s: Mapped[float]
    frame_s: Mapped[float | None]
    samples: Mapped[int]
    flagged: Mapped[bool]
    reason: Mapped[str | None] = mapped_column(String(400))


class PhaseQuality(Base):
    """The number of problems of each kind in the samples of one stream in one phase.

    Times in s of the client's clock; `frozen_joints` names joints whose values did not change at
    all while others moved.
    """

    __tablename__ = "phase_quality"
    __table_args__ = (
        ForeignKeyConstraint(["session_id", "phase_id"], ["phases.session_id", "phases.phase_id"]),
    )

    session_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    phase_id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    stream: Mapped[str] = mapped_column(String(20), primary_key=True)
    frames: Mapped[int] = mapped_column(BigInteger)
    span_s: Mapped[float]
    frame_rate_hz: Mapped[float | None]
    gaps: Mapped[int]
    gap_s: Mapped[float]
    longest_gap_s: Mapped[float]
    jumps: Mapped[int]
    frozen_s: Mapped[float]
    frozen_joints: Mapped[list[Any]] = mapped_column(JSON)
    non_unit: Mapped[int]
    non_finite: Mapped[int]
    backwards: Mapped[int]


class AlarmRow(Base):
    """An alarm as the console showed it: one row when it was raised, one when it was cleared."""

    __tablename__ = "alarms"

    id: Mapped[Id]
    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), index=True)
    code: Mapped[str] = mapped_column(String(40))
    severity: Mapped[str] = mapped_column(String(10))
    state: Mapped[str] = mapped_column(String(10))
    stream: Mapped[str | None] = mapped_column(String(20))
    message: Mapped[str] = mapped_column(String(400))
    value: Mapped[float | None]
    unit: Mapped[str | None] = mapped_column(String(20))
    client_t_s: Mapped[float | None]
    at: Mapped[UtcTime]
