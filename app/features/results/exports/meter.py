"""How far an export is, told by the process that writes it to the one that is asked.

Five numbers in a small file: the writer overwrites them in place, readers read them whenever they
like. A reader that meets an unfinished write sees one number older than another, which no page
notices; nobody waits for anybody, and nothing is left when either process dies.
"""

import os
import struct
from dataclasses import astuple, dataclass
from pathlib import Path

_LAYOUT = struct.Struct("<5q")


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
    """The small file at `path`."""

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
