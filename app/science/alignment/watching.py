"""Watch an alignment while a session runs, and fit it again where it no longer holds.

Headset and tracking system drift apart, slowly and without end; a recentre moves the headset's
world at once; and a tracker may slip. Each shows in the difference between the head by the headset
and the head by its tracker:

- a recentre is a jump of the headset's own pose, and leaves the tracker where it sits on the head:
  the worlds alone are fitted again, to the first second after it;
- a jump of the tracker's pose (it slipped, or its system started anew) makes the whole alignment
  unknown, until enough looking around was seen since;
- drift is followed by fitting again every few seconds to the last half minute without a jump.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from app.science.alignment.fit import fit_alignment, refit_alignment, refit_world
from app.science.alignment.poses import AlignmentError, PoseStream
from app.science.alignment.results import Alignment
from app.science.rotations import FloatArray, conjugate, multiply, to_rotation_vector

Change = Literal["first", "refit", "recentred", "moved", "lost"]
"""What a step of watching brought.

`first`: an alignment, where there was none. `refit`: a newer one. `recentred`: the headset's world
jumped, and a new alignment is known. `moved`: the tracker jumped on the head or in its system, so
that there is no alignment. `lost`: the alignment does not hold, and a new one will follow.
"""
WINDOW_S = 30.0
"""An alignment is fitted to so much time at most."""
STEP_S = 1.0
"""How often to watch."""
_FIRST_S = 8.0
_GOOD_M = 0.003
_PATIENCE_S = 20.0  # then the first alignment is taken even if it is not good
_SETTLE_S = 1.0
_REFIT_S = 5.0
_RECENT_S = 3.0
_HALF_S = 0.25
_OUT_OF_SIGHT_S = 1.0
_JUMP_M, _JUMP_RAD = 0.015, 0.015
_JUMP_RESIDUALS = 3.0
_ARM_M = 0.3  # weighs turns against shifts where only the larger one matters


@dataclass(frozen=True)
class Jump:
    """When an alignment stopped to hold, and on which side.

    Attributes:
        time_s: of the first of the headset's samples after it.
        side: whose pose jumped.
        offset_m: by how much the head by the headset moved against the head by the tracker.
        offset_rad: by how much it turned.
    """

    time_s: float
    side: Literal["headset", "tracker"]
    offset_m: float
    offset_rad: float


@dataclass(frozen=True, eq=False)
class Watched:
    """What is known after a step of watching.

    Attributes:
        alignment: the newest one; None before the first, and after the tracker moved.
        holds: whether the alignment may be used now.
        since_s: nothing has jumped since then.
        fitted_s: when the alignment was last fitted.
        change: what this step brought, if anything.
        jump: the jump that this step found, if any.
    """

    alignment: Alignment | None
    holds: bool
    since_s: float
    fitted_s: float
    change: Change | None = None
    jump: Jump | None = None


def find_jump(headset: PoseStream, tracker: PoseStream, alignment: Alignment) -> Jump | None:
    """Return the largest jump between both streams of some seconds; None if there is none.

    A jump is a step of the median of a quarter of a second: single wrong samples are none.
    """
    times_s = headset.times_s
    tracker_m, tracker_q, weights = tracker.at(times_s + alignment.mount.delay_s)
    used = (weights > 0.0) & (headset.weights > 0.0)
    half = int(np.count_nonzero(times_s > times_s[-1] - _HALF_S))
    if int(np.count_nonzero(used)) < 2 * half or half < 2:
        return None
    times_s, head_m, head_q = times_s[used], headset.positions_m[used], headset.rotations[used]
    by_m, by_q = alignment.head(times_s, tracker_m[used], tracker_q[used])
    apart = np.hstack((head_m - by_m, to_rotation_vector(multiply(head_q, conjugate(by_q)))))
    medians = np.median(sliding_window_view(apart, half, axis=0), axis=-1)
    steps = medians[half:] - medians[:-half]
    metres, rad = (np.linalg.norm(part, axis=1) for part in (steps[:, :3], steps[:, 3:]))
    quality = alignment.quality
    size = np.maximum(
        metres / max(_JUMP_M, _JUMP_RESIDUALS * quality.residual_m),
        rad / max(_JUMP_RAD, _JUMP_RESIDUALS * quality.residual_rad),
    )
    best = int(np.argmax(size))
    if size[best] < 1.0:
        return None
    # The medians step anywhere within both windows; the sample itself is where most changed.
    changes = _sizes(np.diff(apart[best : best + 2 * half], axis=0))
    at = best + 1 + int(np.argmax(changes))
    own, by_tracker = _own_step(head_m, head_q, at), _own_step(by_m, by_q, at)
    side: Literal["headset", "tracker"] = "headset" if own >= by_tracker else "tracker"
    return Jump(float(times_s[at]), side, float(metres[best]), float(rad[best]))


def _sizes(steps: FloatArray) -> FloatArray:
    metres, rad = (np.linalg.norm(part, axis=1) for part in (steps[:, :3], steps[:, 3:]))
    return np.asarray(metres + _ARM_M * rad)


def _own_step(positions_m: FloatArray, rotations: FloatArray, at: int) -> float:
    turn = to_rotation_vector(multiply(rotations[at], conjugate(rotations[at - 1])))
    step = np.concatenate((positions_m[at] - positions_m[at - 1], turn))
    return float(_sizes(step[np.newaxis])[0])


def start_watching(start_s: float, alignment: Alignment | None = None) -> Watched:
    """Return the state before the first step, with an alignment if one is known already."""
    return Watched(alignment, alignment is not None, start_s, start_s)


def watch(watched: Watched, headset: PoseStream, tracker: PoseStream) -> Watched:
    """Take a step of watching, about once a second.

    Args:
        watched: the state after the step before.
        headset: the head by the headset, the last `WINDOW_S` or more until now.
        tracker: the tracker on the head, over the same time.
    """
    watched = replace(watched, change=None, jump=None)
    now_s = float(headset.times_s[-1])
    if not _in_sight(tracker, now_s):
        return watched  # an old alignment is better than one that is fitted to old samples
    alignment = watched.alignment
    if alignment is None:
        return _first(watched, headset, tracker, now_s)
    recent = headset.between(max(watched.since_s, now_s - _RECENT_S), now_s)
    # An alignment that does not hold is wrong by an amount that changes with each movement.
    look = watched.holds and len(recent.times_s) > 1
    jump = find_jump(recent, tracker, alignment) if look else None
    if jump is not None and jump.side == "tracker":
        return Watched(None, False, jump.time_s, watched.fitted_s, "moved", jump)
    if jump is not None:
        watched = replace(watched, holds=False, since_s=jump.time_s, change="lost", jump=jump)
    return _again(watched, alignment, headset, tracker, now_s)


def _in_sight(tracker: PoseStream, now_s: float) -> bool:
    seen_s = tracker.times_s[tracker.weights > 0.0]
    return len(seen_s) > 1 and float(seen_s[-1]) > now_s - _OUT_OF_SIGHT_S


def _first(watched: Watched, headset: PoseStream, tracker: PoseStream, now_s: float) -> Watched:
    start_s = max(watched.since_s, now_s - WINDOW_S)
    if now_s - start_s < _FIRST_S:
        return watched
    try:
        found = fit_alignment(headset.between(start_s, now_s), tracker)
    except AlignmentError:  # not enough was seen yet
        return watched
    if found.quality.uncertainty_m > _GOOD_M and now_s - start_s < _PATIENCE_S:
        return watched
    return Watched(found, True, watched.since_s, now_s, "first")


def _again(
    watched: Watched,
    alignment: Alignment,
    headset: PoseStream,
    tracker: PoseStream,
    now_s: float,
) -> Watched:
    """Fit again after a jump, as soon as there is enough, and every few seconds else."""
    settled = now_s - watched.since_s >= _SETTLE_S
    due = now_s - watched.fitted_s >= _REFIT_S or not watched.holds
    if not (settled and due):
        return watched
    part = headset.between(max(watched.since_s, now_s - WINDOW_S), now_s)
    try:
        found = refit_world(part, tracker, alignment)
    except AlignmentError:  # the tracker is out of sight
        return watched
    found = _better(found, part, tracker, alignment)
    change: Change = "refit" if watched.holds else "recentred"
    return Watched(found, True, watched.since_s, now_s, change, watched.jump)


def _better(
    world: Alignment, headset: PoseStream, tracker: PoseStream, known: Alignment
) -> Alignment:
    """Return the alignment with a new mount, too, if that is more certain."""
    try:
        whole = refit_alignment(headset, tracker, known)
    except AlignmentError:  # too little looking around: the known mount stays
        return world
    return whole if whole.quality.uncertainty_m < world.quality.uncertainty_m else world


def follow(headset: PoseStream, tracker: PoseStream) -> Iterator[tuple[float, Watched]]:
    """Watch two recorded streams as if they came in now; yield each change with its time.

    Args:
        headset: the head by the headset.
        tracker: a tracker that is fixed to the head, by the same clock.
    """
    if len(headset.times_s) == 0:
        return
    start_s, end_s = float(headset.times_s[0]), float(headset.times_s[-1])
    watched = start_watching(start_s)
    for now_s in np.arange(start_s + STEP_S, end_s + STEP_S, STEP_S):
        seen = headset.between(now_s - WINDOW_S - STEP_S, now_s)
        if len(seen.times_s) < 2 or seen.times_s[-1] < now_s - STEP_S:
            continue
        came = tracker.between(seen.times_s[0] - 1.0, now_s)
        if len(came.times_s) < 2:
            continue
        watched = watch(watched, seen, came)
        if watched.change is not None:
            yield float(seen.times_s[-1]), watched
