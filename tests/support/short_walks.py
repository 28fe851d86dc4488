"""Read the short walks of Carlisle and Kuo: foot paths of single walks, and the table of all.

Carlisle and Kuo (2023), "Optimization of energy and time predicts dynamic speeds for human
walking", eLife 12; data in the repository kuo-lab/short_walk_experiment (MATLAB files).

A file of one walk contains both feet. Each path is integrated from a sensor on the foot at 128 Hz,
is rotated about the vertical by an angle of its own, and drifts while the foot is still before its
first step. `FFstart` and `FFend` are the frames at which a foot is flat, one for each stride. So
each path is used from the foot's first flat frame to its last, is rotated so that it ends straight
ahead, and is interpolated between its flat positions: this omits the swing of a foot, which the
body does not follow. The mean of both feet represents the centre of mass.
"""

import io
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.io import loadmat

from app.adapters.captures.capture import CaptureError
from app.science.rotations import FloatArray
from app.science.walking.records import Walk

RATE_HZ = 128.0
DISTANCES_M = (1.1, 1.7, 2.2, 2.8, 3.3, 3.8, 5.1, 7.0, 9.1, 12.7)
"""Nominal distances of the table's ten rows per subject."""
_STILL_S = 1.0


@dataclass(frozen=True, eq=False)
class ShortWalkTable:
    """Peak speed and duration of every walk; NaN for missing trials (zero in the file)."""

    distances_m: tuple[float, ...]
    peak_speeds_m_s: FloatArray
    durations_s: FloatArray


def read_short_walk_table(data: bytes) -> ShortWalkTable:
    """Read `peak_speed_all_sub.mat`; raise CaptureError if it is another file."""
    content = _content(data)
    arrays = []
    for key in ("peak_speed_all_sub", "walk_duration_all_sub"):
        array = np.array(content.get(key, ()), dtype=np.float64)
        if array.ndim != 3 or array.shape[1] != len(DISTANCES_M):
            raise CaptureError(f"{key} is not there, or not subjects x 10 distances x trials.")
        arrays.append(np.where(array > 0.0, array, np.nan))
    return ShortWalkTable(DISTANCES_M, arrays[0], arrays[1])


def read_foot_walk(data: bytes, *, name: str, subject: str, stature_m: float | None = None) -> Walk:
    """Read one walk, rotated to lead straight ahead, from rest to rest.

    Raises:
        CaptureError: the file is not a MATLAB file, or lacks a foot's path or flat frames.
    """
    content = _content(data)
    feet = [_foot(content, key) for key in ("left_walk_info", "right_walk_info")]
    begin_s = min(times_s[0] for times_s, _ in feet)
    end_s = max(times_s[-1] for times_s, _ in feet)
    times_s = np.linspace(begin_s, end_s, round((end_s - begin_s) * RATE_HZ) + 1)
    ahead = np.mean([_between(times_s, *foot) for foot in feet], axis=0)
    places = np.stack([np.zeros_like(ahead), ahead], axis=-1)
    return Walk(times_s - begin_s, places, subject, name, "human", stature_m)


def _foot(content: dict[str, Any], key: str) -> tuple[FloatArray, FloatArray]:
    """Return the times at which the foot is flat, and its distance at each."""
    foot = content.get(key)
    places = np.array(getattr(foot, "P", ()), dtype=np.float64)
    starts = np.atleast_1d(np.array(getattr(foot, "FFstart", ()), dtype=np.int64))
    ends = np.atleast_1d(np.array(getattr(foot, "FFend", ()), dtype=np.int64))
    if places.ndim != 2 or not len(starts) or not len(ends):
        raise CaptureError(f"{key} is not there, or has no path P or no flat frames.")
    flat = np.concatenate([starts, ends[-1:]]) - 1  # MATLAB counts from one
    if flat.min() < 0 or flat.max() >= len(places) or (np.diff(flat) <= 0).any():
        raise CaptureError(f"{key} has flat frames that are not frames of its path, in order.")
    net = places[flat[-1], :2] - places[flat[0], :2]
    length = float(np.linalg.norm(net))
    if not np.isfinite(length) or length <= 0.0:
        raise CaptureError(f"{key} leads nowhere.")
    ahead: FloatArray = (places[flat, :2] - places[flat[0], :2]) @ (net / length)
    return flat / RATE_HZ, ahead


def _between(times_s: FloatArray, flat_s: FloatArray, ahead_m: FloatArray) -> FloatArray:
    """Interpolate monotonically between the flat positions, with rest before and after."""
    knots_s = np.concatenate([[flat_s[0] - _STILL_S], flat_s, [flat_s[-1] + _STILL_S]])
    knots_m = np.concatenate([ahead_m[:1], ahead_m, ahead_m[-1:]])
    within = np.clip(times_s, flat_s[0], flat_s[-1])
    return np.asarray(PchipInterpolator(knots_s, knots_m)(within), dtype=np.float64)


def _content(data: bytes) -> dict[str, Any]:
    try:
        # An open file is accepted as well as a path.
        opened = cast("str", io.BytesIO(data))
        content: dict[str, Any] = loadmat(opened, squeeze_me=True, struct_as_record=False)
    except Exception as error:  # the reader raises whatever a broken file makes it trip over
        raise CaptureError(f"this is no readable MATLAB file: {error}") from error
    return content
