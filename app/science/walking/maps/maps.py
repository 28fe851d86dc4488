"""Compute the maps of whole databases: in parallel, with progress, stop and resume.

`maps_of` is an iterator: the caller stores its maps, and can resume later by passing the indices
that are `done`. A map depends on its entry only, so an interrupted run gives the same maps as an
uninterrupted one, whatever the number of threads. Threads are sufficient, since compiled agents do
not hold Python's global lock.
"""

import os
from collections import deque
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field

from app.science.walking.following import EuclideanMetric, SteeringFollower, course_of
from app.science.walking.maps.suitability import DeviationMap
from app.science.walking.records import (
    PAPER_GRID,
    Metric,
    ParameterGrid,
    PathFollower,
    PlannedWalk,
    WalkingError,
    reference_of,
)

AHEAD = 2
"""Number of maps per thread that are started before they are requested."""


@dataclass(frozen=True)
class MapMaker:
    """Computes maps with a grid, a follower and a metric; the defaults are the paper's.

    Attributes:
        grid: combinations of the follower's parameters.
        follower: moves the agents.
        metric: compares them with the walk.
    """

    grid: ParameterGrid = PAPER_GRID
    follower: PathFollower = field(default_factory=SteeringFollower)
    metric: Metric = field(default_factory=EuclideanMetric)

    def __post_init__(self) -> None:
        """Raise WalkingError if the grid's parameters differ from the follower's."""
        names = [parameter.name for parameter in self.grid.parameters]
        expected = [parameter.name for parameter in self.follower.parameters]
        if names != expected:
            raise WalkingError(f"The follower is steered by {expected}, the grid is over {names}.")

    def map_of(self, entry: PlannedWalk) -> DeviationMap:
        """Re-simulate one walk with every combination of parameters."""
        reference = reference_of(entry.walk, self.follower.dt_s)
        course = course_of(entry.walk, entry.path, self.follower.dt_s)
        trajectories = self.follower.follow(course, self.grid.nodes)
        deviations = self.metric.deviations(reference, trajectories)
        return DeviationMap(
            self.grid,
            self.metric.name,
            deviations.reshape(self.grid.shape),
            trajectories.arrival_s.reshape(self.grid.shape),
            reference.duration_s,
        )


def maps_of(
    entries: Sequence[PlannedWalk],
    maker: MapMaker,
    *,
    done: Collection[int] = (),
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    stop: Callable[[], bool] | None = None,
) -> Iterator[tuple[int, DeviationMap]]:
    """Compute the maps of a database, in its order.

    Args:
        entries, maker: the database, and how its maps are computed.
        done: indices of entries whose maps exist already.
        threads: number of threads, by default one for each processor.
        progress: function that is called with (finished, total) after each map, including those
            already done.
        stop: function that is called before each map; if it returns True the iterator ends, and no
            map is started.

    Yields:
        (index, map) of each entry that was not done.
    """
    remaining = sorted(set(range(len(entries))) - set(done))
    finished = len(entries) - len(remaining)
    workers = threads or os.cpu_count() or 1
    running: deque[tuple[int, Future[DeviationMap]]] = deque()
    upcoming = iter(remaining)
    pool = ThreadPoolExecutor(workers, thread_name_prefix="maps")
    try:
        while True:
            while len(running) < AHEAD * workers and (index := next(upcoming, -1)) >= 0:
                running.append((index, pool.submit(maker.map_of, entries[index])))
            if not running or (stop is not None and stop()):
                return
            index, future = running.popleft()
            result, finished = future.result(), finished + 1
            if progress is not None:
                progress(finished, len(entries))
            yield index, result
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
