"""Tables of walking: scenes, sets of walks, and the models fitted to them."""

from typing import Any

from sqlalchemy import JSON, CheckConstraint, ForeignKey, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import Id, UtcTime


class WalkingScene(Base):
    """A floor with obstacles, as the text of its file; keys are unique."""

    __tablename__ = "walking_scenes"

    key: Mapped[str] = mapped_column(String(64), primary_key=True)
    title: Mapped[str] = mapped_column(String(200))
    text: Mapped[str] = mapped_column(Text)
    content_hash: Mapped[str] = mapped_column(String(64))
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]


class WalkSetRow(Base):
    """A set of walks to fit models to: people's tracks, stored as a table, or synthetic walkers.

    `origin` is where they come from and how they are read, `summary` their figures; both follow the
    schemas of the feature. `content_hash` is null for synthetic walkers, which are reproduced from
    their seed.
    """

    __tablename__ = "walk_sets"
    __table_args__ = (CheckConstraint("kind IN ('human', 'synthetic')", "kind"),)

    id: Mapped[Id]
    title: Mapped[str] = mapped_column(String(200))
    kind: Mapped[str] = mapped_column(String(20))
    origin: Mapped[dict[str, Any]] = mapped_column(JSON)
    content_hash: Mapped[str | None] = mapped_column(
        ForeignKey("capture_contents.hash"), index=True
    )
    summary: Mapped[dict[str, Any]] = mapped_column(JSON)
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime] = mapped_column(index=True)


class WalkingModelRow(Base):
    """A model of how people walk, during and after its fitting.

    `walk_set` and `scene` are copies of what it is fitted to, so that it can still be understood
    after those are deleted. `content_hash` is that of its file, null until it is ready; `trouble`
    is why the fitting failed.
    """

    __tablename__ = "walking_models"
    __table_args__ = (
        CheckConstraint("state IN ('fitting', 'stopped', 'ready', 'failed')", "state"),
        CheckConstraint("kind IN ('human', 'synthetic')", "kind"),
    )

    id: Mapped[Id]
    title: Mapped[str] = mapped_column(String(200))
    kind: Mapped[str] = mapped_column(String(20))
    state: Mapped[str] = mapped_column(String(20))
    walk_set_id: Mapped[str | None] = mapped_column(ForeignKey("walk_sets.id"), index=True)
    walk_set: Mapped[dict[str, Any]] = mapped_column(JSON)
    scene: Mapped[dict[str, Any] | None] = mapped_column(JSON)
    options: Mapped[dict[str, Any]] = mapped_column(JSON)
    content_hash: Mapped[str | None] = mapped_column(
        ForeignKey("capture_contents.hash"), index=True
    )
    summary: Mapped[dict[str, Any] | None] = mapped_column(JSON)
    trouble: Mapped[str | None] = mapped_column(Text)
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime] = mapped_column(index=True)
    ended_at: Mapped[UtcTime | None]
