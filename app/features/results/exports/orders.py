"""What the server and the process that writes an export say to each other: order, progress, result.

Nothing here loads pandas: the server itself never needs it for an export.
"""

import os
import struct
from dataclasses import astuple, dataclass
from datetime import datetime
from pathlib import Path

from app.features.results.analysis import Kind

_LAYOUT = struct.Struct("<5q")


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
    """A complete file: its size, its hash, and how many sessions it holds.

    `revealed`: those of a blinded study that were not completed and tell their condition.
    """

    size_bytes: int
    sha256: str
    sessions: int
    revealed: frozenset[str] = frozenset()


@dataclass(frozen=True)
class NotMade:
    """Why there is no file, in words for whoever asked."""

    message: str
    remedy: str


@dataclass
class Progress:
    """Rows of movement and sessions that are written, of how many, and bytes of the file."""

    rows: int = 0
    rows_total: int = 0
    sessions: int = 0
    sessions_total: int = 0
    bytes: int = 0


@dataclass(frozen=True)
class Meter:
    """The small file at `path`: five numbers, how far the process is.

    The writer overwrites them in place, readers read them whenever they like. A reader that meets
    an unfinished write sees one number older than another, which no page notices; nobody waits for
    anybody, and nothing is left when either process dies.
    """

    path: Path

    def tell(self, progress: Progress) -> None:
        """Overwrite what was told before."""
        handle = os.open(self.path, os.O_WRONLY | os.O_CREAT, 0o600)
        try:
            os.pwrite(handle, _LAYOUT.pack(*astuple(progress)), 0)
        finally:
            os.close(handle)

    def read(self) -> Progress:
        """What was told last; nothing where nothing was."""
        try:
            return Progress(*_LAYOUT.unpack(self.path.read_bytes()))
        except (OSError, struct.error):
            return Progress()
