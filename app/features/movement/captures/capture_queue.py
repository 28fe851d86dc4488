"""Parse captures and compute with them in a worker process, one at a time, within limits.

A text file of an hour of movement takes Python many seconds, and a malicious file could take
forever or fill the memory. The process limits both, without an effect on running sessions. Results
are cached, so that a page that repeats its request gets them immediately.
"""

import sys
from dataclasses import dataclass, field
from importlib import import_module
from typing import ClassVar

import psutil

from app.errors import InvalidInput
from app.features.movement.captures.source import Cannot
from app.platform.job_queue import JobMessages, JobQueue
from app.platform.workers import Worker

WITHIN_S = 120.0
"""Time limit of one task; a capture of an hour takes a quarter of it."""
MEMORY_BYTES = 3 * 1024**3
"""Memory that the process may use in addition to its program."""
MAX_CACHED_BYTES = 64 * 1024**2


def limit_memory() -> None:
    """Import needed modules, then limit the process's memory; runs in the worker process."""
    import_module("app.features.movement.captures.worker_tasks")
    if sys.platform == "linux":
        import resource

        most = psutil.Process().memory_info().vms + MEMORY_BYTES
        resource.setrlimit(resource.RLIMIT_AS, (most, resource.RLIM_INFINITY))


@dataclass
class CaptureQueue(JobQueue):
    """Runs the tasks of captures one after the other, and caches their results (bytes)."""

    messages: ClassVar[JobMessages] = JobMessages(
        busy="the server is busy with other captures",
        cannot="the capture cannot be processed",
        ended="the process that read it ended",
        less="Cut the recording into shorter ones, or leave out tracks.",
        otherwise="Check the file with the program that made it; see the server's log for details.",
        log="a capture could not be processed",
    )
    # The process may not have released the memory that it had allocated.
    memory_errors: ClassVar[tuple[type[Exception], ...]] = (MemoryError,)
    within_s: float = WITHIN_S
    _worker: Worker = field(default_factory=lambda: Worker(limit_memory))

    def _cache_is_full(self) -> bool:
        return sum(map(len, self._cache.values())) > MAX_CACHED_BYTES and len(self._cache) > 1

    def _refusal(self, error: Exception) -> InvalidInput | None:
        if not isinstance(error, Cannot):
            return None
        at = {"path": error.file_name, "line": error.line, "message": error.reason}
        place = f"{error.file_name}, line {error.line}: " if error.line else ""
        return InvalidInput(
            f"{place}{error.reason}",
            value=error.file_name or None,
            remedy=(
                "Correct this in the program that recorded it and export the file again. Help, "
                "“Capture formats”, lists what can be read."
            ),
            details=[at] if error.file_name else [],
        )
