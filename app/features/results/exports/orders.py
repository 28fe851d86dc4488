"""What the server asks of the process that writes an export, and what it hears from it.

Nothing here loads pandas: the server itself never needs it for an export.
"""

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from app.features.results.analysis.schemas import Kind


@dataclass(frozen=True)
class Order:
    """What to write where. `keep_free_bytes` of the disk are left for what is recorded."""

    url: str
    study_key: str
    kind: Kind
    session_id: str | None
    now: datetime
    to: Path
    meter: Path
    keep_free_bytes: int


@dataclass(frozen=True)
class Made:
    """A complete file: its size, its hash, and how many sessions it holds."""

    size_bytes: int
    sha256: str
    sessions: int


@dataclass(frozen=True)
class NotMade:
    """Why there is no file, in words for whoever asked."""

    message: str
    remedy: str


def make_archive(order: Order) -> Made | NotMade:
    """In the process: write the file, or say why not."""
    from app.features.results.exports.making import made

    return made(order)
