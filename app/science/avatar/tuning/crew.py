"""A few threads that do one thing for each of many axes, tell how far they are, and can be stopped.

Threads and not processes: the 89 axes of a whole body take 5.5 s of processor time, and two threads
need 3.7 s for them, as the trials let each other run while the relay experiments hardly do.
Processes would spend the difference on starting.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import TypeVar

from app.science.avatar.tuning.results import Phase, TuningCancelled, TuningProgress

Result = TypeVar("Result")


class Crew:
    """Does things axis by axis.

    Args:
        workers: threads.
        progress: told after each axis, in the caller's thread.
        cancelled: asked after each axis.
    """

    def __init__(
        self,
        workers: int,
        progress: Callable[[TuningProgress], None],
        cancelled: Callable[[], bool],
    ) -> None:
        self._workers, self._progress, self._cancelled = workers, progress, cancelled

    def each(
        self, attempt: int, phase: Phase, axes: Sequence[str], work: Callable[[str], Result]
    ) -> dict[str, Result]:
        """Return axis -> result, in the order of the axes; raises TuningCancelled."""
        results: dict[str, Result] = {}
        with ThreadPoolExecutor(self._workers) as pool:
            futures = {pool.submit(work, axis): axis for axis in axes}
            for done, future in enumerate(as_completed(futures), start=1):
                if self._cancelled():
                    pool.shutdown(wait=True, cancel_futures=True)
                    raise TuningCancelled
                axis = futures[future]
                results[axis] = future.result()
                self._progress(TuningProgress(attempt, phase, axis, done, len(axes)))
        return {axis: results[axis] for axis in axes}
