"""Tables of sessions: the event log, and the snapshot and phases computed from it."""

from datetime import datetime
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    CheckConstraint,
    ForeignKey,
    String,
    Text,
    UniqueConstraint,
)
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.ledger import KIND_CHECK
from app.models.types import Id, UtcDateTime, UtcTime


class StudySession(Base):
    """One visit of one participant. `version` counts events; `snapshot` is the state after them.

    `avatar_configuration_hash` identifies the content of the avatar's configuration, if the avatar
    has one (AvatarVersion). `request_id`: chosen by the client that asked for the session, so that
    asking again makes no second one; null if it chose none. `shortfalls`: the rules of its study
    that a completed session does not satisfy, an empty list if none; null if there are no rules, or
    it was not checked yet.
    """

    __tablename__ = "sessions"
    __table_args__ = (
        CheckConstraint(KIND_CHECK, name="kind"),
        CheckConstraint("time_scale = 1.0 OR kind = 'simulated'", name="time_scale"),
    )

    id: Mapped[Id]
    study_id: Mapped[str] = mapped_column(ForeignKey("studies.id"), index=True)
    study_version_id: Mapped[str] = mapped_column(ForeignKey("study_versions.id"), index=True)
    participant_id: Mapped[str] = mapped_column(ForeignKey("participants.id"), index=True)
    kind: Mapped[str] = mapped_column(String(20))
    avatar: Mapped[str] = mapped_column(String(40))
    avatar_configuration_hash: Mapped[str | None] = mapped_column(String(64))
    language: Mapped[str] = mapped_column(String(8))
    time_scale: Mapped[float] = mapped_column(default=1.0)
    seed: Mapped[int] = mapped_column(BigInteger)
    status: Mapped[str] = mapped_column(String(20), index=True)
    version: Mapped[int] = mapped_column(default=0)
    snapshot: Mapped[dict[str, Any]] = mapped_column(JSON)
    shortfalls: Mapped[list[dict[str, Any]] | None] = mapped_column(JSON(none_as_null=True))
    request_id: Mapped[str | None] = mapped_column(String(36), index=True, unique=True)
    created_at: Mapped[UtcTime]
    started_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
    ended_at: Mapped[datetime | None] = mapped_column(UtcDateTime)


class SessionEvent(Base):
    """One event of a session, appended and never edited.

    `hash` covers the previous hash and every other column, so an edited row breaks the chain.
    `payload` is canonical JSON and contains no answers, notes or personal text, only the ids and
    salted hashes of such content.
    """

    __tablename__ = "session_events"

    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), primary_key=True)
    seq: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    type: Mapped[str] = mapped_column(String(40))
    payload: Mapped[str] = mapped_column(Text)
    actor: Mapped[str] = mapped_column(String(80))
    command_id: Mapped[str | None] = mapped_column(String(36), index=True)
    recorded_at: Mapped[UtcTime]
    monotonic_ns: Mapped[int] = mapped_column(BigInteger)
    previous_hash: Mapped[str] = mapped_column(String(64))
    hash: Mapped[str] = mapped_column(String(64))


class SessionContent(Base):
    """A text or personal data that an event refers to; erasure empties `body` and `salt`."""

    __tablename__ = "session_contents"

    id: Mapped[Id]
    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), index=True)
    kind: Mapped[str] = mapped_column(String(20))
    salt: Mapped[str | None] = mapped_column(String(64))
    body: Mapped[str | None] = mapped_column(Text)
    created_at: Mapped[UtcTime]
    created_by: Mapped[str] = mapped_column(String(80))


class Phase(Base):
    """One attempt at a timed step (free movement, practice or task), computed from the events.

    `phase_id` counts within the session and identifies the phase's telemetry. `active_s` is the
    participant's active time: pauses and walks back do not count. `body`: the name of the body that
    its condition prescribes; null for the body of the avatar's configuration.
    """

    __tablename__ = "phases"
    __table_args__ = (UniqueConstraint("session_id", "step_index", "attempt"),)

    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), primary_key=True)
    phase_id: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    step_index: Mapped[int]
    step_key: Mapped[str] = mapped_column(String(80))
    attempt: Mapped[int]
    kind: Mapped[str] = mapped_column(String(20))
    limb: Mapped[str | None] = mapped_column(String(10))
    block: Mapped[int | None]
    condition: Mapped[str | None] = mapped_column(String(40))
    latency_ms: Mapped[float]
    body: Mapped[str | None] = mapped_column(String(80))
    status: Mapped[str] = mapped_column(String(20))
    active_s: Mapped[float] = mapped_column(default=0.0)
    paused_count: Mapped[int] = mapped_column(default=0)
    walk_back_count: Mapped[int] = mapped_column(default=0)
    client_started_s: Mapped[float | None]
    client_ended_s: Mapped[float | None]
    prepared_at: Mapped[UtcTime]
    started_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
    ended_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
