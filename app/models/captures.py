"""Captures of movement: files stored once by their content, what they hold, and joint maps."""

from typing import Any

from sqlalchemy import JSON, BigInteger, CheckConstraint, ForeignKey, LargeBinary, String
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcTime


class CaptureContent(Base):
    """The content of an uploaded file, once however many captures use it.

    `hash` is the SHA-256 of the file's bytes, `size` their number.
    """

    __tablename__ = "capture_contents"

    hash: Mapped[str] = mapped_column(String(64), primary_key=True)
    size: Mapped[int] = mapped_column(BigInteger)


class CapturePiece(Base):
    """A part of a content's zstd stream; all parts in order are the stream.

    In parts, so that nobody who copies rows, such as a backup, ever holds a whole file in memory.
    """

    __tablename__ = "capture_pieces"

    hash: Mapped[str] = mapped_column(ForeignKey("capture_contents.hash"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    data: Mapped[bytes] = mapped_column(LargeBinary)


class CaptureRow(Base):
    """A capture: a file, perhaps with its companion, and what reading it found.

    `identity` names the contents of both, so that the same is stored once. `reading` holds the
    conventions that somebody chose, `summary` what the page shows; both are as in the schemas of
    the feature. `fingerprint` is that of its skeleton, null where it has none.
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
    """One version of a skeleton's joint map; versions are appended, the newest holds.

    `joint_map` is body joint -> joint of the skeleton. Where `chosen` is false, somebody went back
    to what is proposed, and the map is empty.
    """

    __tablename__ = "joint_maps"

    fingerprint: Mapped[str] = mapped_column(String(64), primary_key=True)
    version: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    chosen: Mapped[bool]
    joint_map: Mapped[dict[str, Any]] = mapped_column(JSON)
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]
