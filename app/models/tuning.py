"""The table of tunings: searches for an avatar's gains, during and after their computation."""

from typing import Any

from sqlalchemy import JSON, CheckConstraint, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcTime


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
