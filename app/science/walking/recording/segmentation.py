"""Cut a long track into walks, at the times when the person stands still.

A person stands still where the smoothed speed stays below a threshold for a while. The movement
between two such stops is a walk if the person gets far enough; its travel time is from the last
slow sample before to the first slow sample after. If the track begins or ends during a walk, the
walk is marked accordingly.

Tracks are smoothed as in the paper. It filters its captures of 120 Hz with `gaussian_filter1d`,
sigma = 2 samples, to reduce the jerks of single steps. At other rates sigma is the same time (1/60
s).
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import BoolArray, Track, Walk, WalkingError

SIGMA_S = 2.0 / 120.0
_ROUND = 4.0
REACH = 4.0
"""The filter is truncated at this many sigma, as SciPy's is."""


def evenly(track: Track) -> tuple[FloatArray, FloatArray]:
    """Resample a track at a constant rate, given by its median interval.

    Returns times and positions. Loggers seldom have a constant rate, and the smoothing filter needs
    one.
    """
    times_s, rate_hz = track.times_s, track.rate_hz
    count = max(2, round((times_s[-1] - times_s[0]) * rate_hz) + 1)
    even_s = np.linspace(times_s[0], times_s[-1], count)
    columns = [np.interp(even_s, times_s, track.xy_m[:, axis]) for axis in (0, 1)]
    return even_s, np.stack(columns, axis=-1)


def smoothed(xy_m: FloatArray, rate_hz: float, sigma_s: float = SIGMA_S) -> FloatArray:
    """Smooth positions (N, d) sampled at a constant rate, on the floor or in space.

    At its ends a track is continued by its point reflection about the last point: that point is
    unchanged, and so is the speed of a person whom the recording cuts off during a walk.
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
    """Rules for when a person stands still and what counts as a walk; printed with results.

    Attributes:
        still_m_s: lower speeds count as still.
        still_s: shortest duration of a stop; shorter pauses belong to the walk.
        shortest_m: smallest distance between a walk's start and goal.
        sigma_s: standard deviation of the smoothing filter.
    """

    still_m_s: float = 0.1
    still_s: float = 0.5
    shortest_m: float = 0.25
    sigma_s: float = SIGMA_S

    def __post_init__(self) -> None:
        """Raise WalkingError if a value is negative or not finite."""
        for name in ("still_m_s", "still_s", "shortest_m", "sigma_s"):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise WalkingError(f"{name} is {getattr(self, name)}; it must be 0 or more.")


DEFAULT_RULES = SegmentationRules()


def walks_of(track: Track, rules: SegmentationRules = DEFAULT_RULES) -> list[Walk]:
    """Cut a track into its walks; empty if the person only stands.

    Movements whose start and goal are closer than `shortest_m` are no walks: steps on the spot, and
    rounds that return to where they began (`rounds_of`), which no path between two points
    describes.
    """
    return [walk for walk in _movements(track, rules) if _distance_m(walk) >= rules.shortest_m]


def rounds_of(track: Track, rules: SegmentationRules = DEFAULT_RULES) -> list[Walk]:
    """Return the movements that go somewhere and return, and are therefore no walks.

    Movements shorter than four times `shortest_m` count as steps on the spot.
    """
    return [
        walk
        for walk in _movements(track, rules)
        if _distance_m(walk) < rules.shortest_m <= walk.length_m / _ROUND
    ]


def _distance_m(walk: Walk) -> float:
    return float(np.linalg.norm(walk.xy_m[-1] - walk.xy_m[0]))


def _movements(track: Track, rules: SegmentationRules) -> list[Walk]:
    """Cut a track into its movements from one stop to the next."""
    times_s, places = evenly(track)
    places = smoothed(places, track.rate_hz, rules.sigma_s)
    walks = []
    for first, last in moving(times_s, places, rules):
        # The slow samples before and after it are its start and its goal.
        begin, end = max(0, first - 1), min(len(times_s) - 1, last + 1)
        others, changing = _others(track, times_s[begin], times_s[end])
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
                scene=track.scene,
                others=others,
                changing=changing,
            )
        )
    return walks


def _others(
    track: Track, from_s: float, to_s: float
) -> tuple[dict[str, float], dict[str, tuple[float, float]]]:
    """Return the further numbers that are the same during a part of a track, and those that change.

    Samples at which a number is not known say nothing: the value at the others counts.
    """
    others: dict[str, float] = {}
    changing: dict[str, tuple[float, float]] = {}
    within = (track.times_s >= from_s) & (track.times_s <= to_s)
    for name, values in track.others.items():
        known = values[within & np.isfinite(values)]
        if not len(known):
            continue
        low, high = float(known.min()), float(known.max())
        if low == high:
            others[name] = low
        else:
            changing[name] = (low, high)
    return others, changing


def moving(
    times_s: FloatArray, places: FloatArray, rules: SegmentationRules
) -> list[tuple[int, int]]:
    """Return the first and last sample of each stretch of movement between stops.

    Places (N, d) are sampled at a constant rate, on the floor or in space.
    """
    step_s = float(times_s[1] - times_s[0])
    speeds = np.linalg.norm(np.gradient(places, step_s, axis=0), axis=1)
    slow = np.asarray(speeds < rules.still_m_s, dtype=np.bool_)
    stands = np.zeros(len(slow), dtype=np.bool_)
    for first, last in _runs(slow):
        # A recording may begin or end with less than half a second of standing.
        at_end = first == 0 or last == len(slow) - 1
        if at_end or (last - first) * step_s >= rules.still_s:
            stands[first : last + 1] = True
    return _runs(~stands)


def _runs(flags: BoolArray) -> list[tuple[int, int]]:
    """Return the first and last index of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    return [(int(a), int(b) - 1) for a, b in edges.reshape(-1, 2)]
