"""Tables of accounts, logins and invitations, and the audit trail of their actions."""

from datetime import datetime
from typing import Any

from sqlalchemy import JSON, CheckConstraint, ForeignKey, String, Text, true
from sqlalchemy.orm import Mapped, mapped_column, relationship

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime

ROLES = ("admin", "experimenter", "operator", "analyst")
SERVERS_OWN = ("demo", "tryout")
"""Purposes of logins that the server gives to its own rehearsals; they end with the server."""
PURPOSES = ("browser", "script", *SERVERS_OWN)
"""Of logins."""


class Account(Base):
    """An account of a person of the lab. The password is stored only as an argon2id hash.

    `all_studies`: they may see every study, including future ones; otherwise those of
    `study_members`.
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
    """A study that an account may see if it may not see all."""

    __tablename__ = "study_members"

    account_id: Mapped[str] = mapped_column(ForeignKey("accounts.id"), primary_key=True)
    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id"), primary_key=True, index=True)


class Invitation(Base):
    """A single-use link that creates one account.

    The hash of its token is stored, and the rights of the future account.
    """

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
    """A revocable login: the browser or script has the token, the database only its hash."""

    __tablename__ = "login_tokens"

    token_hash: Mapped[str] = mapped_column(String(64), primary_key=True)
    account_id: Mapped[str] = mapped_column(ForeignKey("accounts.id"), index=True)
    purpose: Mapped[str] = mapped_column(String(20))
    created_at: Mapped[UtcTime]
    expires_at: Mapped[UtcTime]
    revoked_at: Mapped[datetime | None] = mapped_column(UtcDateTime)

    account: Mapped[Account] = relationship(lazy="raise")


class AuditEntry(Base):
    """One entry of the audit trail. `hash` covers the previous hash and every other column.

    `subject` names the object of the action by kind and key or id ("study:pilot",
    "session:0f3a..."), and `details` is canonical JSON. Neither contains any data of a participant,
    not even their code: an entry cannot be erased.
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
    """The head of the audit trail: one row that writers lock, so that the chain never forks.

    It also shows if the end of the chain was removed.
    """

    __tablename__ = "audit_head"

    id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    seq: Mapped[int]
    hash: Mapped[str] = mapped_column(String(64))
