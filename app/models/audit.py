"""What people of the lab did: appended, hash-chained, never edited and never switched off."""

from sqlalchemy import String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import UtcTime


class AuditEntry(Base):
    """One act. `hash` covers the previous hash and every other column.

    `subject` names what was acted upon by kind and key or id ("study:pilot", "session:0f3a..."),
    and `details` is canonical JSON. Neither holds anything of a participant, not even their code:
    an entry cannot be erased.
    """

    __tablename__ = "audit_entries"

    seq: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    at: Mapped[UtcTime]
    actor: Mapped[str] = mapped_column(String(100), index=True)
    action: Mapped[str] = mapped_column(String(60), index=True)
    subject: Mapped[str] = mapped_column(String(200))
    details: Mapped[str] = mapped_column(Text)
    previous_hash: Mapped[str] = mapped_column(String(64))
    hash: Mapped[str] = mapped_column(String(64))


class AuditHead(Base):
    """The end of the chain: one row that writers queue on, so that the chain never forks.

    It also tells a chain whose end was cut off from a shorter one.
    """

    __tablename__ = "audit_head"

    id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    seq: Mapped[int]
    hash: Mapped[str] = mapped_column(String(64))
