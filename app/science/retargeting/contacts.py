"""When feet are on the ground, found from the movement itself.

A foot is down while its ball is slow and low. Captures drift: the floor of the CMU walks rises by
2 cm a stride. So *low* is meant above the lowest slow place within a second, and *slow* in leg
lengths a second, or as a share of the foot's own fast swings where an avatar slides. Both have two
limits, a tight one to come down and a loose one to leave (hysteresis), so a foot at the limit does
not flicker. Every measure scales with the body: a body twice as large has the same contacts.
"""

from dataclasses import dataclass

import numpy as np

from app.science.retargeting.legs import Legs
from app.science.rig import BoolArray, RigMotion
from app.science.rotations import FloatArray


@dataclass(frozen=True)
class ContactLimits:
    """What counts as down; L is the leg length.

    Attributes:
        slow_per_s: below this many L a second a foot may come down ...
        slow_share: ... or below this share of its fast swings' speed, whichever is more.
        low: below this many L above the floor it may come down.
        leaving: how many times these limits it takes to leave.
        floor_s: the floor is the lowest slow place within this time before and after.
        shortest_s: shorter contacts, and shorter gaps in one, are taken for noise.
    """

    slow_per_s: float = 0.35
    slow_share: float = 0.08
    low: float = 0.06
    leaving: float = 1.5
    floor_s: float = 1.0
    shortest_s: float = 0.06


_DEFAULT = ContactLimits()
_FAST_QUANTILE = 0.95
# Speeds are differences over about this time on either side; faster captures are noisier.
_DIFFERENCE_S = 1.0 / 120.0


@dataclass(frozen=True, eq=False)
class Contacts:
    """Which feet are down in which frames: down (N, 2), left then right."""

    rate_hz: float
    down: BoolArray

    def intervals(self, foot: int) -> list[tuple[int, int]]:
        """First and last frame of each contact of a foot, 0 left and 1 right."""
        return runs(self.down[:, foot])


def find_contacts(motion: RigMotion, legs: Legs, limits: ContactLimits = _DEFAULT) -> Contacts:
    """Find when each foot of a moving body is down."""
    balls = legs.balls_m(*motion.world())
    return contacts_of(balls, legs.length_m, motion.rate_hz, limits)


def contacts_of(
    balls_m: FloatArray, leg_m: float, rate_hz: float, limits: ContactLimits = _DEFAULT
) -> Contacts:
    """The same from the paths of both balls, (2, N, 3), and the leg length."""
    down = [_down(ball, leg_m, rate_hz, limits) for ball in balls_m]
    return Contacts(rate_hz, np.stack(down, axis=1))


def mean_slide_m_s(balls_m: FloatArray, contacts: Contacts) -> float | None:
    """Mean horizontal speed of feet while they are down; None where none is down for two frames.

    The way each ball, (2, N, 3), makes over the ground during its contacts, by the time they last.
    """
    way_m, frames = 0.0, 0
    for foot, ball in enumerate(balls_m):
        for first, last in contacts.intervals(foot):
            steps = np.diff(ball[first : last + 1, [0, 2]], axis=0)
            way_m += float(np.linalg.norm(steps, axis=1).sum())
            frames += last - first
    return way_m * contacts.rate_hz / frames if frames else None


def runs(flags: BoolArray) -> list[tuple[int, int]]:
    """First and last index of each run of true values."""
    edges = np.diff(np.concatenate(([False], flags, [False])).astype(np.int8))
    starts, stops = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return list(zip(starts.tolist(), stops.tolist(), strict=True))


def _down(ball_m: FloatArray, leg_m: float, rate_hz: float, limits: ContactLimits) -> BoolArray:
    speed = _speed(ball_m, rate_hz)
    fast = float(np.quantile(speed, _FAST_QUANTILE))
    slow = max(limits.slow_per_s * leg_m, limits.slow_share * fast)
    loose = limits.leaving * slow
    height = ball_m[:, 1] - _floor(ball_m[:, 1], speed <= loose, round(limits.floor_s * rate_hz))
    low = limits.low * leg_m
    down = _hysteresis(
        (speed <= slow) & (height <= low), (speed <= loose) & (height <= limits.leaving * low)
    )
    shortest = limits.shortest_s * rate_hz
    return _without_short(~_without_short(~down, shortest), shortest)


def _speed(ball_m: FloatArray, rate_hz: float) -> FloatArray:
    reach = max(1, round(_DIFFERENCE_S * rate_hz))
    frames = np.arange(len(ball_m))
    after = np.minimum(frames + reach, len(ball_m) - 1)
    before = np.maximum(frames - reach, 0)
    way = np.linalg.norm(ball_m[after] - ball_m[before], axis=1)
    return np.asarray(way * rate_hz / np.maximum(after - before, 1))


def _floor(height_m: FloatArray, slow: BoolArray, reach: int) -> FloatArray:
    """Lowest slow height within `reach` frames on either side; minus infinity where none is."""
    from scipy.ndimage import minimum_filter1d  # slow to load

    lowest = minimum_filter1d(np.where(slow, height_m, np.inf), 2 * reach + 1, mode="nearest")
    return np.where(np.isfinite(lowest), lowest, -np.inf)


def _hysteresis(enter: BoolArray, stay: BoolArray) -> BoolArray:
    """True from `enter` on for as long as `stay` holds without a break."""
    result = np.zeros(len(enter), dtype=np.bool_)
    for first, last in runs(stay):
        inside = np.flatnonzero(enter[first : last + 1])
        if len(inside):
            result[first + int(inside[0]) : last + 1] = True
    return result


def _without_short(flags: BoolArray, shortest: float) -> BoolArray:
    """Without runs of fewer frames than `shortest`; at the ends they may go on, and stay."""
    result = flags.copy()
    for first, last in runs(flags):
        if first > 0 and last < len(flags) - 1 and last - first + 1 < shortest:
            result[first : last + 1] = False
    return result
