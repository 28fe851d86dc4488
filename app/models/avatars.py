"""Configurations of avatars: named, and every version that was ever saved."""

from typing import Any

from sqlalchemy import JSON, CheckConstraint, ForeignKey, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import UtcTime


class Avatar(Base):
    """An avatar's configuration by its key; how it behaves stands in its versions."""

    __tablename__ = "avatars"

    key: Mapped[str] = mapped_column(String(80), primary_key=True)
    title: Mapped[str] = mapped_column(String(200))
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]


class AvatarVersion(Base):
    """One content of a configuration; versions are appended and never edited or deleted.

    A session names a content by its hash, which is taken over `canonical_json`. `origin` is how the
    content came about. `report` is what tuning measured and with which settings, null otherwise.
    """

    __tablename__ = "avatar_versions"
    __table_args__ = (
        CheckConstraint("origin IN ('shipped', 'tuned', 'by_hand', 'loaded')", "origin"),
    )

    key: Mapped[str] = mapped_column(ForeignKey("avatars.key"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    content_hash: Mapped[str] = mapped_column(String(64), index=True)
    canonical_json: Mapped[str] = mapped_column(Text)
    origin: Mapped[str] = mapped_column(String(20))
    note: Mapped[str] = mapped_column(Text)
    report: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]
