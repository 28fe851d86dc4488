"""Compute predictions of walking in a worker process, one at a time, within a time limit.

It is not the process that fits models, so that pages get answers during a fit. Results are cached.
"""

from dataclasses import dataclass, field
from importlib import import_module
from typing import ClassVar

from app.errors import InvalidInput
from app.features.movement.walking.sources import Cannot
from app.platform.job_queue import JobMessages, JobQueue
from app.platform.workers import Worker

WITHIN_S = 120.0
"""Time limit of one prediction; tables of hours of tracks take half a minute."""


def load() -> None:
    """Import the modules that every prediction needs; runs in the worker process."""
    import_module("app.features.movement.walking.predicting")


@dataclass
class PredictionQueue(JobQueue):
    """Computes predictions one after the other, and caches their results."""

    messages: ClassVar[JobMessages] = JobMessages(
        busy="the server is busy with other predictions of walking",
        cannot="the prediction cannot be computed",
        less="Take fewer walks, fewer draws or a shorter path.",
        log="a prediction of walking could not be computed",
    )
    within_s: float = WITHIN_S
    _worker: Worker = field(default_factory=lambda: Worker(load))

    def _refusal(self, error: Exception) -> InvalidInput | None:
        if not isinstance(error, Cannot):
            return None
        return InvalidInput(error.reason, remedy=error.remedy)
