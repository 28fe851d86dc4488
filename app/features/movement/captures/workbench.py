"""Captures are read and computed in a process of their own, one at a time, within limits.

A text file of an hour of movement takes Python many seconds, and a file may be made to take for
ever or to fill the memory. The process has an end to both; running sessions do not notice. What was
computed is kept for a while, so that a page which asks again gets it at once.
"""

import sys
from dataclasses import dataclass, field
from importlib import import_module
from typing import ClassVar

import psutil

from app.errors import InvalidInput
from app.features.movement.captures.source import Cannot
from app.platform.job_queue import Words, WorkingLine
from app.platform.workers import Worker

WITHIN_S = 120.0
"""The longest that anything may take; a capture of an hour takes a quarter of it."""
MEMORY_BYTES = 3 * 1024**3
"""What the process may ask for beyond its own program."""
KEPT_BYTES = 64 * 1024**2


def limit_memory() -> None:
    """In the process: load what is needed anyway, then let it grow by so much and no more."""
    import_module("app.features.movement.captures.tasks")
    if sys.platform == "linux":
        import resource

        most = psutil.Process().memory_info().vms + MEMORY_BYTES
        resource.setrlimit(resource.RLIMIT_AS, (most, resource.RLIM_INFINITY))


@dataclass
class Workbench(WorkingLine):
    """Has one thing done after the other; what is kept of it is bytes."""

    words: ClassVar[Words] = Words(
        busy="the server is busy with other captures",
        cannot="the capture cannot be processed",
        ended="the process that read it ended",
        less="Cut the recording into shorter ones, or leave out tracks.",
        otherwise="Check the file with the program that made it; the server's log has more.",
        log="a capture could not be processed",
    )
    # What it had taken by then is not given back for certain.
    fill_the_process: ClassVar[tuple[type[Exception], ...]] = (MemoryError,)
    within_s: float = WITHIN_S
    _worker: Worker = field(default_factory=lambda: Worker(limit_memory))

    def _keeps_too_much(self) -> bool:
        return sum(map(len, self._kept.values())) > KEPT_BYTES and len(self._kept) > 1

    def _refusal(self, error: Exception) -> InvalidInput | None:
        if not isinstance(error, Cannot):
            return None
        at = {"path": error.file_name, "line": error.line, "message": error.reason}
        place = f"{error.file_name}, line {error.line}: " if error.line else ""
        return InvalidInput(
            f"{place}{error.reason}",
            value=error.file_name or None,
            remedy="Mend or export the file again; docs/captures.md lists what can be read.",
            details=[at] if error.file_name else [],
        )
