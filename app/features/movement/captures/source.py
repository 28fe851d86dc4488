"""Which files make a capture, and by which conventions they are to be read."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from app.features.movement.captures.schemas import ReadingChoice
from app.models import CaptureRow


@dataclass(frozen=True)
class Source:
    """Names one reading of one capture; whoever has read it need not read it again.

    `hash` and `companion_hash` are SHA-256 of the files' bytes.
    """

    name: str
    hash: str
    companion_name: str | None
    companion_hash: str | None
    metres_per_unit: float | None
    up: Literal["x", "y", "z"] | None

    @property
    def identity(self) -> str:
        """The same for the same files, whatever they are called and however they are read."""
        if self.companion_hash is None:
            return self.hash
        return hashlib.sha256(f"{self.hash} {self.companion_hash}".encode()).hexdigest()

    @property
    def hashes(self) -> Iterator[str]:
        """Of the file and of its companion, if there is one."""
        yield self.hash
        if self.companion_hash is not None:
            yield self.companion_hash


def source_of(row: CaptureRow, reading: ReadingChoice | None = None) -> Source:
    """How a stored capture is read, or how it would be by other conventions."""
    chosen = reading or ReadingChoice.model_validate(row.reading)
    return Source(
        name=row.file_name,
        hash=row.content_hash,
        companion_name=row.companion_name,
        companion_hash=row.companion_hash,
        metres_per_unit=chosen.metres_per_unit,
        up=chosen.up,
    )


class Cannot(Exception):  # an error is named after what happened
    """A capture cannot be read, or cannot be brought onto an avatar: the process tells the server.

    `file_name` and `line` are where, if that is known; line 0 is the whole file.
    """

    def __init__(self, reason: str, file_name: str = "", line: int = 0) -> None:
        # All of them as they came: errors travel between processes by their arguments.
        super().__init__(reason, file_name, line)
        self.reason, self.file_name, self.line = reason, file_name, line
