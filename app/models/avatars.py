"""Tables of avatars: humanoid models with their measures, versions of configurations, tunings."""

from typing import Any

from sqlalchemy import JSON, CheckConstraint, ForeignKey, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcTime


class HumanoidRow(Base):
    """A humanoid model by the SHA-256 of its file.

    Deleted only while it has no name and no configuration or tuning refers to it. `figure` is its
    measures and convex pieces as canonical JSON (`app.protocol.humanoid`); the other columns repeat
    the values that lists show. `bones_by` is how its bones were mapped to body parts.

    `name`: how studies refer to it, unique and never changed once given. `licence`: what its file
    says of its author and terms, `confirmed`: the terms that somebody has confirmed to be met
    (`app.features.movement.humanoids`). Licence, triangles, vertices and textures are null until
    the file is measured by a release that reads them.
    """

    __tablename__ = "humanoids"
    __table_args__ = (
        CheckConstraint("bones_by IN ('vrm', 'names')", "bones_by"),
        CheckConstraint("origin IN ('shipped', 'uploaded')", "origin"),
    )

    hash: Mapped[str] = mapped_column(ForeignKey("capture_contents.hash"), primary_key=True)
    file_name: Mapped[str] = mapped_column(String(200))
    figure: Mapped[str] = mapped_column(Text)
    bones_by: Mapped[str] = mapped_column(String(20))
    stature_m: Mapped[float]
    parts: Mapped[int]
    pieces: Mapped[int]
    left_fingers: Mapped[int]
    right_fingers: Mapped[int]
    name: Mapped[str | None] = mapped_column(String(80), unique=True)
    title: Mapped[str | None] = mapped_column(String(200))
    origin: Mapped[str] = mapped_column(String(20), default="uploaded", server_default="uploaded")
    licence: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    confirmed: Mapped[list[dict[str, Any]] | None] = mapped_column(JSON(none_as_null=True))
    triangles: Mapped[int | None]
    vertices: Mapped[int | None]
    textures: Mapped[int | None]
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]


class Avatar(Base):
    """An avatar's configuration by its key; its content is in its versions."""

    __tablename__ = "avatars"

    key: Mapped[str] = mapped_column(String(80), primary_key=True)
    title: Mapped[str] = mapped_column(String(200))
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]


class AvatarVersion(Base):
    """One version of an avatar's configuration; versions are appended, never edited or deleted.

    A session refers to a content by its hash, which is computed from `canonical_json`. `origin` is
    how the content was created. `report` has the tuning's measurements and settings, null
    otherwise.
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


class AvatarTuningRow(Base):
    """A tuning of an avatar's configuration.

    `canonical_json` is the configuration that is tuned, without parts that its model lacks, and
    `content_hash` its hash; `key` and `number` are the stored version it was taken from, null for
    an unsaved one. `summary` is null until it is ready; `trouble` is why it failed.
    """

    __tablename__ = "avatar_tunings"
    __table_args__ = (
        CheckConstraint("state IN ('tuning', 'stopped', 'ready', 'failed')", "state"),
    )

    id: Mapped[Id]
    key: Mapped[str | None] = mapped_column(String(80))
    number: Mapped[int | None]
    content_hash: Mapped[str] = mapped_column(String(64))
    canonical_json: Mapped[str] = mapped_column(Text)
    stature_m: Mapped[float]
    options: Mapped[dict[str, Any]] = mapped_column(JSON)
    state: Mapped[str] = mapped_column(String(20))
    summary: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    trouble: Mapped[str | None] = mapped_column(Text)
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime] = mapped_column(index=True)
    ended_at: Mapped[UtcTime | None]
