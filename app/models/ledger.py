"""Tables of the counterbalancing ledger: an immutable list of slots, and the attempts at them."""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, CheckConstraint, ForeignKey, Index, String, UniqueConstraint, text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime

KINDS = ("people", "simulated", "test", "expert")
"""The kinds of sessions. Only people's are data; experts review a study and make suggestions."""
KIND_CHECK = f"kind IN {KINDS}"


class Participant(Base):
    """A participant, by a pseudonym that is unique within the study and kind."""

    __tablename__ = "participants"
    __table_args__ = (UniqueConstraint("study_id", "kind", "code"),)

    id: Mapped[Id]
    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id"), index=True)
    kind: Mapped[str] = mapped_column(String(20))
    code: Mapped[str] = mapped_column(String(40))
    created_at: Mapped[UtcTime]


class Ledger(Base):
    """The ledger of one kind of sessions and one design; different kinds never share one.

    Versions of a study that differ only in wording share their ledger, because `design_hash` covers
    only what determines balance (conditions and orders). `blocks` counts the seeded blocks created
    so far.
    """

    __tablename__ = "ledgers"
    __table_args__ = (
        UniqueConstraint("study_id", "kind", "design_hash"),
        CheckConstraint(KIND_CHECK, name="kind"),
    )

    id: Mapped[Id]
    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id"), index=True)
    kind: Mapped[str] = mapped_column(String(20))
    design_hash: Mapped[str] = mapped_column(String(64))
    seed: Mapped[int]
    blocks: Mapped[int] = mapped_column(default=0)
    created_at: Mapped[UtcTime]


class LedgerSlot(Base):
    """A row of the ledger: one order (condition keys) in one replicate. It never changes."""

    __tablename__ = "ledger_slots"
    __table_args__ = (UniqueConstraint("ledger_id", "position"),)

    id: Mapped[Id]
    ledger_id: Mapped[str] = mapped_column(ForeignKey("ledgers.id"), index=True)
    position: Mapped[int]
    block: Mapped[int]
    replicate: Mapped[int]
    sequence: Mapped[list[Any]] = mapped_column(JSON)


class SlotAttempt(Base):
    """The assignment of a slot to a session. At most one attempt of a slot is open or completed.

    The partial unique index prevents double bookings whatever the code does; a withdrawn or aborted
    attempt keeps its data and reason and releases the slot for the next, and so does an `invalid`
    one: its session was completed but does not count by the rules of the study.
    """

    __tablename__ = "slot_attempts"
    __table_args__ = (
        Index(
            "uq_slot_attempts_holder",
            "slot_id",
            unique=True,
            sqlite_where=text("outcome IN ('open', 'completed')"),
            postgresql_where=text("outcome IN ('open', 'completed')"),
        ),
        CheckConstraint(
            "outcome IN ('open', 'completed', 'withdrawn', 'aborted', 'invalid')", name="outcome"
        ),
    )

    id: Mapped[Id]
    slot_id: Mapped[str] = mapped_column(ForeignKey("ledger_slots.id"), index=True)
    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), unique=True)
    outcome: Mapped[str] = mapped_column(String(20))
    opened_at: Mapped[UtcTime]
    closed_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
