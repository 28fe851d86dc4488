"""The humanoid models of the lab, and the figure of one for an avatar's body."""

from functools import lru_cache

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import NotFound
from app.models import HumanoidRow
from app.protocol.humanoid import parse_figure
from app.science.avatar.body import Figure


def humanoid_by_hash(db: Session, content_hash: str) -> HumanoidRow:
    """The model; raises NotFound."""
    row = db.get(HumanoidRow, content_hash)
    if row is None:
        raise NotFound(
            "there is no such humanoid model",
            value=content_hash,
            remedy="Upload its file, or choose one of those that are listed.",
        )
    return row


def figure_by_hash(db: Session, content_hash: str | None) -> Figure | None:
    """The figure that a configuration names, None where it names none; raises NotFound."""
    if content_hash is None:
        return None
    return parsed_figure(humanoid_by_hash(db, content_hash).figure)


def is_known(db: Session, content_hash: str) -> bool:
    """Whether there is such a model."""
    found = select(HumanoidRow.hash).where(HumanoidRow.hash == content_hash)
    return db.scalar(found) is not None


@lru_cache(maxsize=16)
def parsed_figure(text: str) -> Figure:
    """A stored figure."""
    return parse_figure(text)
