"""Tables of answers that were collected elsewhere and imported, separate from our own sessions.

They belong to no session: they were not collected by this program, so there is no plan, no slot of
the ledger and no event log. No query for sessions can find them by mistake.
"""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, ForeignKey, Index, String, Text, text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime


class AnswerImport(Base):
    """One file that was imported as answers to one instrument.

    `content_hash`: SHA-256 of the file's text, unique among the current imports of a study and
    instrument; an import that was undone remains as a row without forms, and no longer counts.
    `mapping`: how the file's columns and words were interpreted, to be reused for the next file.
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
    """One filled-in form of an import: its participant, condition, answers and scores.

    `line`: the form's line in the file, from 1. `condition`: as in the file, or as mapped by the
    import; `in_study`: whether it is the key of one of the study's conditions. `answered_on`:
    YYYY-MM-DD. `answers`: by item, null if left out; `scores`: by score, null if an item is
    missing.
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
