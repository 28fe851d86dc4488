"""Tables of participants' rights: corrections, copies of data, and erasures."""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, BigInteger, ForeignKey, ForeignKeyConstraint, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime


class AnswerCorrection(Base):
    """A later value of one answer; the original answer is kept.

    The newest correction counts. Value and previous value are a number or a text; neither if the
    item is left out. `reason`, values and `salt` are emptied by erasure; the event log contains
    only the hash.
    """

    __tablename__ = "answer_corrections"
    __table_args__ = (
        ForeignKeyConstraint(["submission_id", "item"], ["answers.submission_id", "answers.item"]),
    )

    id: Mapped[Id]
    submission_id: Mapped[str] = mapped_column(String(32), index=True)
    item: Mapped[str] = mapped_column(String(80))
    previous_number: Mapped[float | None]
    previous_text: Mapped[str | None] = mapped_column(Text)
    value_number: Mapped[float | None]
    value_text: Mapped[str | None] = mapped_column(Text)
    reason: Mapped[str] = mapped_column(String(2000))
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]


class Erasure(Base):
    """A tombstone: when and by whom a participant's data were erased, and how many rows.

    It contains nothing about the person. `removed` counts rows by table; `remaining` lists earlier
    exports and backups, which are outside the database and must be deleted by hand.
    """

    __tablename__ = "erasures"

    id: Mapped[Id]
    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id"), index=True)
    participant_id: Mapped[str] = mapped_column(ForeignKey("participants.id"), unique=True)
    sessions: Mapped[list[Any]] = mapped_column(JSON)
    removed: Mapped[dict[str, Any]] = mapped_column(JSON)
    remaining: Mapped[list[Any]] = mapped_column(JSON)
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]


class CopyMade(Base):
    """A copy of data that left the database: an export, an access copy, or a backup.

    `kind` is export, access or backup. `place` is its destination as far as known: a file, or the
    browser of `by`. `destroyed_at`: when somebody reported that it was deleted.
    """

    __tablename__ = "copies_made"

    id: Mapped[Id]
    kind: Mapped[str] = mapped_column(String(20))
    study_id: Mapped[str | None] = mapped_column(ForeignKey("studies.id"), index=True)
    session_kind: Mapped[str | None] = mapped_column(String(20))
    participant_id: Mapped[str | None] = mapped_column(ForeignKey("participants.id"))
    place: Mapped[str] = mapped_column(String(400))
    sessions: Mapped[int | None]
    bytes: Mapped[int | None] = mapped_column(BigInteger)
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]
    destroyed_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
    destroyed_by: Mapped[str | None] = mapped_column(String(100))
