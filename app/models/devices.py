"""Tables of the equipment: paired tablets and headsets, its latency, self-tests, doors."""

from datetime import datetime
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    CheckConstraint,
    ForeignKey,
    Index,
    LargeBinary,
    String,
    text,
)
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcDateTime, UtcTime


class PairingCode(Base):
    """A short single-use code that pairs a device with a session."""

    __tablename__ = "pairing_codes"

    code_hash: Mapped[str] = mapped_column(String(64), primary_key=True)
    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), index=True)
    kind: Mapped[str] = mapped_column(String(20))
    created_at: Mapped[UtcTime]
    expires_at: Mapped[UtcTime]
    used_at: Mapped[datetime | None] = mapped_column(UtcDateTime)


class Device(Base):
    """A paired device. Its token gives access to its own session only; only its hash is stored.

    At most one device of a kind is unrevoked in a session: to replace a tablet, the operator must
    deliberately show a new code.
    """

    __tablename__ = "devices"
    __table_args__ = (
        CheckConstraint("kind IN ('tablet', 'headset')", name="kind"),
        Index(
            "uq_devices_holder",
            "session_id",
            "kind",
            unique=True,
            sqlite_where=text("revoked_at IS NULL"),
            postgresql_where=text("revoked_at IS NULL"),
        ),
    )

    id: Mapped[Id]
    session_id: Mapped[str] = mapped_column(ForeignKey("sessions.id"), index=True)
    kind: Mapped[str] = mapped_column(String(20))
    name: Mapped[str] = mapped_column(String(80))
    token_hash: Mapped[str] = mapped_column(String(64), unique=True)
    paired_at: Mapped[UtcTime]
    last_seen_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
    revoked_at: Mapped[datetime | None] = mapped_column(UtcDateTime)


class Calibration(Base):
    """A measurement of the motion-to-photon latency of the equipment itself, without added latency.

    Appended, never edited: a later measurement of the same `equipment` supersedes it, and
    `retired_at` marks a mistaken one. `measured_on` is an ISO date.
    """

    __tablename__ = "calibrations"

    id: Mapped[Id]
    equipment: Mapped[str] = mapped_column(String(120))
    motion_to_photon_s: Mapped[float]
    sd_s: Mapped[float]
    samples: Mapped[int]
    method: Mapped[str] = mapped_column(String(400))
    measured_on: Mapped[str] = mapped_column(String(10))
    note: Mapped[str] = mapped_column(String(2000))
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]
    retired_at: Mapped[datetime | None] = mapped_column(UtcDateTime)
    retired_by: Mapped[str | None] = mapped_column(String(100))
    retired_reason: Mapped[str | None] = mapped_column(String(2000))


class HeadsetTest(Base):
    """A self-test of a headset: the figures that it measured, and the verdicts about them.

    Appended, never edited. It is about the equipment and names no session. `id` was chosen by the
    headset, `started_at` is by its clock. `status` is the worst of the verdicts, and `worn` tells
    whether it was shown in a headset and moved by a person.
    """

    __tablename__ = "headset_tests"
    __table_args__ = (CheckConstraint("status IN ('ok', 'warn', 'fail')", name="status"),)

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    started_at: Mapped[UtcTime] = mapped_column(index=True)
    received_at: Mapped[UtcTime]
    status: Mapped[str] = mapped_column(String(10))
    worn: Mapped[bool]
    report: Mapped[dict[str, Any]] = mapped_column(JSON)
    verdicts: Mapped[list[dict[str, Any]]] = mapped_column(JSON)


class HeadsetTestBatch(Base):
    """A batch that a headset sends to measure the way to the disk, kept until its next commit.

    `trial_id` is random, one for each socket.
    """

    __tablename__ = "headset_test_batches"

    trial_id: Mapped[str] = mapped_column(String(32), primary_key=True)
    stream: Mapped[str] = mapped_column(String(20), primary_key=True)
    seq_first: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    received_at: Mapped[UtcTime]
    message: Mapped[bytes] = mapped_column(LargeBinary)


class LiveDoor(Base):
    """The settings of a door for tracking data; a door without a row is closed.

    `interface` is the address of this machine on which packets are taken. `server` is the address
    of Motive, for NatNet only; `port` is then its port for requests.
    """

    __tablename__ = "live_doors"

    door: Mapped[str] = mapped_column(String(20), primary_key=True)
    is_open: Mapped[bool]
    interface: Mapped[str] = mapped_column(String(45))
    port: Mapped[int]
    server: Mapped[str | None] = mapped_column(String(45))
    multicast: Mapped[bool]
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]


class LiveLimb(Base):
    """The limb on which a tracker is worn; a tracker without a row is on none."""

    __tablename__ = "live_limbs"

    door: Mapped[str] = mapped_column(String(20), primary_key=True)
    source: Mapped[str] = mapped_column(String(64), primary_key=True)
    tracker: Mapped[str] = mapped_column(String(64), primary_key=True)
    limb: Mapped[str] = mapped_column(String(40))
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]
