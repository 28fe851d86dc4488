"""Tables of a study's road: the runs of its scene, their records, and how people crossed."""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, ForeignKey, ForeignKeyConstraint, Index, LargeBinary, String
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime


class RoadRun(Base):
    """One run of a study's road during a phase.

    A phase has more than one if its page was loaded again, or the server was restarted: `part`
    counts them. `begins_at_s`: the phase's active time at its first step. `header`: what was run,
    as the first line of the record. `ended`: running, complete, partner lost, or interrupted;
    `reason` says why it broke off. `steps`, `guesses`: how many the record has; `worst_guess_m`:
    the largest distance between a guess and what the partner said later. `timing`: real times,
    which are no part of the record. `sha256`: of the record's bytes; null while it runs.
    """

    __tablename__ = "road_runs"
    __table_args__ = (
        ForeignKeyConstraint(["session_id", "phase_id"], ["phases.session_id", "phases.phase_id"]),
        Index("ix_road_runs_phase", "session_id", "phase_id"),
    )

    id: Mapped[Id]
    session_id: Mapped[str] = mapped_column(String(32))
    phase_id: Mapped[int]
    part: Mapped[int]
    seed: Mapped[int]
    begins_at_s: Mapped[float]
    header: Mapped[dict[str, Any]] = mapped_column(JSON)
    began_at: Mapped[UtcTime]
    ended_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
    ended: Mapped[str] = mapped_column(String(20))
    reason: Mapped[str] = mapped_column(String(400), default="")
    steps: Mapped[int] = mapped_column(default=0)
    guesses: Mapped[int] = mapped_column(default=0)
    worst_guess_m: Mapped[float | None]
    timing: Mapped[dict[str, Any]] = mapped_column(JSON, default=dict)
    sha256: Mapped[str | None] = mapped_column(String(64))


class RoadChunk(Base):
    """About a second of a run's record: its next lines, as UTF-8 compressed by zlib."""

    __tablename__ = "road_chunks"

    run_id: Mapped[str] = mapped_column(ForeignKey("road_runs.id"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), index=True)
    data: Mapped[bytes] = mapped_column(LargeBinary)


class RoadCrossing(Base):
    """How the participant crossed once; `number` counts within a run, from 1.

    The measures are those of `app.science.cosimulation.Crossing`; times are the phase's active
    time.
    """

    __tablename__ = "road_crossings"

    run_id: Mapped[str] = mapped_column(ForeignKey("road_runs.id"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), index=True)
    phase_id: Mapped[int]
    steps_on_s: Mapped[float | None]
    steps_off_s: Mapped[float | None]
    is_across: Mapped[bool]
    waited_s: Mapped[float]
    gap_accepted_s: Mapped[float | None]
    gaps_refused_s: Mapped[list[float]] = mapped_column(JSON)
    least_time_to_collision_s: Mapped[float | None]
    least_post_encroachment_s: Mapped[float | None]
    closest_m: Mapped[float | None]
    collision_car: Mapped[str | None] = mapped_column(String(80))
    collision_s: Mapped[float | None]
    collision_speed_m_s: Mapped[float | None]
