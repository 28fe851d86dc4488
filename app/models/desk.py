"""Records that stand beside sessions: how slow the equipment is, and what experts advise."""

from datetime import datetime

from sqlalchemy import ForeignKey, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime


class Calibration(Base):
    """A measurement of the equipment's own motion-to-photon delay; added latency comes on top.

    Appended, never edited: a later measurement of the same `equipment` supersedes it, and
    `retired_at` marks one that was a mistake. `measured_on` is an ISO date.
    """

    __tablename__ = "calibrations"

    id: Mapped[Id]
    equipment: Mapped[str] = mapped_column(String(120))
    motion_to_photon_s: Mapped[float]
    sd_s: Mapped[float]
    samples: Mapped[int]
    method: Mapped[str] = mapped_column(String(400))
    measured_on: Mapped[str] = mapped_column(String(10))
    note: Mapped[str] = mapped_column(String(2000))
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]
    retired_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
    retired_by: Mapped[str | None] = mapped_column(String(100))
    retired_reason: Mapped[str | None] = mapped_column(String(2000))


class Suggestion(Base):
    """What an expert advised about a version of a study, and what became of it.

    `status` is open, adopted or declined; `adopted_in` is the number of the version that has it.
    `about` names a step of the study, or is empty for the whole.
    """

    __tablename__ = "suggestions"

    id: Mapped[Id]
    study_version_id: Mapped[str] = mapped_column(ForeignKey("study_versions.id"), index=True)
    session_id: Mapped[str | None] = mapped_column(ForeignKey("sessions.id"), index=True)
    about: Mapped[str] = mapped_column(String(80))
    body: Mapped[str] = mapped_column(Text)
    status: Mapped[str] = mapped_column(String(20))
    adopted_in: Mapped[int | None]
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]
    decided_by: Mapped[str | None] = mapped_column(String(100))
    decided_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
