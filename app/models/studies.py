"""Tables of studies and instruments, with every version by the hash of its content.

Experts' suggestions about a version of a study are stored with it, and so are its pilots.
"""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, CheckConstraint, ForeignKey, String, Text, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime


class Study(Base):
    """A study by its key; its content is in its versions."""

    __tablename__ = "studies"

    id: Mapped[Id]
    key: Mapped[str] = mapped_column(String(80), unique=True)
    created_at: Mapped[UtcTime]
    archived_at: Mapped[datetime | None] = mapped_column(UtcDateTime)


class StudyVersion(Base):
    """One version of a study, frozen once a session has started with it; an edit makes a new one.

    `source_yaml` is the file as it was uploaded, including comments; its hash was computed from
    `canonical_json`. `instruments` maps the key of each instrument to its content hash at that
    time.
    """

    __tablename__ = "study_versions"
    __table_args__ = (
        UniqueConstraint("study_id", "number"),
        UniqueConstraint("study_id", "content_hash"),
    )

    id: Mapped[Id]
    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id"), index=True)
    number: Mapped[int]
    content_hash: Mapped[str] = mapped_column(String(64))
    design_hash: Mapped[str] = mapped_column(String(64))
    source_yaml: Mapped[str] = mapped_column(Text)
    canonical_json: Mapped[str] = mapped_column(Text)
    instruments: Mapped[dict[str, Any]] = mapped_column(JSON)
    created_at: Mapped[UtcTime]
    frozen_at: Mapped[datetime | None] = mapped_column(UtcDateTime)


class InstrumentVersion(Base):
    """One version of an instrument; submissions refer to the exact wording that was shown."""

    __tablename__ = "instrument_versions"
    __table_args__ = (UniqueConstraint("key", "content_hash"),)

    id: Mapped[Id]
    key: Mapped[str] = mapped_column(String(80), index=True)
    content_hash: Mapped[str] = mapped_column(String(64))
    source_yaml: Mapped[str] = mapped_column(Text)
    canonical_json: Mapped[str] = mapped_column(Text)
    created_at: Mapped[UtcTime]


class Suggestion(Base):
    """An expert's suggestion about a version of a study, and the decision on it.

    `status` is open, adopted or declined; `adopted_in` is the number of the version that contains
    it. `about` names a step of the study, or is empty for the whole study.
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


class PilotRow(Base):
    """A pilot of a study's version: simulated people, or the power of its test.

    Nobody real is in it, and no session belongs to it, so deleting the row deletes all of it.
    `options` is what was ordered, and `assumptions` the file of what is assumed of people's
    answers. `summary` has the report, and `record` every simulated visit or part, one line of JSON
    each; both are null until it is ready. `trouble` is why it failed.
    """

    __tablename__ = "pilots"
    __table_args__ = (
        CheckConstraint("state IN ('simulating', 'stopped', 'ready', 'failed')", "state"),
        CheckConstraint("kind IN ('cohort', 'power')", "kind"),
    )

    id: Mapped[Id]
    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id"), index=True)
    study_version_id: Mapped[str] = mapped_column(ForeignKey("study_versions.id"), index=True)
    kind: Mapped[str] = mapped_column(String(20))
    options: Mapped[dict[str, Any]] = mapped_column(JSON)
    assumptions: Mapped[str | None] = mapped_column(Text)
    state: Mapped[str] = mapped_column(String(20))
    summary: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    # Up to some megabytes, which only a download needs.
    record: Mapped[str | None] = mapped_column(Text, deferred=True)
    trouble: Mapped[str | None] = mapped_column(Text)
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime] = mapped_column(index=True)
    ended_at: Mapped[UtcTime | None]
