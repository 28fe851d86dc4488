"""Run one task for each of many axes in a few threads, with progress reports and cancellation.

Threads rather than processes: the 89 axes of a whole body take 5.5 s of processor time, for which
two threads need 3.7 s, as the step responses run in parallel while the relay experiments hardly do.
Starting processes would cost more than the difference.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import TypeVar, cast

from app.science.avatar.tuning.results import (
    Phase,
    TuningCancelled,
    TuningJournal,
    TuningProgress,
)

Result = TypeVar("Result")


class AxisPool:
    """Runs a task for each of many axes in parallel threads.

    Args:
        workers: number of threads.
        progress: function that is called after each axis, in the caller's thread.
        cancelled: function that is called after each axis and returns whether to stop.
        journal: keeps the results; those that it knows are not computed again.
    """

    def __init__(
        self,
        workers: int,
        progress: Callable[[TuningProgress], None],
        cancelled: Callable[[], bool],
        journal: TuningJournal | None = None,
    ) -> None:
        self._workers, self._progress, self._cancelled = workers, progress, cancelled
        self._journal, self._runs = journal, 0

    def run(
        self, attempt: int, phase: Phase, axes: Sequence[str], work: Callable[[str], Result]
    ) -> dict[str, Result]:
        """Return axis -> result, in the order of the axes; raise TuningCancelled if cancelled."""
        run, journal = self._runs, self._journal
        self._runs += 1
        results: dict[str, Result] = {}
        for axis in axes:
            known = None if journal is None else journal.known(run, axis)
            if known is not None:
                results[axis] = cast("Result", known)
                self._progress(TuningProgress(attempt, phase, axis, len(results), len(axes)))
        with ThreadPoolExecutor(self._workers) as pool:
            futures = {pool.submit(work, axis): axis for axis in axes if axis not in results}
            for future in as_completed(futures):
                if self._cancelled():
                    pool.shutdown(wait=True, cancel_futures=True)
                    raise TuningCancelled
                axis = futures[future]
                results[axis] = result = future.result()
                if journal is not None:
                    journal.keep(run, attempt, phase, axis, result)
                self._progress(TuningProgress(attempt, phase, axis, len(results), len(axes)))
        return {axis: results[axis] for axis in axes}
