"""Who works here, and the chain of what they did."""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, CheckConstraint, ForeignKey, String, Text, true
from sqlalchemy.orm import Mapped, mapped_column, relationship

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime

ROLES = ("admin", "experimenter", "operator", "analyst")


class Account(Base):
    """A person of the lab. The password is kept as an argon2id hash only.

    `all_studies`: every study is theirs, also those to come; else those of `study_members`.
    """

    __tablename__ = "accounts"

    id: Mapped[Id]
    username: Mapped[str] = mapped_column(String(80), unique=True)
    role: Mapped[str] = mapped_column(String(20))
    all_studies: Mapped[bool] = mapped_column(default=True, server_default=true())
    password_hash: Mapped[str] = mapped_column(String(200))
    created_at: Mapped[UtcTime]
    disabled_at: Mapped[datetime | None] = mapped_column(UtcDateTime)


class StudyMember(Base):
    """A study that an account may see, where it may not see all."""

    __tablename__ = "study_members"

    account_id: Mapped[str] = mapped_column(ForeignKey("accounts.id"), primary_key=True)
    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id"), primary_key=True, index=True)


class Invitation(Base):
    """A link that makes one account, once: the hash of its token, and what the account may do."""

    __tablename__ = "invitations"
    __table_args__ = (CheckConstraint(f"role IN {ROLES}", name="role"),)

    id: Mapped[Id]
    token_hash: Mapped[str] = mapped_column(String(64), unique=True)
    role: Mapped[str] = mapped_column(String(20))
    note: Mapped[str] = mapped_column(String(80))
    all_studies: Mapped[bool]
    studies: Mapped[list[Any]] = mapped_column(JSON)
    created_by: Mapped[str] = mapped_column(String(80))
    created_at: Mapped[UtcTime]
    expires_at: Mapped[UtcTime]
    used_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
    account_id: Mapped[str | None] = mapped_column(ForeignKey("accounts.id"))
    revoked_at: Mapped[datetime | None] = mapped_column(UtcDateTime)


class LoginToken(Base):
    """A login that can be revoked: the browser or script holds the token, we hold its hash."""

    __tablename__ = "login_tokens"

    token_hash: Mapped[str] = mapped_column(String(64), primary_key=True)
    account_id: Mapped[str] = mapped_column(ForeignKey("accounts.id"), index=True)
    purpose: Mapped[str] = mapped_column(String(20))
    created_at: Mapped[UtcTime]
    expires_at: Mapped[UtcTime]
    revoked_at: Mapped[datetime | None] = mapped_column(UtcDateTime)

    account: Mapped[Account] = relationship(lazy="raise")


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
