"""Tables of captures: files stored once per content, a summary of each capture, and joint maps."""

from typing import Any

from sqlalchemy import JSON, BigInteger, CheckConstraint, ForeignKey, LargeBinary, String
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcTime


class CaptureContent(Base):
    """The content of an uploaded file, stored once however many captures use it.

    `hash` is the SHA-256 of the file's bytes, `size` their number.
    """

    __tablename__ = "capture_contents"

    hash: Mapped[str] = mapped_column(String(64), primary_key=True)
    size: Mapped[int] = mapped_column(BigInteger)


class CapturePiece(Base):
    """A part of a content's zstd stream, which consists of all parts in order.

    The stream is split so that copying rows, as a backup does, never needs a whole file in memory.
    """

    __tablename__ = "capture_pieces"

    hash: Mapped[str] = mapped_column(ForeignKey("capture_contents.hash"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    data: Mapped[bytes] = mapped_column(LargeBinary)


class CaptureRow(Base):
    """A capture: a file, optionally with its companion, and the results of reading it.

    `identity` identifies the contents of both, so that the same capture is stored once. `reading`
    contains the conventions that a user chose, `summary` what the page shows; both follow the
    schemas of the feature. `fingerprint` is that of its skeleton, null if it has none.
    """

    __tablename__ = "captures"
    __table_args__ = (CheckConstraint("kind IN ('skeleton', 'markers', 'bodies')", "kind"),)

    id: Mapped[Id]
    identity: Mapped[str] = mapped_column(String(64), unique=True)
    title: Mapped[str] = mapped_column(String(200))
    file_name: Mapped[str] = mapped_column(String(200))
    content_hash: Mapped[str] = mapped_column(ForeignKey("capture_contents.hash"), index=True)
    companion_name: Mapped[str | None] = mapped_column(String(200))
    companion_hash: Mapped[str | None] = mapped_column(
        ForeignKey("capture_contents.hash"), index=True
    )
    format: Mapped[str] = mapped_column(String(40))
    kind: Mapped[str] = mapped_column(String(20))
    frames: Mapped[int]
    rate_hz: Mapped[float]
    duration_s: Mapped[float]
    tracks: Mapped[int]
    fingerprint: Mapped[str | None] = mapped_column(String(64), index=True)
    reading: Mapped[dict[str, Any]] = mapped_column(JSON)
    summary: Mapped[dict[str, Any]] = mapped_column(JSON)
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime] = mapped_column(index=True)


class SavedJointMap(Base):
    """One version of a skeleton's joint map; versions are appended, and the newest is used.

    `joint_map` is body joint -> joint of the skeleton. If `chosen` is false, a user reverted to the
    proposed map, and this one is empty.
    """

    __tablename__ = "joint_maps"

    fingerprint: Mapped[str] = mapped_column(String(64), primary_key=True)
    version: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    chosen: Mapped[bool]
    joint_map: Mapped[dict[str, Any]] = mapped_column(JSON)
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]
