"""Cut the path of a hand into reaches: smooth it, and cut it where the hand rests.

A hand rests where it is slower than 10 cm/s, as people do between walks (`walking.recording`), for
0.03 s. Studies at a table often use 5 cm/s; a standing person's hands sway, and recorded reaches in
a room then hardly ever end. All thresholds are fixed and published with what was learnt
(`ReachRules`). The moments at which the speed crosses the threshold are interpolated between
samples. The slow beginning and end of a movement lie outside of them; the agent with which a reach
is compared is cut in the same way (`agent`), so this shortens nobody's movements.

What is no reach is named with its reason: a detour, a movement while the trunk moves, one that the
recording cuts, or one that is too long or too short.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.science.reaching.records import HandTrack, Reach, ReachingError
from app.science.rotations import FloatArray
from app.science.walking.recording import SegmentationRules, moving, smoothed
from app.science.walking.records import BoolArray


@dataclass(frozen=True)
class ReachRules:
    """Rules for when a hand rests and what counts as a reach; stored with what was learnt.

    Attributes:
        still_m_s: slower hands rest.
        still_s: shortest rest between two reaches.
        sigma_s: standard deviation of the smoothing filter.
        gap_s: longest time for which the hand may be out of sight.
        shortest_m, longest_m: smallest and largest amplitude.
        longest_s: longest duration.
        straightest: smallest amplitude over length of path.
        trunk_m: farthest that head or hips may move meanwhile.
    """

    still_m_s: float = 0.1
    still_s: float = 0.03
    sigma_s: float = 0.02
    gap_s: float = 0.1
    shortest_m: float = 0.1
    longest_m: float = 1.2
    longest_s: float = 3.0
    straightest: float = 0.8
    trunk_m: float = 0.1

    def __post_init__(self) -> None:
        """Raise ReachingError if a value is not positive."""
        for name, value in vars(self).items():
            if not 0.0 < value < np.inf:
                raise ReachingError(f"{name} is {value}; it must be positive.")


DEFAULT_RULES = ReachRules()


@dataclass(frozen=True)
class NoReach:
    """A movement that is left out: its recording and hand, when it began, and why."""

    name: str
    began_s: float
    reason: str


def reaches_of(
    track: HandTrack, rules: ReachRules = DEFAULT_RULES
) -> tuple[list[Reach], list[NoReach]]:
    """Cut the path of a hand into its reaches, and name the movements that are none.

    Movements smaller than half of `shortest_m` are not counted: hands are never quite still.
    """
    reaches: list[Reach] = []
    left_out: list[NoReach] = []
    for times_s, places, trunk in _seen(track, rules):
        for found in _movements(times_s, places, rules):
            reason = _objection(found, trunk, times_s, rules)
            if reason is None:
                lasts_s, path = found.path
                reaches.append(Reach(lasts_s, path, track.hand, track.who))
            elif found.distance_m >= 0.5 * rules.shortest_m:
                began_s = float(times_s[0] + found.from_s)
                left_out.append(NoReach(track.name, began_s, reason))
    return reaches, left_out


@dataclass(frozen=True, eq=False)
class _Movement:
    """A stretch between two rests.

    `inner_s`, `places`: times from the piece's first and smoothed positions of the whole piece;
    `inner`: the samples between `from_s` and `until_s`, the moments of crossing the threshold.
    """

    inner_s: FloatArray
    places: FloatArray
    inner: BoolArray
    from_s: float
    until_s: float
    is_whole: bool

    @property
    def path(self) -> tuple[FloatArray, FloatArray]:
        """Times (N,) from 0 and positions (N, 3) from one crossing to the other."""
        inside = np.concatenate([[self.from_s], self.inner_s[self.inner], [self.until_s]])
        return inside - inside[0], _at(self.inner_s, self.places, inside)

    @property
    def distance_m(self) -> float:
        positions_m = self.path[1]
        return float(np.linalg.norm(positions_m[-1] - positions_m[0]))


def _seen(
    track: HandTrack, rules: ReachRules
) -> Iterator[tuple[FloatArray, FloatArray, FloatArray | None]]:
    """Yield times, positions and trunk of each piece in which the hand is never out of sight."""
    seen = np.flatnonzero(np.isfinite(track.positions_m).all(axis=1))
    if len(seen) < 2:
        return
    times_s = track.times_s[seen]
    breaks = np.flatnonzero(np.diff(times_s) > rules.gap_s) + 1
    for piece in np.split(seen, breaks):
        if len(piece) >= 5:
            trunk = None if track.trunk_m is None else track.trunk_m[piece]
            yield track.times_s[piece], track.positions_m[piece], trunk


def _movements(
    times_s: FloatArray, positions_m: FloatArray, rules: ReachRules
) -> Iterator[_Movement]:
    """Yield the movements of a piece, resampled at the rate of its median step and smoothed."""
    step_s = float(np.median(np.diff(times_s)))
    count = max(3, round((times_s[-1] - times_s[0]) / step_s) + 1)
    even_s = np.linspace(0.0, times_s[-1] - times_s[0], count)
    step_s = float(even_s[1])
    places = smoothed(_at(times_s - times_s[0], positions_m, even_s), 1.0 / step_s, rules.sigma_s)
    speeds = np.linalg.norm(np.gradient(places, step_s, axis=0), axis=1)
    stops = SegmentationRules(rules.still_m_s, rules.still_s, rules.shortest_m, rules.sigma_s)
    for first, last in moving(even_s, places, stops):
        is_whole = first > 0 and last < count - 1
        from_s, until_s = float(even_s[first]), float(even_s[last])
        if is_whole:
            from_s = _crossing(even_s, speeds, first - 1, first, rules.still_m_s)
            until_s = _crossing(even_s, speeds, last, last + 1, rules.still_m_s)
        inner = (even_s > from_s) & (even_s < until_s)
        yield _Movement(even_s, places, inner, from_s, until_s, is_whole)


def _crossing(
    times_s: FloatArray, speeds: FloatArray, before: int, after: int, threshold: float
) -> float:
    """Return when the speed crosses the threshold between two neighbouring samples."""
    change = speeds[after] - speeds[before]
    share = (threshold - speeds[before]) / change if change else 0.0
    share = min(max(float(share), 0.0), 1.0)
    return float(times_s[before] + share * (times_s[after] - times_s[before]))


def _at(times_s: FloatArray, positions_m: FloatArray, moments_s: FloatArray) -> FloatArray:
    return np.stack(
        [np.interp(moments_s, times_s, positions_m[:, axis]) for axis in range(3)], axis=-1
    )


def _objection(
    found: _Movement, trunk: FloatArray | None, times_s: FloatArray, rules: ReachRules
) -> str | None:
    """Return why a movement is no reach; None if it is one."""
    distance_m, lasts_s = found.distance_m, found.until_s - found.from_s
    path = found.path[1]
    if not found.is_whole:
        return "the recording begins or ends during it, or the hand was out of sight"
    if distance_m < rules.shortest_m:
        return f"its ends are less than {rules.shortest_m:g} m apart"
    if distance_m > rules.longest_m:
        return f"its ends are more than {rules.longest_m:g} m apart, farther than an arm"
    if lasts_s > rules.longest_s:
        return f"it takes more than {rules.longest_s:g} s"
    length_m = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    if len(path) < 3 or distance_m < rules.straightest * length_m:
        return f"it is a detour: less than {rules.straightest:g} of its length leads to its end"
    if trunk is not None:
        meanwhile = (times_s - times_s[0] >= found.from_s) & (times_s - times_s[0] <= found.until_s)
        moved = trunk[meanwhile]
        moved = moved[np.isfinite(moved).all(axis=1)]
        if len(moved) and np.linalg.norm(moved - moved[0], axis=1).max() > rules.trunk_m:
            return f"head or hips move more than {rules.trunk_m:g} m meanwhile: the person walks"
    return None
