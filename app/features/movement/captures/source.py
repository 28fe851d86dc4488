"""The files of a capture and the conventions to parse them with, as one hashable key."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from app.features.movement.captures.schemas import ReadingChoice
from app.models import CaptureRow


@dataclass(frozen=True)
class Source:
    """The files and conventions of a capture; the key under which a parsed capture is cached.

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
        """Return a hash of the files' contents, independent of names and conventions."""
        if self.companion_hash is None:
            return self.hash
        return hashlib.sha256(f"{self.hash} {self.companion_hash}".encode()).hexdigest()

    @property
    def hashes(self) -> Iterator[str]:
        """Yield the hash of the file and that of its companion, if there is one."""
        yield self.hash
        if self.companion_hash is not None:
            yield self.companion_hash


def source_of(row: CaptureRow, reading: ReadingChoice | None = None) -> Source:
    """Return the source of a stored capture, with its own or with other conventions."""
    chosen = reading or ReadingChoice.model_validate(row.reading)
    return Source(
        name=row.file_name,
        hash=row.content_hash,
        companion_name=row.companion_name,
        companion_hash=row.companion_hash,
        metres_per_unit=chosen.metres_per_unit,
        up=chosen.up,
    )


class Cannot(Exception):
    """A capture cannot be parsed or retargeted; raised in the worker process, passed to the server.

    `file_name` and `line` locate the problem, if that is known; line 0 is the whole file.
    """

    def __init__(self, reason: str, file_name: str = "", line: int = 0) -> None:
        # All arguments are passed on, because errors are pickled by their arguments.
        super().__init__(reason, file_name, line)
        self.reason, self.file_name, self.line = reason, file_name, line
