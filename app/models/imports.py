"""Answers that were collected elsewhere and taken in as a file; apart from sessions of our own.

They have no session: nothing here ran them, so there is no plan, no slot of the ledger and no log
of events. No query for sessions can find them by mistake.
"""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, ForeignKey, Index, String, Text, text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime


class AnswerImport(Base):
    """One file that was taken in as answers to one instrument.

    `content_hash`: SHA-256 of the file's text. At most one import of a study and instrument that
    stands has it; one that was undone stays as a row without forms and frees it. `mapping`: what
    was said of the file's columns and words, so that the next file need not be told again.
    """

    __tablename__ = "answer_imports"
    __table_args__ = (
        Index(
            "uq_answer_imports_standing",
            "study_id",
            "instrument",
            "content_hash",
            unique=True,
            sqlite_where=text("undone_at IS NULL"),
            postgresql_where=text("undone_at IS NULL"),
        ),
    )

    id: Mapped[Id]
    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id"), index=True)
    instrument_version_id: Mapped[str] = mapped_column(ForeignKey("instrument_versions.id"))
    instrument: Mapped[str] = mapped_column(String(80))
    file_name: Mapped[str] = mapped_column(String(200))
    content_hash: Mapped[str] = mapped_column(String(64))
    mapping: Mapped[dict[str, Any]] = mapped_column(JSON)
    forms: Mapped[int]
    imported_at: Mapped[UtcTime]
    imported_by: Mapped[str] = mapped_column(String(100))
    undone_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
    undone_by: Mapped[str | None] = mapped_column(String(100))
    undone_reason: Mapped[str | None] = mapped_column(Text)


class ImportedForm(Base):
    """One filled-in form of an import: whose, in which condition, the answers and their scores.

    `line`: in the file, from 1. `condition`: what the file says, by the import's words for it;
    `in_study` where it is the key of one of the study's conditions. `answered_on`: YYYY-MM-DD.
    `answers`: by item, null where left out; `scores`: by score, null where an item is missing.
    """

    __tablename__ = "imported_forms"
    __table_args__ = (Index("ix_imported_forms_code", "study_id", "participant_code"),)

    id: Mapped[Id]
    import_id: Mapped[str] = mapped_column(ForeignKey("answer_imports.id"), index=True)
    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id"))
    line: Mapped[int]
    participant_code: Mapped[str] = mapped_column(String(80))
    condition: Mapped[str] = mapped_column(String(80))
    in_study: Mapped[bool]
    answered_on: Mapped[str | None] = mapped_column(String(10))
    answers: Mapped[dict[str, Any]] = mapped_column(JSON)
    scores: Mapped[dict[str, Any]] = mapped_column(JSON)
