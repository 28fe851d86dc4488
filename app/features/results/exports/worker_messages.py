"""The order, progress and result that the server and an export's worker process exchange.

Nothing here loads pandas: the server's own process does not need it for an export.
"""

import os
import struct
from dataclasses import astuple, dataclass
from datetime import datetime
from pathlib import Path

from app.features.results.analysis import Kind

_LAYOUT = struct.Struct("<5q")


@dataclass(frozen=True)
class ExportOrder:
    """The data to export, and the file to write; `keep_free_bytes` of the disk are left free."""

    url: str
    study_key: str
    kind: Kind
    session_id: str | None
    movement: bool
    now: datetime
    to: Path
    meter: Path
    keep_free_bytes: int


@dataclass(frozen=True)
class ExportResult:
    """The result of a finished export: the file's size and hash, and its number of sessions.

    `revealed`: the open sessions of a blinded study whose condition the file shows.
    """

    size_bytes: int
    sha256: str
    sessions: int
    revealed: frozenset[str] = frozenset()


@dataclass(frozen=True)
class ExportFailure:
    """The reason why an export failed, worded for the person who ordered it."""

    message: str
    remedy: str


@dataclass
class Progress:
    """The number of rows of movement and of sessions written so far, and the file's size."""

    rows: int = 0
    rows_total: int = 0
    sessions: int = 0
    sessions_total: int = 0
    bytes: int = 0


@dataclass(frozen=True)
class Meter:
    """The progress file at `path`, in which a worker process records its progress as five numbers.

    The writer overwrites them in place, readers read them at any time. A reader during an
    unfinished write sees one number older than another, which is harmless; no locks are needed, and
    no lock remains if either process dies.
    """

    path: Path

    def write(self, progress: Progress) -> None:
        """Overwrite the progress in the file."""
        handle = os.open(self.path, os.O_WRONLY | os.O_CREAT, 0o600)
        try:
            os.pwrite(handle, _LAYOUT.pack(*astuple(progress)), 0)
        finally:
            os.close(handle)

    def read(self) -> Progress:
        """Return the latest progress, or zeros if nothing was written yet."""
        try:
            return Progress(*_LAYOUT.unpack(self.path.read_bytes()))
        except (OSError, struct.error):
            return Progress()
