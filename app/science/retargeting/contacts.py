"""Detect when feet are on the ground, from the movement itself.

A foot is down while its ball is slow and low. Captures drift: the floor of the CMU walks rises by 2
cm per stride. *Low* is therefore relative to the lowest slow position within a second, and *slow*
is in leg lengths per second, or a share of the foot's own fast swings for an avatar that slides.
Both have two thresholds, a tight one to come down and a loose one to leave the ground (hysteresis),
so a foot at the threshold does not flicker. Every measure scales with the body: a body twice as
large has the same contacts.
"""

from dataclasses import dataclass

import numpy as np

from app.science.retargeting.legs import Legs
from app.science.rig import BoolArray, RigMotion
from app.science.rotations import FloatArray


@dataclass(frozen=True)
class ContactLimits:
    """Thresholds for a foot to be on the ground; L is the leg length.

    Attributes:
        slow_per_s: a foot may come down below this speed, in L per second ...
        slow_share: ... or below this share of the speed of its fast swings, whichever is higher.
        low: a foot may come down below this height above the floor, in L.
        leaving: the factor on these thresholds that must be exceeded to leave the ground.
        floor_s: the floor is the lowest slow position within this time before and after.
        shortest_s: shorter contacts, and shorter gaps in a contact, are treated as noise.
    """

    slow_per_s: float = 0.35
    slow_share: float = 0.08
    low: float = 0.06
    leaving: float = 1.5
    floor_s: float = 1.0
    shortest_s: float = 0.06


_DEFAULT = ContactLimits()
_FAST_QUANTILE = 0.95
# Speeds are differences over about this time on either side; differences between single frames
# of fast captures would be noisier.
_DIFFERENCE_S = 1.0 / 120.0


@dataclass(frozen=True, eq=False)
class Contacts:
    """When each foot is on the ground: `down` (N, 2) by frame, left then right."""

    rate_hz: float
    down: BoolArray

    def intervals(self, foot: int) -> list[tuple[int, int]]:
        """Return the first and last frame of each contact of a foot, 0 left and 1 right."""
        return runs(self.down[:, foot])


def find_contacts(motion: RigMotion, legs: Legs, limits: ContactLimits = _DEFAULT) -> Contacts:
    """Detect when each foot of a moving body is on the ground."""
    balls = legs.balls_m(*motion.world())
    return contacts_of(balls, legs.length_m, motion.rate_hz, limits)


def contacts_of(
    balls_m: FloatArray, leg_m: float, rate_hz: float, limits: ContactLimits = _DEFAULT
) -> Contacts:
    """Detect contacts from the paths of the balls of both feet, (2, N, 3), and the leg length."""
    down = [_down(ball, leg_m, rate_hz, limits) for ball in balls_m]
    return Contacts(rate_hz, np.stack(down, axis=1))


def mean_slide_m_s(balls_m: FloatArray, contacts: Contacts) -> float | None:
    """Return the mean horizontal speed of feet in contact; None if no contact has two frames.

    It is the distance that each ball, (2, N, 3), moves over the ground during its contacts, divided
    by their duration.
    """
    way_m, frames = 0.0, 0
    for foot, ball in enumerate(balls_m):
        for first, last in contacts.intervals(foot):
            steps = np.diff(ball[first : last + 1, [0, 2]], axis=0)
            way_m += float(np.linalg.norm(steps, axis=1).sum())
            frames += last - first
    return way_m * contacts.rate_hz / frames if frames else None


def runs(flags: BoolArray) -> list[tuple[int, int]]:
    """Return the first and last index of each run of true values."""
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
    """Return the lowest slow height within `reach` frames on either side; -inf if none is slow."""
    from scipy.ndimage import minimum_filter1d  # slow to import

    lowest = minimum_filter1d(np.where(slow, height_m, np.inf), 2 * reach + 1, mode="nearest")
    return np.where(np.isfinite(lowest), lowest, -np.inf)


def _hysteresis(enter: BoolArray, stay: BoolArray) -> BoolArray:
    """Return flags that are true from `enter` on for as long as `stay` is true without a break."""
    result = np.zeros(len(enter), dtype=np.bool_)
    for first, last in runs(stay):
        inside = np.flatnonzero(enter[first : last + 1])
        if len(inside):
            result[first + int(inside[0]) : last + 1] = True
    return result


def _without_short(flags: BoolArray, shortest: float) -> BoolArray:
    """Drop runs of fewer frames than `shortest`, except at the ends, where they may be cut off."""
    result = flags.copy()
    for first, last in runs(flags):
        if first > 0 and last < len(flags) - 1 and last - first + 1 < shortest:
            result[first : last + 1] = False
    return result
