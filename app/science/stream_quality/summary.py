"""Count the faults of a stream over a span of frames."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.science.skeleton import JOINT_COUNT, JOINT_NAMES
from app.science.stream_quality.examination import Examination, examine
from app.science.stream_quality.limits import DEFAULT_LIMITS, QualityError, QualityLimits

Floats = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class StreamQuality:
    """The number and duration of the faults of one stream over a span.

    `span_s` is the sum of the intervals between frames, `frame_rate_hz` is one over their median
    (None with fewer than two frames). `gap_s` is the sum of the intervals that are gaps. `jumps`
    counts frames: a pose that is off for one frame jumps twice. `frozen_s` (22,) is how long each
    joint was frozen. `non_finite`, `non_unit` and `backwards` count frames.
    """

    frames: int
    span_s: float
    frame_rate_hz: float | None
    gaps: int
    gap_s: float
    longest_gap_s: float
    jumps: int
    frozen_s: tuple[float, ...]
    non_unit: int
    non_finite: int
    backwards: int

    @property
    def frozen_joints(self) -> tuple[str, ...]:
        """The names of the joints that were frozen at any time, in the skeleton's order."""
        return tuple(
            name for name, time_s in zip(JOINT_NAMES, self.frozen_s, strict=True) if time_s > 0.0
        )


def assess(
    times_s: NDArray[np.float64],
    rotations: Floats,
    positions_m: Floats,
    *,
    limits: QualityLimits = DEFAULT_LIMITS,
    counted: NDArray[np.bool_] | None = None,
) -> StreamQuality:
    """Count the faults of a whole recording; arguments and errors are those of `examine`.

    `counted` (n,) marks the frames to count (None: all), such as those of active time. A fault
    between two frames counts if the earlier frame does. The other frames are still examined: a
    joint that moved in them may be found frozen later.
    """
    if counted is None:
        counted = np.ones(len(times_s), np.bool_)
    if counted.shape != times_s.shape:
        raise QualityError(
            f"counted {counted.shape} does not match {len(times_s)} frames:"
            " one truth value for each is needed."
        )
    return summarise(examine(times_s, rotations, positions_m, limits=limits), counted, limits)


def summarise(
    examination: Examination, counted: NDArray[np.bool_], limits: QualityLimits = DEFAULT_LIMITS
) -> StreamQuality:
    """Count the faults of an examination, in the frames marked by `counted` (n,)."""
    pacing = examination.pacing
    between = np.concatenate((counted[:1], counted[:-1]))
    forward = between & (pacing.interval_s > 0.0)
    interval_s = pacing.interval_s[forward]
    gap_s = pacing.interval_s[between & pacing.gap]
    return StreamQuality(
        frames=int(counted.sum()),
        span_s=float(interval_s.sum()),
        frame_rate_hz=1.0 / float(np.median(interval_s)) if len(interval_s) else None,
        gaps=len(gap_s),
        gap_s=float(gap_s.sum()),
        longest_gap_s=float(gap_s.max(initial=0.0)),
        jumps=int((examination.jumped & between).sum()),
        frozen_s=_frozen_s(examination, between, limits),
        non_unit=int((examination.non_unit & counted).sum()),
        non_finite=int((examination.non_finite & counted).sum()),
        backwards=int((pacing.backwards & between).sum()),
    )


def _frozen_s(
    examination: Examination, between: NDArray[np.bool_], limits: QualityLimits
) -> tuple[float, ...]:
    """Return how long each joint was frozen, in s, the time until it was detected included."""
    if not examination.frozen.any():
        return (0.0,) * JOINT_COUNT
    lasting_s = (
        np.where(between, examination.pacing.watched_s, 0.0)[:, np.newaxis] * examination.frozen
    )
    onsets = examination.frozen[1:] & ~examination.frozen[:-1] & between[1:, np.newaxis]
    waited_s = limits.frozen_s * onsets.sum(axis=0)
    return tuple(float(one) for one in lasting_s.sum(axis=0) + waited_s)


def combine(parts: Sequence[StreamQuality]) -> StreamQuality:
    """Combine the qualities of several client runs: counts add up, gaps between runs are unknown.

    The frame rate is that of the run with the most frames.
    """
    longest = max(parts, key=lambda part: part.frames, default=None)
    return StreamQuality(
        frames=sum(part.frames for part in parts),
        span_s=sum(part.span_s for part in parts),
        frame_rate_hz=None if longest is None else longest.frame_rate_hz,
        gaps=sum(part.gaps for part in parts),
        gap_s=sum(part.gap_s for part in parts),
        longest_gap_s=max((part.longest_gap_s for part in parts), default=0.0),
        jumps=sum(part.jumps for part in parts),
        frozen_s=tuple(sum(part.frozen_s[joint] for part in parts) for joint in range(JOINT_COUNT)),
        non_unit=sum(part.non_unit for part in parts),
        non_finite=sum(part.non_finite for part in parts),
        backwards=sum(part.backwards for part in parts),
    )
