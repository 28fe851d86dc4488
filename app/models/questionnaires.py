"""Tables of submissions: the answers as given, how they were entered, and their scores."""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, BigInteger, ForeignKey, String, Text, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime


class Submission(Base):
    """One filled-in form. The idempotency key makes resending it harmless.

    `administration` names the step and attempt that it answers ("block1.hand.karas2020#1").
    `request_hash` distinguishes a repeated request from a different one with the same key. The
    event log contains only sha256(salt + answers). `timings`: seconds from the opening of the form
    to the last change of each item. `item_traces`: by item, `response_s` and `changes`, as in
    `ItemTrace` of the questionnaires' schemas; None if the page that sent the form did not record
    them.
    """

    __tablename__ = "submissions"
    __table_args__ = (
        UniqueConstraint("session_id", "idempotency_key"),
        UniqueConstraint("session_id", "administration"),
    )

    id: Mapped[Id]
    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), index=True)
    administration: Mapped[str] = mapped_column(String(120))
    step_index: Mapped[int]
    attempt: Mapped[int]
    instrument_version_id: Mapped[str] = mapped_column(ForeignKey("instrument_versions.id"))
    instrument: Mapped[str] = mapped_column(String(80), index=True)
    idempotency_key: Mapped[str] = mapped_column(String(64))
    request_hash: Mapped[str] = mapped_column(String(64))
    salt: Mapped[str | None] = mapped_column(String(64))
    mode: Mapped[str] = mapped_column(String(20))
    entered_by: Mapped[str] = mapped_column(String(80))
    language: Mapped[str] = mapped_column(String(8))
    item_seed: Mapped[int] = mapped_column(BigInteger)
    shown_order: Mapped[list[Any]] = mapped_column(JSON)
    timings: Mapped[dict[str, Any]] = mapped_column(JSON)
    item_traces: Mapped[dict[str, Any] | None] = mapped_column(JSON)
    started_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
    submitted_at: Mapped[UtcTime]


class Answer(Base):
    """One item's answer: a number or a text, never both; neither if the item was left out."""

    __tablename__ = "answers"

    submission_id: Mapped[str] = mapped_column(ForeignKey("submissions.id"), primary_key=True)
    item: Mapped[str] = mapped_column(String(80), primary_key=True)
    position: Mapped[int]
    value_number: Mapped[float | None]
    value_text: Mapped[str | None] = mapped_column(Text)


class ScoreValue(Base):
    """A score of a submission by its instrument's formula; null if an item is missing."""

    __tablename__ = "scores"

    submission_id: Mapped[str] = mapped_column(ForeignKey("submissions.id"), primary_key=True)
    score: Mapped[str] = mapped_column(String(80), primary_key=True)
    value: Mapped[float | None]
