"""Compute the curves and comparisons of finished tunings in a worker process, one at a time.

It is not a process that tunes, so pages get answers during a tuning. Results are cached.
"""

from dataclasses import dataclass, field
from importlib import import_module
from typing import ClassVar

from app.errors import InvalidInput
from app.features.movement.tuning.order import CannotTune
from app.platform.job_queue import JobMessages, JobQueue
from app.platform.workers import Worker

WITHIN_S = 120.0
"""Time limit of one request; a minute of a capture takes about twenty seconds."""


def load() -> None:
    """Import the modules that every request needs; runs in the worker process."""
    import_module("app.features.movement.tuning.worker_tasks")


@dataclass
class TuningDesk(JobQueue):
    """Computes curves and comparisons one after the other, and caches them."""

    messages: ClassVar[JobMessages] = JobMessages(
        busy="the server is busy with other tunings' curves and comparisons",
        cannot="this cannot be computed",
        less="Choose a shorter part of the capture.",
        log="curves or a comparison of a tuning could not be computed",
    )
    max_cached: ClassVar[int] = 200
    within_s: float = WITHIN_S
    _worker: Worker = field(default_factory=lambda: Worker(load))

    def _refusal(self, error: Exception) -> InvalidInput | None:
        if not isinstance(error, CannotTune):
            return None
        return InvalidInput(
            f"this cannot be computed: {error}",
            value=error.value,
            valid=error.valid,
            remedy="Choose another capture, or tune a body that can be built.",
        )
