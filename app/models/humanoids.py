"""Humanoid models: files stored once by their content, and what an avatar's body needs of them."""

from sqlalchemy import CheckConstraint, ForeignKey, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import UtcTime


class HumanoidRow(Base):
    """A model by the SHA-256 of its file; configurations name it, so it is never deleted.

    `figure` is its measures and convex pieces as canonical JSON (`app.protocol.humanoid`); what
    lists show of it stands beside it. `bones_by` is who said which bone is which body part.
    """

    __tablename__ = "humanoids"
    __table_args__ = (CheckConstraint("bones_by IN ('vrm', 'names')", "bones_by"),)

    hash: Mapped[str] = mapped_column(ForeignKey("capture_contents.hash"), primary_key=True)
    file_name: Mapped[str] = mapped_column(String(200))
    figure: Mapped[str] = mapped_column(Text)
    bones_by: Mapped[str] = mapped_column(String(20))
    stature_m: Mapped[float]
    parts: Mapped[int]
    pieces: Mapped[int]
    left_fingers: Mapped[int]
    right_fingers: Mapped[int]
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]
