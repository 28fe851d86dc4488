"""Which way a walk goes, and how far a point has come along it.

The direction of travel d(t) is that of the hips, smoothed over half a stride so that their sway
from foot to foot is left out; where they hardly move, the nearest moving frame's holds, and a body
that never travels has the direction it faces. A point p has come

    forward(t) = (p(0) - hips(0)) . d(0) + integral of p' . d dt,

which is plain distance on a straight walk and distance along the path on a curved one. All of it
scales with the body.
"""

import numpy as np

from app.science.retargeting.legs import Legs
from app.science.rig import RigMotion
from app.science.rotations import FloatArray

_SMOOTHING_S = 0.5
# In leg lengths a second: half a minute for one's own leg is no walking.
_SLOWEST_PER_S = 0.15


def directions(motion: RigMotion, positions_m: FloatArray, legs: Legs) -> FloatArray:
    """Unit horizontal direction of travel, (N, 3), of a movement placed at positions (N, J, 3)."""
    from scipy.ndimage import gaussian_filter1d  # slow to load

    facing = _facing(positions_m, legs)
    if motion.frame_count < 3:
        return facing
    hips = positions_m[:, legs.hips] * (1.0, 0.0, 1.0)
    velocity = np.gradient(hips, 1.0 / motion.rate_hz, axis=0)
    slow = gaussian_filter1d(velocity, _SMOOTHING_S * motion.rate_hz, axis=0, mode="nearest")
    speed = np.linalg.norm(slow, axis=1)
    moving = np.flatnonzero(speed > _SLOWEST_PER_S * legs.length_m)
    if not len(moving):
        return facing
    frames = np.arange(motion.frame_count)
    after = np.clip(np.searchsorted(moving, frames), 0, len(moving) - 1)
    before = np.maximum(after - 1, 0)
    nearer = np.abs(moving[after] - frames) <= np.abs(frames - moving[before])
    nearest = moving[np.where(nearer, after, before)]
    return np.asarray(slow[nearest] / speed[nearest, np.newaxis])


def forward_m(points_m: FloatArray, hips_m: FloatArray, ways: FloatArray) -> FloatArray:
    """How far points (N, 3) have come along the directions (N, 3), from the hips' first place."""
    start = float((points_m[0] - hips_m[0]) @ ways[0])
    steps = np.sum(np.diff(points_m, axis=0) * (ways[1:] + ways[:-1]) / 2.0, axis=1)
    return np.asarray(start + np.concatenate(([0.0], np.cumsum(steps))))


def _facing(positions_m: FloatArray, legs: Legs) -> FloatArray:
    """The horizontal direction across the hip sockets, the way the toes point."""
    right = positions_m[:, legs.right.thigh] - positions_m[:, legs.left.thigh]
    ahead = np.stack((right[:, 2], np.zeros(len(right)), -right[:, 0]), axis=1)
    length = np.linalg.norm(ahead, axis=1, keepdims=True)
    return np.where(length > 1e-9, ahead / np.maximum(length, 1e-9), (0.0, 0.0, -1.0))
