"""Walks out of a long track: cut where the person stands still.

A person stands where the smoothed speed stays under a threshold for a while. What lies between
standings and leads far enough is a walk; its travel time is from the last slow sample before to
the first slow sample after. Where the track begins or ends amid a walk, the walk says so.

Tracks are smoothed as in the paper. It filters its captures of 120 Hz with `gaussian_filter1d`,
sigma = 2 samples, so that the jerks of each step matter less. At other rates sigma is the same
time, 1/60 s.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import BoolArray, Track, Walk, WalkingError

SIGMA_S = 2.0 / 120.0
REACH = 4.0
"""The filter ends that many sigma away, as SciPy's does."""


def evenly(track: Track) -> tuple[FloatArray, FloatArray]:
    """Times and places of a track at a constant rate, its own by the median step.

    Loggers seldom keep one; a filter over samples needs it.
    """
    times_s, rate_hz = track.times_s, track.rate_hz
    count = max(2, round((times_s[-1] - times_s[0]) * rate_hz) + 1)
    even_s = np.linspace(times_s[0], times_s[-1], count)
    columns = [np.interp(even_s, times_s, track.xy_m[:, axis]) for axis in (0, 1)]
    return even_s, np.stack(columns, axis=-1)


def smoothed(xy_m: FloatArray, rate_hz: float, sigma_s: float = SIGMA_S) -> FloatArray:
    """Filter places (N, 2) at a constant rate.

    At its ends a track is continued by turning it about its last point: that point stays, and so
    does the speed of somebody whom the recording cuts amid a walk.
    """
    from scipy.ndimage import gaussian_filter1d

    sigma = sigma_s * rate_hz
    if sigma <= 0.0 or len(xy_m) < 2:
        return xy_m
    beyond = int(np.ceil(REACH * sigma))
    longer = np.pad(xy_m, ((beyond, beyond), (0, 0)), mode="reflect", reflect_type="odd")
    places: FloatArray = gaussian_filter1d(longer, sigma, axis=0, truncate=REACH)
    return places[beyond:-beyond]


@dataclass(frozen=True)
class SegmentationRules:
    """When a person stands, and what is a walk; printed with every result.

    Attributes:
        still_m_s: slower is still.
        still_s: standing lasts at least that; shorter pauses belong to the walk.
        shortest_m: a walk's start and goal are at least that far apart.
        sigma_s: smoothing.
    """

    still_m_s: float = 0.1
    still_s: float = 0.5
    shortest_m: float = 0.25
    sigma_s: float = SIGMA_S

    def __post_init__(self) -> None:
        """Raises WalkingError where a value is negative or not a number."""
        for name in ("still_m_s", "still_s", "shortest_m", "sigma_s"):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise WalkingError(f"{name} is {getattr(self, name)}; it must be 0 or more.")


USUAL = SegmentationRules()


def walks_of(track: Track, rules: SegmentationRules = USUAL) -> list[Walk]:
    """Cut a track into its walks; none where the person only stands.

    Walks shorter than `shortest_m` as the crow flies are left out: steps on the spot, and ways
    that lead back to where they began, which no path between two points describes.
    """
    times_s, places = evenly(track)
    places = smoothed(places, track.rate_hz, rules.sigma_s)
    walks = []
    for first, last in _moving(times_s, places, rules):
        # The slow samples around it are its start and its goal.
        begin, end = max(0, first - 1), min(len(times_s) - 1, last + 1)
        if np.linalg.norm(places[end] - places[begin]) >= rules.shortest_m:
            walks.append(
                Walk(
                    times_s=times_s[begin : end + 1] - times_s[begin],
                    xy_m=places[begin : end + 1].copy(),
                    subject=track.subject,
                    source=track.source,
                    kind=track.kind,
                    stature_m=track.stature_m,
                    begins_still=first > 0,
                    ends_still=last < len(times_s) - 1,
                )
            )
    return walks


def _moving(
    times_s: FloatArray, places: FloatArray, rules: SegmentationRules
) -> list[tuple[int, int]]:
    """First and last sample of each stretch between standings."""
    step_s = float(times_s[1] - times_s[0])
    speeds = np.linalg.norm(np.gradient(places, step_s, axis=0), axis=1)
    slow = np.asarray(speeds < rules.still_m_s, dtype=np.bool_)
    stands = np.zeros(len(slow), dtype=np.bool_)
    for first, last in _runs(slow):
        # A recording that begins or ends in rest need not show half a second of it.
        at_end = first == 0 or last == len(slow) - 1
        if at_end or (last - first) * step_s >= rules.still_s:
            stands[first : last + 1] = True
    return _runs(~stands)


def _runs(flags: BoolArray) -> list[tuple[int, int]]:
    """First and last index of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    return [(int(a), int(b) - 1) for a, b in edges.reshape(-1, 2)]
