"""What the worker process does: a step of watching how trackers lie in a headset's world."""

from dataclasses import dataclass

from app.science.alignment import (
    AlignmentError,
    Looking,
    PoseStream,
    Problem,
    Watched,
    fit_alignment,
    looking_around,
    start_watching,
    watch,
)
from app.science.rotations import FloatArray

ROW = ("at_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", "weight")
"""The columns of the poses of a thing over time; weight 0: the tracking system guessed it."""


@dataclass(frozen=True, eq=False)
class WatchStep:
    """What a step of watching brought.

    `problem` and `looking`: why there is no alignment yet, and how far the head has turned; both
    are None while there is one.
    """

    watched: Watched
    problem: Problem | None = None
    looking: Looking | None = None


def watch_step(watched: Watched | None, head: FloatArray, tracker: FloatArray) -> WatchStep:
    """Take a step of `app.science.alignment.watch`, and say what is missing for a first fit.

    Args:
        watched: the state after the step before; None before the first one.
        head: (N, 9) the head by the headset, with the columns of `ROW`, by the headset's clock.
        tracker: (M, 9) the tracker on the head, likewise and by the same clock.
    """
    headset = _stream(head)
    reference = _stream(tracker)
    found = watch(watched or start_watching(float(head[0, 0])), headset, reference)
    if found.alignment is not None:
        return WatchStep(found)
    since = headset.between(found.since_s, float(headset.times_s[-1]))
    looking = looking_around(since.rotations) if len(since.times_s) > 1 else None
    try:
        fit_alignment(since, reference)
    except AlignmentError as error:
        return WatchStep(found, error.problem, looking)
    return WatchStep(found, None, looking)


def _stream(rows: FloatArray) -> PoseStream:
    return PoseStream.of(rows[:, 0], rows[:, 1:4], rows[:, 4:8], rows[:, 8])
