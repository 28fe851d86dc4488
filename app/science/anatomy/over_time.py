"""Check a capture over time for what no body does: it stands still to the last bit, or jumps.

Sensors have noise, so frames that repeat exactly were never measured: something held the last one.
Nobody's hips move faster than a sprinter's (12.4 m/s at the world record). A length between two
markers of one segment changes by skin and soft tissue, on the shared captures by less than 16 % and
3 cm; where labels are exchanged for part of the time it jumps by far more.
"""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from app.science.anatomy.notice import Notice
from app.science.rotations import FloatArray

_FROZEN_S = 0.5
_FASTEST_M_S = 12.5
_FAR, _FAR_M = 0.3, 0.05
_FEWEST_FRAMES = 3
_SHOWN = 4
BoolArray = npt.NDArray[np.bool_]


def repeated(values: FloatArray) -> BoolArray:
    """Return whether each frame but the first repeats the one before in every bit, (N - 1,).

    Args:
        values: (N, ...) positions or rotations; NaN where nothing was seen, which is no repetition
            where all is NaN.
    """
    rows = values.reshape(len(values), -1)
    missing = np.isnan(rows)
    same = (rows[1:] == rows[:-1]) | (missing[1:] & missing[:-1])
    alike: BoolArray = same.all(axis=1) & ~missing[1:].all(axis=1)
    return alike


def frozen_notice(parts: Mapping[str, BoolArray], rate_hz: float) -> Notice | None:
    """Return a notice on the longest time that a part of the capture repeats one frame.

    A part that never changes is no evidence (a pose, or a walk on the spot), nor is a pose that is
    held from the first frame on, as for a calibration.

    Args:
        parts: what may be frozen, in words -> (N - 1,) from `repeated`.
        rate_hz: frames per second.
    """
    later = {what: _after_first_pose(same) for what, same in parts.items()}
    longest = {what: _longest(same) for what, same in later.items() if same.any()}
    frozen = {what: run for what, run in longest.items() if run[1] - run[0] > _FROZEN_S * rate_hz}
    if not frozen:
        return None
    what = max(frozen, key=lambda one: frozen[one][1] - frozen[one][0])
    first, last = frozen[what]
    return Notice(
        "frozen",
        "noted",
        f"The capture stands still to the last bit: {what} repeats one frame.",
        f"frames {first + 1} to {last + 1} are alike, {(last - first) / rate_hz:.2f} s",
        f"at most {_FROZEN_S:g} s, since every measured frame has noise of its own",
        "The last frame was held there, as where tracking was lost: leave these frames out.",
    )


def jump_notice(root_m: FloatArray, rate_hz: float) -> Notice | None:
    """Return a notice if the root (N, 3) moves faster than anybody's hips."""
    if len(root_m) < 2:
        return None
    speeds = np.linalg.norm(np.diff(root_m, axis=0), axis=1) * rate_hz
    fast = np.flatnonzero(speeds > _FASTEST_M_S)
    if not len(fast):
        return None
    shown = ", ".join(str(frame + 2) for frame in fast[:_SHOWN])
    more = f" and {len(fast) - _SHOWN} more" if len(fast) > _SHOWN else ""
    worst = int(np.argmax(speeds))
    return Notice(
        "jump",
        "noted",
        "The body jumps from one place to another within a frame.",
        f"{float(speeds[worst]):.0f} m/s to frame {worst + 2}; the jumps lead to frame"
        f" {shown}{more}",
        f"at most {_FASTEST_M_S:g} m/s",
        "Leave these frames out or correct the root's positions; strides and steps across a jump"
        " are not a person's. If all of the movement is too fast, check the unit and the rate.",
    )


def distance_notice(lengths_m: Mapping[str, FloatArray]) -> Notice | None:
    """Return a notice if distances within segments jump for part of the time.

    Args:
        lengths_m: two markers, in words -> their distance (N,), NaN where one was not seen.
    """
    far: dict[str, npt.NDArray[np.intp]] = {}
    for names, lengths in lengths_m.items():
        seen = np.isfinite(lengths)
        if not seen.any():
            continue
        middle = float(np.median(lengths[seen]))
        off = np.where(seen, np.abs(lengths - middle), 0.0)
        frames = np.flatnonzero((off > _FAR_M) & (off > _FAR * middle))
        if len(frames) >= _FEWEST_FRAMES:
            far[names] = frames
    if not far:
        return None
    every = np.unique(np.concatenate([*far.values()]))
    shown = ", ".join(list(far)[:_SHOWN])
    more = f" and {len(far) - _SHOWN} more pairs" if len(far) > _SHOWN else ""
    return Notice(
        "jump",
        "noted",
        "Markers of one segment move apart for part of the time, as where labels are exchanged.",
        f"the distance of {shown}{more} is far from its median in {len(every)} frames, from"
        f" {every[0] + 1} to {every[-1] + 1}",
        f"within {100.0 * _FAR:.0f} % or {100.0 * _FAR_M:.0f} cm of the median",
        "Check the labels of these markers in these frames, and export again.",
    )


def _after_first_pose(same: BoolArray) -> BoolArray:
    """Return the same without the repetitions of the first frame."""
    return same & np.logical_or.accumulate(~same)


def _longest(same: BoolArray) -> tuple[int, int]:
    """Return the first and the last frame, from 0, of the longest run of repeated frames."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], same.astype(np.int8), [0]))))
    starts, ends = edges[::2], edges[1::2]
    at = int(np.argmax(ends - starts))
    return int(starts[at]), int(ends[at])
